/* A host that forks after it used the library: no thread of the library's is missing in the child, which gets
 * the same frequencies, and none is left in the parent. The factorization of this model would be shared among
 * OpenMP threads by CHOLMOD as it comes; their pool waits for ever in a child. */
#define _POSIX_C_SOURCE 200809L
#include "check_host.h"
#include "lattice.h"
#include <dirent.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SIDE = 8, SECONDS = 100 /* more than any machine needs; the frequencies take 0.1 s */ };

static int threads(void) {
    DIR *tasks = opendir("/proc/self/task");
    int count = 0;
    while (tasks && readdir(tasks)) ++count;
    if (tasks) closedir(tasks);
    return count - 2; /* . and .. */
}

static plm_status frequencies(double *hz) {
    plm_context *ctx = NULL;
    plm_status s = plm_context_create(PLM_API_VERSION, &ctx);
    if (!s) s = lattice_modes(ctx, SIDE, hz);
    plm_context_destroy(&ctx);
    return s;
}

int main(void) {
    const int at_start = threads();
    double before[3] = {0, 0, 0}, after[3] = {0, 0, 0};
    int status = 0;
    pid_t child;
    EXPECT(frequencies(before) == PLM_OK && before[0] > 0);
    EXPECT(threads() == at_start);
    fflush(stdout);
    child = fork();
    if (child == 0) {
        double hz[3] = {0, 0, 0};
        alarm(SECONDS);
        _exit(frequencies(hz) != PLM_OK ? 2 : memcmp(hz, before, sizeof hz) != 0 ? 3 : 0);
    }
    EXPECT(child > 0 && waitpid(child, &status, 0) == child);
    EXPECT(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    EXPECT(frequencies(after) == PLM_OK && memcmp(before, after, sizeof before) == 0);
    printf("%g Hz; %d threads at the start, %d at the end; the child %s %d\n", before[0], at_start, threads(),
           WIFEXITED(status) ? "returned" : "was ended by signal",
           WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
    return wrong();
}
