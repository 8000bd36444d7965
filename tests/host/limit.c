/* A process whose address space is limited, as batch systems do it: from too little for anything to enough,
 * the library says PLM_ERR_MEMORY or delivers. OpenBLAS takes 128 MiB for itself on first use, and tries for
 * ever where it does not get them. */
#define _GNU_SOURCE
#include "check_host.h"
#include "whole_run.h"
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SECONDS = 60 };

static long long address_space(void) { /* bytes mapped now */
    long long pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (!f || fscanf(f, "%lld", &pages) != 1) pages = 0;
    if (f) fclose(f);
    return pages * sysconf(_SC_PAGESIZE);
}

static int limited_run(long long more) {
    struct rlimit limit;
    plm_context *ctx = NULL;
    outcome o;
    plm_status s;
    limit.rlim_cur = limit.rlim_max = (rlim_t)(address_space() + more);
    if (setrlimit(RLIMIT_AS, &limit) != 0) return 100;
    alarm(SECONDS);
    s = plm_context_create(PLM_API_VERSION, &ctx);
    if (s == PLM_OK) s = whole_run(ctx, SMALL, &o);
    plm_context_destroy(&ctx);
    return s >= 0 ? 0 : s == PLM_ERR_MEMORY ? 1 : 2;
}

int main(void) {
    static const int mebibytes[] = {0, 1, 4, 16, 100, 130, 160, 400};
    const int n = (int)(sizeof mebibytes / sizeof *mebibytes);
    int k;
    for (k = 0; k < n; ++k) {
        int status = 0;
        const pid_t child = fork();
        if (child == 0) _exit(limited_run((long long)mebibytes[k] << 20));
        EXPECT(child > 0 && waitpid(child, &status, 0) == child);
        EXPECT(WIFEXITED(status) && WEXITSTATUS(status) <= 1);
        if (k == n - 1) EXPECT(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        printf("%d MiB: %s %d\n", mebibytes[k], WIFEXITED(status) ? "returned" : "ended by signal",
               WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
        fflush(stdout);
    }
    return wrong();
}
