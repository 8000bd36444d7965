/* A progress callback that waits for another thread, which is itself inside the library: no lock of the
 * library's is held while a host's function runs. And one that calls the library with a context of its own.
 */
#define _POSIX_C_SOURCE 200809L
#include "check_host.h"
#include "lattice.h"
#include <pthread.h>
#include <string.h>
#include <unistd.h>

enum { SIDE = 12, SECONDS = 100 };

typedef struct {
    int with_thread, calls;
    plm_status status;
    double hz[3];
} other_work;

static void *frequencies(void *user) {
    other_work *o = (other_work *)user;
    plm_context *ctx = NULL;
    o->status = plm_context_create(PLM_API_VERSION, &ctx);
    if (!o->status) o->status = lattice_modes(ctx, SIDE, o->hz);
    plm_context_destroy(&ctx);
    return NULL;
}

static int32_t progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    other_work *o = (other_work *)user;
    pthread_t second;
    (void)ctx, (void)stage, (void)fraction;
    if (++o->calls != 20) return 0; /* in the middle of the modes */
    if (!o->with_thread) {
        frequencies(o);
    } else if (pthread_create(&second, NULL, frequencies, o) == 0) {
        pthread_join(second, NULL);
    }
    return 0;
}

int main(void) {
    plm_context *ctx = NULL;
    other_work alone;
    int with_thread;
    memset(&alone, 0, sizeof alone);
    frequencies(&alone);
    EXPECT(alone.status == PLM_OK && alone.hz[0] > 0);
    EXPECT(plm_context_create(PLM_API_VERSION, &ctx) == PLM_OK);
    alarm(SECONDS); /* a deadlock ends here */
    for (with_thread = 0; with_thread < 2; ++with_thread) {
        other_work other;
        double hz[3] = {0, 0, 0};
        memset(&other, 0, sizeof other);
        other.with_thread = with_thread;
        EXPECT(plm_context_set_progress(ctx, progress, &other) == PLM_OK);
        EXPECT(lattice_modes(ctx, SIDE, hz) == PLM_OK);
        printf("%d progress calls; the other one's status %d\n", other.calls, (int)other.status);
        EXPECT(other.calls > 20 && other.status == PLM_OK);
        EXPECT(memcmp(hz, alone.hz, sizeof hz) == 0 && memcmp(other.hz, alone.hz, sizeof hz) == 0);
    }
    EXPECT(plm_context_destroy(&ctx) == PLM_OK);
    return wrong();
}
