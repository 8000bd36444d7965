/* branch.c: what is on a response curve. */
#include "example.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { H = 5, N_DOF = 2, N_PAIRS = 1, TIMES = 8, MULTIPLIERS = 8 };

static int whole_curve(plm_branch *curve) {
    /* [plm_branch_get_int] [plm_branch_get_double] [plm_branch_get_string] */
    int64_t points;
    double seconds;
    char end[100];
    TRY(plm_branch_get_int(curve, "n_points", &points));
    TRY(plm_branch_get_double(curve, "seconds", &seconds));
    TRY(plm_branch_get_string(curve, "end_text", sizeof end, end, NULL));
    printf("%d points in %.2g s; the end: %s\n", (int)points, seconds, end);
    /* [plm_branch_get_int] [plm_branch_get_double] [plm_branch_get_string] */

    /* [plm_branch_get_array] [plm_branch_get_int_array] [plm_branch_get_amplitude] */
    double *hz = malloc((size_t)points * sizeof *hz), *amplitude = malloc((size_t)points * sizeof *amplitude);
    int64_t *switching = malloc((size_t)points * sizeof *switching), n = 0;
    plm_status s = hz && amplitude && switching ? PLM_OK : PLM_ERR_MEMORY;
    if (!s) s = plm_branch_get_array(curve, "frequency_hz", points, hz, &n);
    if (!s) s = plm_branch_get_int_array(curve, "n_switching", points, switching, &n);
    if (!s) s = plm_branch_get_amplitude(curve, 1, PLM_HALF_PEAK_TO_PEAK, 0, points, amplitude, &n);
    for (int64_t i = 0; !s && i < n; i += 10)
        printf("%8.4f Hz %8.4f mm, %d pairs open and close\n", hz[i], 1e3 * amplitude[i], (int)switching[i]);
    free(hz), free(amplitude), free(switching);
    /* [plm_branch_get_array] [plm_branch_get_int_array] [plm_branch_get_amplitude] */
    EXPECT(s == PLM_OK && n == points && points > 10);
    return 0;
}

static int one_point(plm_branch *peak) {
    /* [plm_branch_get_coefficients] */
    double c[2 * H + 1]; /* a0, a1, b1, ... of DOF 1 at point 0 */
    TRY(plm_branch_get_coefficients(peak, 0, 1, 1, c));
    printf("mean %.3g mm, first harmonic %.3g and %.3g mm\n", 1e3 * c[0], 1e3 * c[1], 1e3 * c[2]);
    /* [plm_branch_get_coefficients] */

    /* [plm_branch_get_history] */
    double history[TIMES]; /* DOF 1 over the period */
    TRY(plm_branch_get_history(peak, 0, 1, TIMES, history));
    /* [plm_branch_get_history] */

    /* [plm_branch_get_field] */
    double q[N_DOF]; /* a quarter of the period after the force was highest */
    TRY(plm_branch_get_field(peak, 0, 0.25, N_DOF, q));
    /* [plm_branch_get_field] */

    /* [plm_branch_get_contact] */
    double penetration[N_PAIRS * TIMES], force[N_PAIRS * TIMES];
    int32_t closed[N_PAIRS * TIMES];
    TRY(plm_branch_get_contact(peak, 0, TIMES, penetration, force, closed));
    for (int t = 0; t < TIMES; t++)
        printf("t = %d/%d T: %s, %.3g N\n", t, TIMES, closed[t] ? "closed" : "open", force[t]);
    /* [plm_branch_get_contact] */

    /* [plm_branch_get_closed_share] */
    double share[N_PAIRS];
    TRY(plm_branch_get_closed_share(peak, 0, N_PAIRS, share));
    printf("closed for %.1f %% of the period\n", 100 * share[0]);
    /* [plm_branch_get_closed_share] */

    /* [plm_branch_get_energy] */
    double energy, area; /* means over the period; the energy is that above the structure at rest */
    TRY(plm_branch_get_energy(peak, 0, &energy, &area));
    printf("energy %.3g J, %.1f %% of the pairs closed in the mean\n", energy, 100 * area);
    /* [plm_branch_get_energy] */

    /* [plm_branch_get_full_residual] */
    double residual;
    TRY(plm_branch_get_full_residual(peak, 0, &residual));
    printf("relative residual of the unreduced equations: %.2g\n", residual);
    /* [plm_branch_get_full_residual] */
    EXPECT(share[0] > 0 && share[0] < 1 && residual < 1e-6 && q[1] != 0);
    EXPECT(energy > 0 && area > 0 && area < 1);
    return 0;
}

/* [plm_branch_write_to] [plm_branch_write_csv_to] */
static int32_t to_file(plm_context *ctx, int64_t n, const void *bytes, void *file) {
    (void)ctx;
    return fwrite(bytes, 1, (size_t)n, file) == (size_t)n ? 0 : 1;
}
static int keep_in_files(plm_branch *curve, FILE *state, FILE *table) {
    TRY(plm_branch_write_to(curve, to_file, state));
    TRY(plm_branch_write_csv_to(curve, 1, PLM_HALF_PEAK_TO_PEAK, 0, to_file, table));
    return 0;
}
/* [plm_branch_write_to] [plm_branch_write_csv_to] */

static int kept(plm_basis *basis, plm_branch *curve) {
    plm_branch *read = NULL;
    double before, after;
    /* [plm_branch_write] */
    int64_t size;
    void *bytes;
    TRY(plm_branch_write(curve, 0, NULL, &size)); /* how many? */
    bytes = malloc((size_t)size);
    EXPECT(bytes);
    TRY(plm_branch_write(curve, size, bytes, &size));
    /* [plm_branch_write] */
    FILE *state = tmpfile(), *table = tmpfile();
    EXPECT(state && table && keep_in_files(curve, state, table) == 0);
    EXPECT(ftell(state) == (long)size && ftell(table) > 100);
    fclose(state), fclose(table);

    /* [plm_branch_read] */
    TRY(plm_branch_read(basis, size, bytes, &read)); /* or a basis that was read from its own bytes */
    free(bytes);
    /* [plm_branch_read] */
    TRY(plm_branch_get_full_residual(curve, 5, &before));
    TRY(plm_branch_get_full_residual(read, 5, &after));
    EXPECT(before == after);

    /* [plm_branch_write_csv] */
    TRY(plm_branch_write_csv(read, 1, PLM_HALF_PEAK_TO_PEAK, 0, "example_branch.csv"));
    /* [plm_branch_write_csv] */
    EXPECT(remove("example_branch.csv") == 0);

    /* [plm_branch_describe] */
    char page[4096]; /* a longer text would be cut; the last argument tells how many bytes it needs */
    TRY(plm_branch_describe(read, sizeof page, page, NULL));
    fputs(page, stdout);
    /* [plm_branch_describe] */
    EXPECT(strstr(page, "Stability") != NULL);
    return 0;
}

static int in_time(plm_branch *curve, int64_t point) {
    /* [plm_branch_get_multipliers] */
    double real[MULTIPLIERS], imag[MULTIPLIERS]; /* two for each column of the basis */
    int64_t count;                               /* 0 where "stability" is "off" */
    TRY(plm_branch_get_multipliers(curve, point, MULTIPLIERS, real, imag, &count));
    for (int64_t i = 0; i < count; i++) printf("multiplier %.3f %+.3f i\n", real[i], imag[i]);
    /* [plm_branch_get_multipliers] */
    EXPECT(count > 0 && real[0] * real[0] + imag[0] * imag[0] < 1);

    /* [plm_branch_get_periodicity_defect] */
    double defect;
    TRY(plm_branch_get_periodicity_defect(curve, point, &defect));
    printf("marched from here, the motion repeats after a period to %.2g\n", defect);
    /* [plm_branch_get_periodicity_defect] */
    EXPECT(defect < 0.01);
    return 0;
}

static int show(plm_hbm *hbm, plm_basis *basis) {
    plm_branch *curve = NULL, *peak = NULL;
    double hz, amplitude;
    int line;
    TRY(plm_hbm_sweep(hbm, &curve));
    TRY(plm_hbm_find_peak(hbm, curve, 1, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude, &peak));
    line = whole_curve(curve);
    if (!line) line = one_point(peak);
    if (!line) line = in_time(curve, 5);
    if (!line) line = kept(basis, curve);
    if (line) return line;
    /* [plm_branch_destroy] */
    TRY(plm_branch_destroy(&curve)); /* its points are gone, the peak is a branch of its own */
    TRY(plm_branch_destroy(&peak));
    /* [plm_branch_destroy] */
    return 0;
}

int example(plm_context *ctx) {
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    TRY(start_basis(ctx, &basis));
    TRY(plm_hbm_create(basis, &hbm));
    TRY(plm_hbm_set_int(hbm, "n_harmonics", H));
    return show(hbm, basis);
}
