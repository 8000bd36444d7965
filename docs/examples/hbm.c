/* hbm.c: the periodic response: a curve, its peak, one frequency. */
#include "example.h"
#include <stdio.h>

static int sweep(plm_basis *basis) {
    /* [plm_hbm_create] [plm_hbm_destroy] */
    plm_hbm *hbm = NULL;
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_destroy(&hbm));
    /* [plm_hbm_create] [plm_hbm_destroy] */
    TRY(plm_hbm_create(basis, &hbm));

    /* [plm_hbm_set_int] [plm_hbm_set_double] [plm_hbm_set_string] */
    TRY(plm_hbm_set_int(hbm, "n_harmonics", 7));
    TRY(plm_hbm_set_double(hbm, "frequency_min_hz", 10));
    TRY(plm_hbm_set_double(hbm, "frequency_max_hz", 13));
    TRY(plm_hbm_set_string(hbm, "unknowns", "modal"));
    /* [plm_hbm_set_int] [plm_hbm_set_double] [plm_hbm_set_string] */

    /* [plm_hbm_get_int] [plm_hbm_get_double] [plm_hbm_get_string] */
    int64_t harmonics;
    double from;
    char direction[8];
    TRY(plm_hbm_get_int(hbm, "n_harmonics", &harmonics));
    TRY(plm_hbm_get_double(hbm, "frequency_min_hz", &from));
    TRY(plm_hbm_get_string(hbm, "direction", sizeof direction, direction, NULL));
    printf("H = %d, from %g Hz on, %s\n", (int)harmonics, from, direction);
    /* [plm_hbm_get_int] [plm_hbm_get_double] [plm_hbm_get_string] */

    /* [plm_hbm_sweep] */
    plm_branch *curve = NULL;
    const plm_status ended = plm_hbm_sweep(hbm, &curve);
    if (ended < 0) return __LINE__;
    if (ended > 0) printf("the curve ends early, see its \"end_text\"\n");
    /* [plm_hbm_sweep] */
    EXPECT(ended == 0 && harmonics == 7);

    /* [plm_hbm_find_peak] */
    double hz, amplitude;
    plm_branch *peak = NULL; /* that point; NULL instead of &peak if it is not wanted */
    TRY(plm_hbm_find_peak(hbm, curve, 1, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude, &peak));
    printf("peak: %.4g mm at %.4f Hz\n", 1e3 * amplitude, hz);
    /* [plm_hbm_find_peak] */

    /* [plm_hbm_solve] */
    plm_branch *cold = NULL, *warm = NULL;
    TRY(plm_hbm_solve(hbm, 11, NULL, 0, &cold));        /* from nothing */
    TRY(plm_hbm_solve(hbm, 0.99 * hz, peak, 0, &warm)); /* from the solution at the peak */
    /* [plm_hbm_solve] */
    EXPECT(amplitude > 0.005 && amplitude < 0.02);
    return 0;
}

int example(plm_context *ctx) {
    plm_basis *basis = NULL;
    TRY(start_basis(ctx, &basis));
    return sweep(basis);
}
