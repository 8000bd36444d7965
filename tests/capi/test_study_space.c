/* A study whose methods share the contact space of the model: what it spares, and what each is charged. */
#include "cracked_plate.h"
#include "scene_model.h"
#include "study_case.h"

static plm_context *ctx;

#define DONE(call) assert_true(done(ctx, call))

/* The contact space of the cracked plate for three methods that use it and one that does not: made once there
 * is one measurement, and the methods are charged as if each had made it. The answers are the
 * same, since the space is. */
static void a_shared_contact_space_is_charged_to_all_that_use_it(void **state) {
    static const char *const kinds[] = {"plm", "bilinear", "full", "craig_bampton"};
    enum { N = 4 };
    cracked_plate_params params;
    scene *host = NULL;
    double peak[2][N], setup[2][N], space[2][N];
    int k, shared;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    cracked_plate_quick(&params);
    assert_int_equal(cracked_plate_create(&params, &host), SCENE_OK);
    for (shared = 0; shared < 2; ++shared) {
        plm_model *model = NULL;
        plm_sampler *sampler = NULL;
        plm_basis *basis = NULL;
        plm_hbm *hbm = NULL;
        plm_study *study = NULL;
        int64_t n = 0;
        DONE(scene_to_model(ctx, host, &model));
        DONE(plm_sampler_create(model, &sampler));
        DONE(plm_sampler_set_int(sampler, "mode", host->dominant_mode));
        DONE(plm_sampler_set_string(sampler, "system", "open"));
        DONE(plm_basis_create(model, &basis));
        DONE(plm_basis_set_sampler(basis, sampler));
        DONE(plm_hbm_create(basis, &hbm));
        DONE(plm_hbm_set_int(hbm, "n_harmonics", 1)); /* short curves: the set-up is what counts */
        DONE(plm_hbm_set_string(hbm, "stability", "off"));
        DONE(plm_study_create(model, &study));
        DONE(plm_study_set_int(study, "repeats", 1));
        DONE(plm_study_set_int(study, "share_space", shared));
        DONE(plm_study_set_double(study, "curve_tolerance", 1e-4));
        DONE(plm_study_set_output(study, host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0));
        for (k = 0; k < N; ++k) {
            DONE(plm_basis_set_string(basis, "kind", kinds[k]));
            DONE(plm_study_add_response(study, kinds[k], hbm, NULL));
        }
        DONE(plm_study_run(study));
        DONE(plm_study_get_array(study, "peak_amplitude", N, peak[shared], &n));
        DONE(plm_study_get_array(study, "setup_seconds", N, setup[shared], &n));
        DONE(plm_study_get_array(study, "space_seconds", N, space[shared], &n));
        for (k = 0; k < N; ++k) {
            assert_true(setup[shared][k] >= space[shared][k]);
            print_message("share_space %d, %s: set-up %.3f s, space %.3f s\n", shared, kinds[k],
                          setup[shared][k], space[shared][k]);
        }
        assert_true(space[shared][0] > 0 && space[shared][3] == 0); /* Craig-Bampton has a space of its own */
        plm_model_destroy(&model);
    }
    assert_true(space[1][0] == space[1][1] && space[1][1] == space[1][2]);       /* one measurement */
    assert_true(space[0][0] != space[0][1] && space[0][1] != space[0][2]);       /* one each */
    for (k = 0; k < N; ++k) assert_true(close_to(peak[1][k], peak[0][k], 1e-7)); /* the spaces' tolerance */
    scene_destroy(&host);
    plm_context_destroy(&ctx);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shared_contact_space_is_charged_to_all_that_use_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
