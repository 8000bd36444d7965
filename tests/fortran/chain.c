/* chain.c: the scenario of examples/fortran77/chain.f by the C API; prints the same lines. */
#include <plm/plm.h>
#include <stdio.h>

enum { MASSES = 12, STOPS = 3, NNZ = 2 * MASSES - 1, COEFFICIENTS = 15 };

#define TRY(call)                                                                                            \
    if ((call) < 0) return 1

static void print(const char *name, double value) {
    printf("%-18s %24.16e\n", name, value);
}

static int make_model(plm_context *ctx, plm_model **model) {
    int32_t m_col[MASSES + 1], m_row[MASSES], k_col[MASSES + 1], k_row[NNZ], n = 0;
    const int32_t stop[] = {4, 8, 11}, start[] = {0, 1, 2, 3};
    const double unit[] = {1, 1, 1}, stiffness[] = {2e4, 3e4, 4e4}, gap[] = {0, 0.0009765625, 0.001953125};
    double m[MASSES], k[NNZ], force[MASSES] = {0};
    for (int32_t j = 0; j < MASSES; j++) {
        m_col[j] = m_row[j] = j;
        m[j] = 2;
        k_col[j] = n;
        k_row[n] = j;
        k[n++] = j + 1 < MASSES ? 8e4 : 4e4;
        if (j + 1 < MASSES) k_row[n] = j + 1, k[n++] = -4e4;
    }
    m_col[MASSES] = MASSES;
    k_col[MASSES] = n;
    force[MASSES - 1] = 1;
    TRY(plm_model_create(ctx, MASSES, model));
    TRY(plm_model_set_matrix_i32(*model, PLM_MASS, PLM_CSC, PLM_LOWER, 0, PLM_COPY, MASSES, m_col, m_row, m));
    TRY(plm_model_set_matrix_i32(*model, PLM_STIFFNESS, PLM_CSC, PLM_LOWER, 0, PLM_COPY, NNZ, k_col, k_row,
                                 k));
    TRY(plm_model_set_rayleigh_damping(*model, 0.5, 0.0001220703125));
    TRY(plm_model_add_gap_rows_i32(*model, 0, STOPS, start, stop, unit, stiffness, gap));
    TRY(plm_model_set_excitation(*model, 1, MASSES, force, NULL));
    TRY(plm_model_build(*model));
    return 0;
}

static int print_modes(plm_model *model) {
    double open[2], sliding[2];
    TRY(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 2, open, NULL));
    TRY(plm_model_get_modes(model, PLM_SYSTEM_SLIDING, NULL, 2, sliding, NULL));
    for (int i = 0; i < 2; i++) {
        print("open_hz", open[i]);
        print("sliding_hz", sliding[i]);
    }
    return 0;
}

static int follow(plm_model *model, plm_hbm **hbm, plm_branch **curve) {
    plm_sampler *sampler = NULL;
    plm_basis *basis = NULL;
    int64_t n = 0;
    TRY(plm_sampler_create(model, &sampler));
    TRY(plm_sampler_set_int(sampler, "mode", 1));
    TRY(plm_sampler_run(sampler));
    TRY(plm_basis_create(model, &basis));
    TRY(plm_basis_set_string(basis, "kind", "plm"));
    TRY(plm_basis_set_sampler(basis, sampler));
    TRY(plm_basis_build(basis));
    TRY(plm_hbm_create(basis, hbm));
    TRY(plm_hbm_set_int(*hbm, "n_harmonics", 7));
    TRY(plm_hbm_set_double(*hbm, "frequency_min_hz", 2));
    TRY(plm_hbm_set_double(*hbm, "frequency_max_hz", 5));
    TRY(plm_hbm_sweep(*hbm, curve));
    TRY(plm_basis_get_int(basis, "size", &n));
    printf("%-18s %8d\n", "basis_size", (int)n);
    TRY(plm_branch_get_int(*curve, "n_points", &n));
    printf("%-18s %8d\n", "n_points", (int)n);
    return 0;
}

static int print_peak(plm_hbm *hbm, plm_branch *curve) {
    plm_branch *peak = NULL;
    double hz = 0, amplitude = 0, coefficient[COEFFICIENTS], share[STOPS], q[MASSES];
    TRY(plm_hbm_find_peak(hbm, curve, MASSES - 1, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude, &peak));
    TRY(plm_branch_get_coefficients(peak, 0, MASSES - 1, 1, coefficient));
    TRY(plm_branch_get_closed_share(peak, 0, STOPS, share));
    TRY(plm_branch_get_field(peak, 0, 0.25, MASSES, q));
    print("peak_hz", hz);
    print("peak_m", amplitude);
    for (int i = 0; i < COEFFICIENTS; i++) print("coefficient", coefficient[i]);
    for (int i = 0; i < STOPS; i++) print("closed_share", share[i]);
    for (int i = 0; i < MASSES; i++) print("field", q[i]);
    return 0;
}

int main(void) {
    char text[512] = "";
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *curve = NULL;
    TRY(plm_context_create(PLM_API_VERSION, &ctx));
    const int failed = make_model(ctx, &model) || print_modes(model) || follow(model, &hbm, &curve) ||
                       print_peak(hbm, curve);
    if (failed) {
        plm_context_get_error_text(ctx, sizeof text, text, NULL);
        fprintf(stderr, "%s\n", text);
    }
    plm_context_destroy(&ctx);
    return failed;
}
