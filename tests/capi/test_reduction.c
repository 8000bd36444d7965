/* Bases of kind "snapshots" and node sampling by their keys: results, what a branch then reports, what is
 * refused and that nothing has changed then. */
#include "check.h"
#include "cracked_plate.h"
#include "scene_model.h"

static plm_context *ctx;
static scene *host;
static plm_model *model;
static plm_sampler *sampler;

#define REFUSED(call, status, function, argument, words)                                                     \
    assert_true(refused(ctx, call, status, function, argument, -1, words))
#define BAD(call, function, argument, words) REFUSED(call, PLM_ERR_ARGUMENT, function, argument, words)
#define DONE(call) assert_true(done(ctx, call))

static int open_plate(void **state) {
    cracked_plate_params params;
    (void)state;
    cracked_plate_quick(&params);
    params.with_preload = 1;
    return cracked_plate_create(&params, &host) || plm_context_create(PLM_API_VERSION, &ctx) ||
           scene_to_model(ctx, host, &model) || plm_sampler_create(model, &sampler) ||
           plm_sampler_set_int(sampler, "mode", host->dominant_mode) ||
           plm_sampler_set_string(sampler, "system", "open") || plm_sampler_run(sampler);
}
static int close_plate(void **state) {
    (void)state;
    scene_destroy(&host);
    return plm_context_destroy(&ctx);
}

static plm_basis *basis_of(const char *kind, int64_t n_pairs_carried) {
    plm_basis *b = NULL;
    DONE(plm_basis_create(model, &b));
    DONE(plm_basis_set_string(b, "kind", kind));
    DONE(plm_basis_set_sampler(b, sampler));
    DONE(plm_basis_set_int(b, "n_pairs_carried", n_pairs_carried));
    DONE(plm_basis_build(b));
    return b;
}

static plm_branch *peak_of(plm_basis *basis, plm_hbm **hbm) {
    double hz, amplitude;
    plm_branch *curve = NULL, *top = NULL;
    DONE(plm_hbm_create(basis, hbm));
    DONE(plm_hbm_set_int(*hbm, "n_harmonics", 3));
    DONE(plm_hbm_set_string(*hbm, "stability", "off"));
    DONE(plm_hbm_set_string(*hbm, "bifurcations", "off"));
    /* few pairs are carried, and that is said */
    assert_true(done_but_for(ctx, plm_hbm_sweep(*hbm, &curve), PLM_REASON_BASIS_TOO_SMALL));
    assert_true(done_but_for(
        ctx,
        plm_hbm_find_peak(*hbm, curve, host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, &hz, &amplitude, &top),
        PLM_REASON_BASIS_TOO_SMALL));
    return top;
}

static void what_a_basis_of_snapshots_tells(void **state) {
    plm_basis *b = basis_of("snapshots", 0);
    int64_t size = 0, rest_modes = 0, collected = 0, count = -1, pairs[100], i;
    double highest = 0, window = 0;
    char text[100];
    (void)state;
    DONE(plm_basis_get_int(b, "size", &size));
    DONE(plm_basis_get_int(b, "n_rest_modes", &rest_modes));
    DONE(plm_basis_get_int(b, "n_collected", &collected));
    assert_true(rest_modes >= 3 && rest_modes < collected && size >= collected && size <= 12);
    DONE(plm_basis_get_double(b, "highest_frequency_hz", &highest));
    DONE(plm_basis_get_double(b, "window_high_hz", &window));
    assert_true(close_to(highest, 5.5 * window, 1e-12));
    DONE(plm_basis_get_string(b, "warning", sizeof text, text, NULL));
    assert_string_equal(text, "");
    DONE(plm_basis_get_int_array(b, "sample_n_modes", 0, NULL, &count));
    assert_int_equal(count, 0); /* it has no samples */
    DONE(plm_basis_get_int_array(b, "pairs_carried", 100, pairs, &count));
    assert_int_equal(count, host->n_pairs);
    for (i = 0; i < count; ++i) assert_int_equal(pairs[i], i);
}

/* All pairs are reported, the force of each from its own penetration. */
static void contact_of_all_pairs(plm_branch *top) {
    int64_t z = 0, i;
    double share[100], penetration[100], force[100];
    int32_t closed[100];
    DONE(plm_branch_get_int(top, "n_pairs", &z));
    assert_int_equal(z, host->n_pairs);
    DONE(plm_branch_get_closed_share(top, 0, z, share));
    BAD(plm_branch_get_closed_share(top, 0, 4, share), "plm_branch_get_closed_share", "n", "n is 4");
    DONE(plm_branch_get_contact(top, 0, 1, penetration, force, closed));
    for (i = 0; i < z; ++i) {
        assert_int_equal(closed[i], penetration[i] > 0);
        assert_true((force[i] > 0) == (penetration[i] > 0));
        assert_true(share[i] >= 0 && share[i] <= 1);
    }
}

static void node_sampling(void **state) {
    static const char *const kinds[] = {"plm", "craig_bampton", "full", "snapshots"};
    int k;
    (void)state;
    for (k = 0; k < 4; ++k) {
        plm_basis *b = basis_of(kinds[k], 4), *refined = NULL;
        plm_hbm *hbm = NULL;
        plm_branch *top = peak_of(b, &hbm);
        int64_t count = 0, pairs[100], i;
        double residual = 0, amplitude[3], hz[3], error = 0;
        DONE(plm_basis_get_int_array(b, "pairs_carried", 100, pairs, &count));
        assert_int_equal(count, 4);
        for (i = 1; i < 4; ++i) assert_true(pairs[i] > pairs[i - 1] && pairs[i] < host->n_pairs);
        contact_of_all_pairs(top);
        DONE(plm_branch_get_full_residual(top, 0, &residual));
        assert_true(residual >
                    1e-4); /* what the pairs left out do is in it, also on the unreduced structure */
        DONE(plm_hbm_estimate_error(hbm, top, 0, host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, amplitude, hz));
        assert_true(fabs(amplitude[0] + amplitude[1]) > 0);
        if (k > 0) continue;
        DONE(plm_hbm_refine_basis(hbm, host->output_dof, PLM_HALF_PEAK_TO_PEAK, 0, 1e-3, &refined, &error));
        DONE(plm_basis_get_int_array(refined, "pairs_carried", 100, pairs, &count));
        assert_int_equal(count, host->n_pairs); /* a tolerance is met by all of them */
    }
}

static void rules_choose_differently(void **state) {
    plm_basis *b = basis_of("plm", 4);
    int64_t count = 0, one[4], other[4];
    (void)state;
    DONE(plm_basis_get_int_array(b, "pairs_carried", 4, one, &count));
    DONE(plm_basis_set_string(b, "pair_rule", "mdof"));
    DONE(plm_basis_build(b));
    DONE(plm_basis_get_int_array(b, "pairs_carried", 4, other, &count));
    assert_true(memcmp(one, other, sizeof one) != 0);
}

static void what_is_refused(void **state) {
    plm_basis *b = basis_of("snapshots", 0), *bare = NULL;
    int64_t size = 0, after = 0;
    (void)state;
    DONE(plm_basis_get_int(b, "size", &size));
    BAD(plm_basis_set_double(b, "rest_factor", 0), "plm_basis_set_double", "value", "rest_factor");
    BAD(plm_basis_set_int(b, "n_snapshots", 1), "plm_basis_set_int", "value", "n_snapshots");
    BAD(plm_basis_set_double(b, "snapshot_tolerance", 0.6), "plm_basis_set_double", "value", "0.6");
    BAD(plm_basis_set_string(b, "pair_rule", "all"), "plm_basis_set_string", "value", "all");
    BAD(plm_basis_set_int(b, "n_pairs_carried", -1), "plm_basis_set_int", "value", "-1");
    DONE(plm_basis_set_int(b, "n_pairs_carried", host->n_pairs + 1));
    BAD(plm_basis_build(b), "plm_basis_build", "n_pairs_carried", "0 carries all of them");
    DONE(plm_basis_get_int(b, "size", &after)); /* the one built before is still there */
    assert_int_equal(after, size);
    DONE(plm_basis_create(model, &bare));
    DONE(plm_basis_set_string(bare, "kind", "snapshots"));
    REFUSED(plm_basis_build(bare), PLM_ERR_STATE, "plm_basis_build", "sampler", "needs a sampler");
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, open_plate, close_plate)
    const struct CMUnitTest tests[] = {
        TEST(what_a_basis_of_snapshots_tells),
        TEST(node_sampling),
        TEST(rules_choose_differently),
        TEST(what_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
