/* Process-wide failing malloc: the k-th allocation of a whole run fails, whoever asks for it (libplm,
 * CHOLMOD, FFTW, the BLAS, the language's runtimes), alone or with all that follow. The library must say
 * PLM_ERR_MEMORY, or have got on without; the same context then does the run with the results it has always
 * had. Nothing may crash, end the process, or hang. Arguments: every STEP-th allocation only, from FIRST on,
 * 'alone' or 'followed' by all others; otherwise the two take turns. */
#define _GNU_SOURCE
#include "check_host.h"
#include "whole_run.h"
#include <dlfcn.h>
#include <errno.h>
#include <malloc.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SECONDS = 100, FAILED = 1, DIFFERENT = 2, WRONG_STATUS = 3 };

/* ---- the allocation functions of this process, before those of the C library */
void *__libc_malloc(size_t bytes);
void *__libc_calloc(size_t count, size_t bytes);
void *__libc_realloc(void *block, size_t bytes);
void *__libc_memalign(size_t alignment, size_t bytes);

static long count, first_bad, last_bad; /* those from first_bad to last_bad fail */
/* A BLAS that libplm shares with its host is the host's, whatever it does without memory (OpenBLAS's kernels
 * for small products on AVX-512 write to what malloc did not give). One that libplm carries gets nothing. */
static int from_host_blas(const void *caller) {
#ifdef PLM_SELF_CONTAINED
    (void)caller;
    return 0;
#else
    Dl_info where;
    return dladdr(caller, &where) && where.dli_fname && strstr(where.dli_fname, "blas") != NULL;
#endif
}
static int refused(const void *caller) {
    const long k = __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED);
    if (k < first_bad || k > last_bad || from_host_blas(caller)) return 0;
    errno = ENOMEM;
    return 1;
}
void *malloc(size_t bytes) {
    return refused(__builtin_return_address(0)) ? NULL : __libc_malloc(bytes);
}
void *calloc(size_t n, size_t bytes) {
    return refused(__builtin_return_address(0)) ? NULL : __libc_calloc(n, bytes);
}
void *realloc(void *block, size_t bytes) {
    return refused(__builtin_return_address(0)) ? NULL : __libc_realloc(block, bytes);
}
void *memalign(size_t alignment, size_t bytes) {
    return refused(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
}
void *aligned_alloc(size_t alignment, size_t bytes) {
    return refused(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
}
int posix_memalign(void **block, size_t alignment, size_t bytes) {
    void *got = refused(__builtin_return_address(0)) ? NULL : __libc_memalign(alignment, bytes);
    if (got) *block = got;
    return got ? 0 : ENOMEM;
}

/* ---- one run in a child */
static outcome want;

static int starved_run(long k, int all_that_follow) {
    plm_context *ctx = NULL;
    outcome got;
    plm_status s;
    count = 0, first_bad = k, last_bad = all_that_follow ? 1L << 40 : k;
    s = plm_context_create(PLM_API_VERSION, &ctx);
    if (s == PLM_OK) s = whole_run(ctx, SMALL, &got);
    first_bad = last_bad = 0;
    if (s < 0 && s != PLM_ERR_MEMORY) {
        fprintf(stderr, "allocation %ld: status %d\n", k, (int)s);
        return WRONG_STATUS;
    }
    if (!ctx && plm_context_create(PLM_API_VERSION, &ctx) != PLM_OK) return FAILED;
    if (whole_run(ctx, SMALL, &got) < 0) return FAILED;
    if (memcmp(&want, &got, sizeof want) != 0) return DIFFERENT;
    plm_context_destroy(&ctx);
    return 0;
}

static void try_one(long k, int all_that_follow) {
    int status = 0;
    const pid_t child = fork();
    if (child == 0) {
        alarm(SECONDS);
        _exit(starved_run(k, all_that_follow));
    }
    EXPECT(child > 0 && waitpid(child, &status, 0) == child);
    EXPECT(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        printf("allocation %ld%s: %s %d\n", k, all_that_follow ? " and all that follow" : "",
               WIFEXITED(status) ? "returned" : "ended by signal",
               WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status));
}

/* In a child, so that the library is as new there as in each of the others. */
static long run_once(void) {
    int result[2], status = 0;
    long total = 0;
    pid_t child;
    if (pipe(result) != 0) return 0;
    child = fork();
    if (child == 0) {
        plm_context *ctx = NULL;
        count = 0;
        if (plm_context_create(PLM_API_VERSION, &ctx) != PLM_OK || whole_run(ctx, SMALL, &want) < 0) _exit(1);
        total = count;
        _exit(write(result[1], &want, sizeof want) != (ssize_t)sizeof want ||
              write(result[1], &total, sizeof total) < 0);
    }
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0) return 0;
    if (read(result[0], &want, sizeof want) != (ssize_t)sizeof want) return 0;
    if (read(result[0], &total, sizeof total) != (ssize_t)sizeof total) return 0;
    close(result[0]), close(result[1]);
    return total;
}

int main(int argc, char **argv) {
    const long step = argc > 1 ? atol(argv[1]) : 1, first = argc > 2 ? atol(argv[2]) : 1;
    const char *kind = argc > 3 ? argv[3] : "";
    const long total = run_once();
    long k, tried = 0;
    setvbuf(stdout, NULL, _IONBF, 0); /* or children would print it again */
    EXPECT(total > 100 && step > 0);
    for (k = first; step > 0 && k <= total; k += step, ++tried)
        try_one(k, *kind ? strcmp(kind, "followed") == 0 : tried % 2 != 0);
    printf("%ld of %ld allocations failed in turn\n", tried, total);
    return wrong();
}
