/* study_progress.c: signs of life. */
#define _POSIX_C_SOURCE 200809L /* clock_gettime: C99 has no wall clock finer than a second */
#include <stdarg.h>
#include <stdio.h>
#include <time.h>

#include "study.h"

static const double silence = 4; /* seconds between two lines of progress */

double study_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void study_say(study *s, const char *format, ...) {
    va_list arguments;
    s->last_note = study_seconds();
    printf("[%6.1f s] ", s->last_note - s->begin);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
    fflush(stdout);
}

int32_t study_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    study *s = user;
    (void)ctx;
    if (study_seconds() - s->last_note > silence) study_say(s, "  %s: %.0f %%", stage, 100 * fraction);
    return 0;
}
