/* transient.c: motion in time: marching, a periodic motion and its stability. */
#include "example.h"
#include <stdio.h>
#include <stdlib.h>

enum { N_DOF = 2, MAX_MULTIPLIERS = 8 };

static int march(plm_model *model, plm_basis *basis) {
    /* [plm_transient_create] [plm_transient_destroy] */
    plm_transient *motion = NULL, *full = NULL;
    TRY(plm_transient_create(model, basis, &motion)); /* the reduced model, by its exact flow */
    TRY(plm_transient_create(model, NULL, &full));    /* the full one, step by step */
    TRY(plm_transient_destroy(&full));
    /* [plm_transient_create] [plm_transient_destroy] */

    /* [plm_transient_set_int] [plm_transient_set_double] */
    TRY(plm_transient_set_double(motion, "frequency_hz", 11)); /* of the excitation */
    TRY(plm_transient_set_double(motion, "settled", 1e-8));    /* stop when the motion repeats so well, */
    TRY(plm_transient_set_int(motion, "periods", 2000));       /* after these periods in any case */
    /* [plm_transient_set_int] [plm_transient_set_double] */

    /* [plm_transient_observe_i32] */
    const int32_t watched[] = {1};
    TRY(plm_transient_observe_i32(motion, 0, 1, watched));
    /* [plm_transient_observe_i32] */

    /* [plm_transient_observe_i64] */
    const int64_t wide[] = {2}; /* the same DOF, counted from 1 */
    TRY(plm_transient_observe_i64(motion, 1, 1, wide));
    /* [plm_transient_observe_i64] */

    /* [plm_transient_set_state] */
    const double q[N_DOF] = {0.001, 0.002};
    TRY(plm_transient_set_state(motion, N_DOF, q, NULL)); /* let go from here, at rest */
    /* [plm_transient_set_state] */

    /* [plm_transient_run] [plm_transient_get_int] [plm_transient_get_double] */
    const plm_status ended = plm_transient_run(motion); /* PLM_CANCELLED: what was marched is kept */
    int64_t periods;
    double change;
    TRY(plm_transient_get_int(motion, "periods_done", &periods));
    TRY(plm_transient_get_double(motion, "change", &change));
    printf("%d periods, the last one changed the state by %.2g\n", (int)periods, change);
    /* [plm_transient_run] [plm_transient_get_int] [plm_transient_get_double] */
    EXPECT(ended == PLM_OK && periods < 2000 && change < 1e-8);

    /* [plm_transient_get_history] [plm_transient_get_array] */
    int64_t n;
    TRY(plm_transient_get_history(motion, 0, 0, NULL, &n)); /* capacity 0: how many instants? */
    double *time = malloc((size_t)n * sizeof *time), *value = malloc((size_t)n * sizeof *value);
    plm_status s = time && value ? PLM_OK : PLM_ERR_MEMORY;
    if (!s) s = plm_transient_get_array(motion, "time", n, time, &n);
    if (!s) s = plm_transient_get_history(motion, 0, n, value, &n);
    if (!s) printf("at %.3f s: %.4f mm\n", time[n - 1], 1e3 * value[n - 1]);
    free(time), free(value);
    /* [plm_transient_get_history] [plm_transient_get_array] */
    EXPECT(s == PLM_OK && n > periods);
    return 0;
}

static int periodic(plm_model *model, plm_basis *basis, plm_branch *point) {
    plm_transient *motion = NULL;
    TRY(plm_transient_create(model, basis, &motion));
    /* [plm_transient_start_at] */
    TRY(plm_transient_start_at(motion, point, 0)); /* state, frequency and force of a point of a curve */
    /* [plm_transient_start_at] */

    /* [plm_transient_set_string] [plm_transient_get_string] */
    char word[8];
    TRY(plm_transient_set_string(motion, "march_when_stuck", "on"));
    TRY(plm_transient_get_string(motion, "motion", sizeof word, word, NULL)); /* "reduced" or "full" */
    /* [plm_transient_set_string] [plm_transient_get_string] */

    /* [plm_transient_find_periodic] */
    double defect;
    const plm_status found = plm_transient_find_periodic(motion);
    if (found < 0) return __LINE__;
    TRY(plm_transient_get_double(motion, "periodicity_defect", &defect));
    printf("%s: after a period the state comes back to %.2g\n", word, defect);
    /* [plm_transient_find_periodic] */

    /* [plm_transient_get_multipliers] */
    double real[MAX_MULTIPLIERS], imag[MAX_MULTIPLIERS];
    int64_t n;
    TRY(plm_transient_get_multipliers(motion, MAX_MULTIPLIERS, real, imag, &n));
    printf("the largest of %d multipliers is %.3f %+.3f i: %s\n", (int)n, real[0], imag[0],
           real[0] * real[0] + imag[0] * imag[0] < 1 ? "stable" : "unstable");
    /* [plm_transient_get_multipliers] */

    /* [plm_transient_get_state] */
    double q[N_DOF], v[N_DOF]; /* displacement and velocity of all DOFs now */
    TRY(plm_transient_get_state(motion, N_DOF, q, v));
    /* [plm_transient_get_state] */
    EXPECT(found == PLM_OK && defect < 1e-9 && n > 0 && q[1] != 0 && v[1] != 0);

    const int32_t all[] = {1, 0};
    TRY(plm_transient_observe_i32(motion, 0, N_DOF, all));
    TRY(plm_transient_run(motion));
    /* [plm_transient_get_int_array] */
    int64_t observed[N_DOF], count; /* DOFs whose histories the last run left, from 0 */
    TRY(plm_transient_get_int_array(motion, "observed", N_DOF, observed, &count));
    /* [plm_transient_get_int_array] */
    EXPECT(count == N_DOF && observed[0] == 1 && observed[1] == 0);
    return 0;
}

int example(plm_context *ctx) {
    plm_model *model = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *point = NULL;
    int line;
    TRY(start_model(ctx, &model));
    TRY(plm_model_build(model));
    TRY(basis_of(model, &basis));
    line = march(model, basis);
    if (line) return line;
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_solve(hbm, 11.3, NULL, 0, &point));
    return periodic(model, basis, point);
}
