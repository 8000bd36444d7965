#include "check.h"

int refused(plm_context *ctx, plm_status got, plm_status want, const char *function, const char *argument,
            int64_t index, const char *words) {
    char text[2000] = "", where[200] = "", which[200] = "";
    plm_status status = 0;
    int64_t position = -2;
    int ok;
    plm_context_get_error_text(ctx, sizeof text, text, NULL);
    plm_context_get_error_function(ctx, sizeof where, where, NULL);
    plm_context_get_error_argument(ctx, sizeof which, which, NULL);
    plm_context_get_error_info(ctx, &status, NULL, &position, NULL);
    ok = got == want && status == want && strcmp(where, function) == 0 && strcmp(which, argument) == 0 &&
         position == index && strstr(text, words) != NULL && strncmp(text, function, strlen(function)) == 0;
    if (!ok)
        printf("    wanted %d %s(%s, %lld) \"%s\"\n    got    %d/%d %s(%s, %lld) \"%s\"\n", (int)want,
               function, argument, (long long)index, words, (int)got, (int)status, where, which,
               (long long)position, text);
    return ok;
}

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1 /* as gcc says it */
#endif
#endif

int next_case(int watched) {
#ifdef __SANITIZE_ADDRESS__
    return watched;
#else
    return (void)watched, 1;
#endif
}

int close_to(double got, double want, double relative) {
    const int ok = fabs(got - want) <= relative * fabs(want);
    if (!ok) printf("    got %.17g, want %.17g (relative tolerance %g)\n", got, want, relative);
    return ok;
}

double larger(double a, double b) {
    return isnan(a) || a > b ? a : b;
}

int done(plm_context *ctx, plm_status got) {
    char text[2000] = "";
    if (got == PLM_OK) return 1;
    plm_context_get_error_text(ctx, sizeof text, text, NULL);
    printf("    status %d: %s\n", (int)got, text);
    return 0;
}

int done_but_for(plm_context *ctx, plm_status got, int32_t reason) {
    int32_t why = PLM_REASON_NONE;
    if (got == PLM_WARNING) plm_context_get_error_info(ctx, NULL, &why, NULL, NULL);
    return (got == PLM_WARNING && why == reason) || done(ctx, got);
}
