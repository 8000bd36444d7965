/* sampler.c: which pairs close and open as the dominant mode grows. */
#include "example.h"
#include <stdio.h>

static int run(plm_model *model) {
    /* [plm_sampler_create] [plm_sampler_destroy] */
    plm_sampler *sampler = NULL;
    TRY(plm_sampler_create(model, &sampler));
    TRY(plm_sampler_destroy(&sampler)); /* or leave it to the context */
    /* [plm_sampler_create] [plm_sampler_destroy] */
    TRY(plm_sampler_create(model, &sampler));

    /* [plm_sampler_set_int] [plm_sampler_set_double] [plm_sampler_set_string] */
    TRY(plm_sampler_set_string(sampler, "system", "open"));
    TRY(plm_sampler_set_int(sampler, "mode", 1)); /* 0: proposed by its participation */
    TRY(plm_sampler_set_double(sampler, "window_half_width", 0.1));
    /* [plm_sampler_set_int] [plm_sampler_set_double] [plm_sampler_set_string] */

    /* [plm_sampler_add_dominant_mode] */
    TRY(plm_sampler_add_dominant_mode(sampler, PLM_SYSTEM_SLIDING, 2));
    /* [plm_sampler_add_dominant_mode] */

    /* [plm_sampler_run] */
    TRY(plm_sampler_run(sampler));
    /* [plm_sampler_run] */

    /* [plm_sampler_get_int] [plm_sampler_get_double] [plm_sampler_get_string] */
    int64_t samples;
    double bilinear, low, high;
    char why[200];
    TRY(plm_sampler_get_int(sampler, "n_selected", &samples));
    TRY(plm_sampler_get_double(sampler, "blf_hz", &bilinear));
    TRY(plm_sampler_get_double(sampler, "window_low_hz", &low));
    TRY(plm_sampler_get_double(sampler, "window_high_hz", &high));
    TRY(plm_sampler_get_string(sampler, "window_why", sizeof why, why, NULL));
    printf("%d samples; bilinear frequency %.3f Hz; from %.2f to %.2f Hz: %s\n", (int)samples, bilinear, low,
           high, why);
    /* [plm_sampler_get_int] [plm_sampler_get_double] [plm_sampler_get_string] */

    /* [plm_sampler_get_array] [plm_sampler_get_int_array] */
    double alpha[16]; /* where the contact set changes as the mode grows */
    int64_t closed[16], n, entries;
    TRY(plm_sampler_get_array(sampler, "sweep_alpha", 16, alpha, &n));
    TRY(plm_sampler_get_int_array(sampler, "selected_samples", 16, closed, &entries)); /* n_pairs x samples */
    for (int64_t k = 0; k < entries; k++) printf("sample %d: %s\n", (int)k, closed[k] ? "closed" : "open");
    /* [plm_sampler_get_array] [plm_sampler_get_int_array] */
    EXPECT(entries == samples && n > 0 && bilinear > low && bilinear < high);
    return 0;
}

int example(plm_context *ctx) {
    plm_model *model = NULL;
    TRY(start_model(ctx, &model));
    TRY(plm_model_build(model));
    return run(model);
}
