/* study_progress.c: signs of life. */
#define _POSIX_C_SOURCE 200809L /* clock_gettime: C99 has no wall clock finer than a second */
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "study.h"

static const double silence = 4; /* seconds between two lines of progress */

double study_seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void study_say(study_case *c, const char *format, ...) {
    va_list arguments;
    c->last_note = study_seconds();
    printf("[%6.1f s] ", c->last_note - c->begin);
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
    fflush(stdout);
}

/* Ctrl-C and the like end the study in order: what is done by then is reported. */
static volatile sig_atomic_t stopped;

static void stop(int number) {
    (void)number;
    stopped = 1;
}

void study_watch_signals(void) {
    signal(SIGINT, stop);
    signal(SIGTERM, stop);
}

int study_stopped(void) {
    return stopped;
}

int32_t study_progress(plm_context *ctx, const char *stage, double fraction, void *user) {
    study_case *c = user;
    (void)ctx;
    if (study_seconds() - c->last_note > silence) study_say(c, "  %s: %.0f %%", stage, 100 * fraction);
    return stopped;
}

/* The library's note on each method that is done. */
void study_log(plm_context *ctx, int32_t level, const char *text, void *user) {
    (void)ctx;
    if (level > 0 && !strncmp(text, "study: ", 7)) study_say(user, "%s", text + 7);
}
