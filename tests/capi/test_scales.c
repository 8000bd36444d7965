/* Numbers so large or small that their squares overflow or vanish are refused where they are handed over,
 * with words; no result is infinite or NaN with PLM_OK. */
#include "check.h"
#include "oscillator.h"

static const oscillator sane = {1, 0.1, 3, 0.1, 1};

typedef struct {
    plm_status status;
    char function[60], text[300];
} outcome;

static outcome built(oscillator o) {
    outcome out = {PLM_OK, "", ""};
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    if (plm_context_create(PLM_API_VERSION, &ctx)) return out;
    out.status = oscillator_built(ctx, &o, 1, &model, NULL);
    if (out.status < 0) {
        plm_context_get_error_function(ctx, sizeof out.function, out.function, NULL);
        plm_context_get_error_text(ctx, sizeof out.text, out.text, NULL);
    }
    plm_context_destroy(&ctx);
    return out;
}

static int is_refused(const char *what, oscillator o, plm_status want, const char *function) {
    const outcome got = built(o);
    printf("    %s: %s\n", what, got.text);
    return got.status == want && strcmp(got.function, function) == 0;
}

static void models_of_absurd_size_are_refused(void **state) {
    oscillator o = sane;
    (void)state;
    assert_int_equal(built(o).status, PLM_OK);
    o.k = 4e297;
    assert_true(is_refused("spring", o, PLM_ERR_MATRIX, "plm_model_set_matrix_i64"));
    o.k = 1e-300;
    assert_true(is_refused("spring", o, PLM_ERR_MATRIX, "plm_model_build"));
    o = sane, o.force = 4e297;
    assert_true(is_refused("force", o, PLM_ERR_ARGUMENT, "plm_model_set_excitation"));
    o.force = 1e-300;
    assert_true(is_refused("force", o, PLM_ERR_ARGUMENT, "plm_model_build"));
    o = sane, o.k_n = 1e300;
    assert_true(is_refused("contact", o, PLM_ERR_ARGUMENT, "plm_model_add_gap_rows_i64"));
    o = sane, o.gap = -1e200;
    assert_true(is_refused("gap", o, PLM_ERR_ARGUMENT, "plm_model_add_gap_rows_i64"));
    o = sane, o.c = 1e100;
    assert_true(is_refused("damper", o, PLM_ERR_ARGUMENT, "plm_model_set_rayleigh_damping"));
}

static void frequencies_of_absurd_size_are_refused(void **state) {
    plm_context *ctx = NULL;
    plm_model *model = NULL;
    plm_basis *basis = NULL;
    plm_hbm *hbm = NULL;
    plm_branch *branch = NULL;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    assert_int_equal(oscillator_built(ctx, &sane, 1, &model, &basis), PLM_OK);
    assert_int_equal(plm_hbm_create(basis, &hbm), PLM_OK);
    assert_true(refused(ctx, plm_hbm_solve(hbm, 1e-300, NULL, 0, &branch), PLM_ERR_ARGUMENT, "plm_hbm_solve",
                        "frequency_hz", -1, "1e-300"));
    assert_true(refused(ctx, plm_hbm_set_double(hbm, "frequency_min_hz", 1e-300), PLM_ERR_ARGUMENT,
                        "plm_hbm_set_double", "value", -1, "1e-300"));
    assert_true(refused(ctx, plm_hbm_set_double(hbm, "force_scale", 1e200), PLM_ERR_ARGUMENT,
                        "plm_hbm_set_double", "value", -1, "1e+200"));
    assert_null(branch);
    assert_int_equal(plm_hbm_set_double(hbm, "force_scale", 0),
                     PLM_OK); /* nothing at all is no small number */
    assert_int_equal(plm_context_destroy(&ctx), PLM_OK);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_of_absurd_size_are_refused),
        cmocka_unit_test(frequencies_of_absurd_size_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
