/* unload PLUGIN...: each is loaded, used on two threads and unloaded, twice; nothing of it stays: no thread,
 * and the file is gone from the process. */
#define _POSIX_C_SOURCE 200809L
#include "check_host.h"
#include <dirent.h>
#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

static int threads(void) {
    DIR *tasks = opendir("/proc/self/task");
    int count = 0;
    while (tasks && readdir(tasks)) ++count;
    if (tasks) closedir(tasks);
    return count - 2; /* . and .. */
}

static int is_mapped(const char *file) {
    char line[4096];
    int found = 0;
    FILE *maps = fopen("/proc/self/maps", "r");
    while (maps && fgets(line, sizeof line, maps)) found |= strstr(line, file) != NULL;
    if (maps) fclose(maps);
    return found;
}

static int (*run)(void);
static void *work(void *status) {
    *(int *)status = run();
    return NULL;
}

static void use_once(const char *file) {
    pthread_t id[2];
    int status[2] = {1, 1}, k;
    void *plugin = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (!plugin) printf("%s\n", dlerror());
    EXPECT(plugin != NULL);
    if (!plugin) return;
    *(void **)&run = dlsym(plugin, "plugin_run");
    EXPECT(run != NULL && is_mapped(file));
    for (k = 0; k < 2 && run; ++k) EXPECT(pthread_create(&id[k], NULL, work, &status[k]) == 0);
    for (k = 0; k < 2 && run; ++k) EXPECT(pthread_join(id[k], NULL) == 0 && status[k] == 0);
    EXPECT(dlclose(plugin) == 0);
    EXPECT(!is_mapped(file) && !is_mapped("libplm"));
}

int main(int argc, char **argv) {
    const int at_start = threads();
    int k;
    for (k = 1; k < argc; ++k) {
        use_once(argv[k]), use_once(argv[k]);
        printf("%s: %d threads at the start, %d now\n", argv[k], at_start, threads());
        EXPECT(threads() == at_start);
    }
    EXPECT(argc > 1);
    return wrong();
}
