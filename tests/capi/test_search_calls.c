/* What the searches beside a response curve refuse, argument by argument, and that nothing has changed then:
 * the outputs, and the branches found before. */
#include "carrier.h"
#include "chain.h"
#include "check.h"
#include "oscillator.h"

static plm_context *ctx;
static plm_model *model;
static plm_basis *basis;
static plm_hbm *hbm;
static plm_branch *curve, *foreign; /* of this hbm, of one with another basis */
static int64_t fold = -1;

static int set_up(void **state) {
    const oscillator o = {1, 0.04, 3, 0, 1};
    plm_model *other_model = NULL;
    plm_basis *other_basis = NULL;
    plm_hbm *other = NULL;
    int64_t bifurcation[2000], n = 0, k;
    (void)state;
    if (plm_context_create(PLM_API_VERSION, &ctx)) return 1;
    if (!done(ctx, carrier_built(ctx, 0.004, &model, &basis)) ||
        !done(ctx, oscillator_built(ctx, &o, 0.7, &other_model, &other_basis)) ||
        !done(ctx, plm_hbm_create(basis, &hbm)) || !done(ctx, plm_hbm_create(other_basis, &other)) ||
        !done(ctx, plm_hbm_set_int(hbm, "n_harmonics", 5)) ||
        !done(ctx, plm_hbm_set_double(hbm, "force_scale", 0.02)) || !done(ctx, plm_hbm_sweep(hbm, &curve)) ||
        !done(ctx, plm_hbm_solve(other, 0.3, NULL, 0, &foreign)) ||
        !done(ctx, plm_branch_get_int_array(curve, "bifurcation", 2000, bifurcation, &n)))
        return 1;
    for (k = n - 1; k >= 0; --k)
        if (bifurcation[k] == PLM_BIFURCATION_FOLD) fold = k;
    return fold < 1;
}
static int tear_down(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

#define REFUSED(call, status, function, argument, index, words)                                              \
    assert_true(refused(ctx, call, status, function, argument, index, words))
#define BAD(call, function, argument, words) REFUSED(call, PLM_ERR_ARGUMENT, function, argument, -1, words)
#define DEAD(call, function, argument) REFUSED(call, PLM_ERR_HANDLE, function, argument, -1, "no live handle")

/* what is no branch at all, and what is none of this basis */
#define REFUSES_OTHER_BRANCHES(call_with, function, argument)                                                \
    do {                                                                                                     \
        DEAD(call_with(NULL), function, argument);                                                           \
        DEAD(call_with((plm_branch *)(void *)hbm), function, argument);                                      \
        BAD(call_with(foreign), function, argument, "another basis");                                        \
    } while (0)

static void switch_branch(void **state) {
    const char *f = "plm_hbm_switch_branch";
    plm_branch *none = NULL;
    int64_t n = 0;
    (void)state;
    plm_branch_get_int(curve, "n_points", &n);
#define SWITCH(branch) plm_hbm_switch_branch(hbm, branch, fold, 0, &none)
    REFUSES_OTHER_BRANCHES(SWITCH, f, "branch");
    BAD(plm_hbm_switch_branch(hbm, curve, -1, 0, &none), f, "point", "point is -1");
    BAD(plm_hbm_switch_branch(hbm, curve, n, 0, &none), f, "point", "must lie in 0..");
    BAD(plm_hbm_switch_branch(hbm, curve, fold, 2, &none), f, "mirrored", "0..1");
    BAD(plm_hbm_switch_branch(hbm, curve, fold, -1, &none), f, "mirrored", "0..1");
    BAD(plm_hbm_switch_branch(hbm, curve, fold, 0, NULL), f, "other", "NULL");
    REFUSED(plm_hbm_switch_branch(hbm, curve, fold, 0, &none), PLM_ERR_ARGUMENT, f, "point", fold,
            "neither a branch point nor a period doubling");
    REFUSED(plm_hbm_switch_branch(hbm, curve, 0, 0, &none), PLM_ERR_ARGUMENT, f, "point", 0, "neither");
    assert_null(none);
}

static void track_fold(void **state) {
    const char *f = "plm_hbm_track_fold";
    plm_branch *none = NULL;
    int64_t n = 0;
    (void)state;
    plm_branch_get_int(curve, "n_points", &n);
#define TRACK(branch) plm_hbm_track_fold(hbm, branch, fold, 0.01, 0.03, &none)
    REFUSES_OTHER_BRANCHES(TRACK, f, "branch");
    BAD(plm_hbm_track_fold(hbm, curve, -1, 0.01, 0.03, &none), f, "point", "point is -1");
    BAD(plm_hbm_track_fold(hbm, curve, n, 0.01, 0.03, &none), f, "point", "must lie in 0..");
    REFUSED(plm_hbm_track_fold(hbm, curve, 0, 0.01, 0.03, &none), PLM_ERR_ARGUMENT, f, "point", 0,
            "is no fold");
    BAD(plm_hbm_track_fold(hbm, curve, fold, NAN, 0.03, &none), f, "force_min", "NaN");
    BAD(plm_hbm_track_fold(hbm, curve, fold, 0.01, INFINITY, &none), f, "force_max", "infinite");
    BAD(plm_hbm_track_fold(hbm, curve, fold, -0.01, 0.03, &none), f, "force_min", "negative");
    BAD(plm_hbm_track_fold(hbm, curve, fold, 0.01, -0.03, &none), f, "force_max", "negative");
    BAD(plm_hbm_track_fold(hbm, curve, fold, 0.03, 0.01, &none), f, "force_max", "is empty");
    BAD(plm_hbm_track_fold(hbm, curve, fold, 0.02, 0.02, &none), f, "force_max", "is empty");
    BAD(plm_hbm_track_fold(hbm, curve, fold, 0.025, 0.03, &none), f, "force_min", "0.02 is outside");
    BAD(plm_hbm_track_fold(hbm, curve, fold, 0.01, 0.015, &none), f, "force_max", "0.02 is outside");
    BAD(plm_hbm_track_fold(hbm, curve, fold, 0.01, 0.03, NULL), f, "folds", "NULL");
    assert_null(none);
    assert_true(done(ctx, plm_hbm_track_fold(hbm, curve, fold, 0.0199, 0.0201, &none)));
}

static void searches(void **state) {
    const char *isolated = "plm_hbm_find_isolated", *backbones = "plm_hbm_find_backbones",
               *marching = "plm_hbm_find_by_marching", *get = "plm_hbm_get_found";
    plm_branch *known[2], *none = NULL;
    const char *levels = "plm_hbm_sweep_levels";
    const double level[] = {1, 0.5}, bad_level[] = {1, NAN}, huge_level[] = {1, 1e200};
    double range[2] = {7, 7};
    int64_t count = 7;
    (void)state;
    known[0] = known[1] = curve;
    REFUSED(plm_hbm_get_found(hbm, 0, range, &none), PLM_ERR_STATE, get, "index", -1,
            "search for some first");
    assert_true(done(ctx, plm_hbm_find_backbones(hbm, 0.02, &count)));
    assert_int_equal(count, 1);
    count = 7; /* what was found stays through all that follows */

#define ISOLATED(branch) plm_hbm_find_isolated(hbm, branch, 0, &count)
    REFUSES_OTHER_BRANCHES(ISOLATED, isolated, "main_branch");
    BAD(plm_hbm_find_isolated(hbm, curve, -1, &count), isolated, "force_max", "negative");
    BAD(plm_hbm_find_isolated(hbm, curve, NAN, &count), isolated, "force_max", "NaN");
    BAD(plm_hbm_find_isolated(hbm, curve, 0, NULL), isolated, "count", "NULL");
    BAD(plm_hbm_find_backbones(hbm, -1, &count), backbones, "force_max", "negative");
    BAD(plm_hbm_find_backbones(hbm, INFINITY, &count), backbones, "force_max", "infinite");
    BAD(plm_hbm_find_backbones(hbm, 0, NULL), backbones, "count", "NULL");

    BAD(plm_hbm_sweep_levels(hbm, 0, level, &count), levels, "n", "n is 0");
    BAD(plm_hbm_sweep_levels(hbm, 2, NULL, &count), levels, "force_scale", "NULL");
    REFUSED(plm_hbm_sweep_levels(hbm, 2, bad_level, &count), PLM_ERR_ARGUMENT, levels, "force_scale", 1,
            "NaN");
    REFUSED(plm_hbm_sweep_levels(hbm, 2, huge_level, &count), PLM_ERR_ARGUMENT, levels, "force_scale", 1,
            "overflow");
    BAD(plm_hbm_sweep_levels(hbm, 2, level, NULL), levels, "count", "NULL");

    BAD(plm_hbm_find_by_marching(hbm, -1, known, 1, 0, &count), marching, "n_known", "n_known is -1");
    BAD(plm_hbm_find_by_marching(hbm, 1, NULL, 1, 0, &count), marching, "known", "NULL");
    BAD(plm_hbm_find_by_marching(hbm, 1, known, 0, 0, &count), marching, "n_frequencies",
        "n_frequencies is 0");
    BAD(plm_hbm_find_by_marching(hbm, 1, known, 1, -1, &count), marching, "n_states", "n_states is -1");
    BAD(plm_hbm_find_by_marching(hbm, 1, known, 1, 1, NULL), marching, "count", "NULL");
    known[1] = NULL;
    REFUSED(plm_hbm_find_by_marching(hbm, 2, known, 1, 1, &count), PLM_ERR_HANDLE, marching, "known", 1,
            "no live handle");
    known[1] = foreign;
    REFUSED(plm_hbm_find_by_marching(hbm, 2, known, 1, 1, &count), PLM_ERR_ARGUMENT, marching, "known", 1,
            "another basis");
    assert_true(done(ctx, plm_hbm_set_int(hbm, "period_multiple", 2)));
    BAD(plm_hbm_find_by_marching(hbm, 1, known, 1, 1, &count), marching, "period_multiple",
        "period_multiple = 1");
    assert_true(done(ctx, plm_hbm_set_int(hbm, "period_multiple", 1)));

    BAD(plm_hbm_get_found(hbm, -1, range, &none), get, "index", "index is -1");
    BAD(plm_hbm_get_found(hbm, 1, range, &none), get, "index", "0..0");
    BAD(plm_hbm_get_found(hbm, 0, range, NULL), get, "branch", "NULL");
    assert_true(count == 7 && range[0] == 7 && range[1] == 7 && !none);
    assert_true(done(ctx, plm_hbm_get_found(hbm, 0, range, &none)));
    assert_true(isnan(range[0]) && none);
    assert_int_equal(plm_hbm_find_backbones((plm_hbm *)(void *)basis, 0, &count), PLM_ERR_HANDLE);
    assert_int_equal(plm_hbm_find_isolated(NULL, curve, 0, &count), PLM_ERR_HANDLE);
    assert_int_equal(count, 7);
}

static int32_t stop(plm_context *c, const char *stage, double fraction, void *user) {
    (void)c, (void)stage, (void)user;
    return fraction >= 0;
}
static void a_cancelled_search_leaves_what_was_found(void **state) {
    const double levels[] = {0.01, 0.02};
    plm_branch *backbone = NULL, *again = NULL, *mode = NULL;
    int64_t count = 7, n = 0, m = 0;
    (void)state;
    assert_true(done(ctx, plm_hbm_find_backbones(hbm, 0.02, &n)));
    assert_true(done(ctx, plm_hbm_get_found(hbm, 0, NULL, &backbone)));
    plm_context_set_progress(ctx, stop, NULL);
    assert_int_equal(plm_hbm_find_isolated(hbm, curve, 0, &count), PLM_CANCELLED);
    assert_int_equal(plm_hbm_find_backbones(hbm, 0, &count), PLM_CANCELLED);
    assert_int_equal(plm_hbm_find_by_marching(hbm, 0, NULL, 4, 0, &count), PLM_CANCELLED);
    assert_int_equal(plm_hbm_sweep_levels(hbm, 2, levels, &count), PLM_CANCELLED);
    assert_int_equal(plm_hbm_find_nonlinear_mode(hbm, 1, 0, 0.3, &mode), PLM_CANCELLED);
    plm_context_set_progress(ctx, NULL, NULL);
    assert_int_equal(count, 7);
    assert_int_equal(plm_branch_get_int(mode, "end_reason", &n), PLM_OK); /* what it has until then */
    assert_int_equal(n, PLM_REASON_CANCELLED);
    assert_true(done(ctx, plm_hbm_get_found(hbm, 0, NULL, &again)));
    assert_int_equal(plm_branch_get_int(backbone, "n_points", &n), PLM_OK);
    assert_int_equal(plm_branch_get_int(again, "n_points", &m), PLM_OK);
    assert_true(n == m && n > 3);
}

/* One request to stop ends a call, wherever it comes and whatever curve is being followed for it. At a force
 * with an isolated branch beside the curve. */
static plm_branch *main_curve;

typedef struct {
    int calls, stop_at;
} listener;

static int32_t stop_once(plm_context *c, const char *stage, double fraction, void *user) {
    listener *l = (listener *)user;
    (void)c, (void)stage, (void)fraction;
    return ++l->calls == l->stop_at;
}

static plm_status isolated_branches(void) {
    int64_t count = 0;
    const plm_status status = plm_hbm_find_isolated(hbm, main_curve, 0, &count);
    assert_true(status < 0 || status == PLM_CANCELLED || count > 0);
    return status;
}
static plm_status branches_by_marching(void) {
    int64_t count = 0;
    const plm_status status = plm_hbm_find_by_marching(hbm, 0, NULL, 2, 0, &count);
    assert_true(status < 0 || status == PLM_CANCELLED || count > 0);
    return status;
}
static plm_status refined_basis(void) {
    plm_basis *refined = NULL;
    const plm_status status = plm_hbm_refine_basis(hbm, 0, PLM_PEAK, 0, 1e-3, &refined, NULL);
    plm_basis_destroy(&refined);
    return status;
}

static void one_request_stops(plm_status (*search)(void), int fewest) {
    listener l = {0, 0};
    int total, k;
    plm_context_set_progress(ctx, stop_once, &l);
    assert_true(search() >= 0);
    total = l.calls;
    assert_true(total >= fewest);
    for (k = 1; k <= total; k += 1 + total / 40) {
        l.calls = 0, l.stop_at = k;
        assert_int_equal(search(), PLM_CANCELLED);
        assert_int_equal(l.calls, k);
    }
    plm_context_set_progress(ctx, NULL, NULL);
}

static void one_request_stops_a_search(void **state) {
    (void)state;
    assert_true(done(ctx, plm_hbm_set_double(hbm, "force_scale", 0.006)));
    assert_true(done(ctx, plm_hbm_sweep(hbm, &main_curve)));
    one_request_stops(isolated_branches, 60);
    one_request_stops(branches_by_marching, 60);
    one_request_stops(refined_basis, 60);
}

static void nonlinear_mode(void **state) {
    const char *f = "plm_hbm_find_nonlinear_mode";
    plm_model *chain_of_8 = NULL;
    plm_basis *of_chain = NULL;
    plm_hbm *h = NULL;
    plm_branch *none = NULL;
    (void)state;
    BAD(plm_hbm_find_nonlinear_mode(hbm, 0, 0, 1, &none), f, "mode", "mode is 0");
    BAD(plm_hbm_find_nonlinear_mode(hbm, 3, 0, 1, &none), f, "mode", "1..2");
    BAD(plm_hbm_find_nonlinear_mode(hbm, 1, -1, 1, &none), f, "dof", "dof is -1");
    BAD(plm_hbm_find_nonlinear_mode(hbm, 1, 2, 1, &none), f, "dof", "0..1");
    BAD(plm_hbm_find_nonlinear_mode(hbm, 1, 0, NAN, &none), f, "amplitude_max", "NaN");
    BAD(plm_hbm_find_nonlinear_mode(hbm, 1, 0, -1, &none), f, "amplitude_max", "positive, or 0");
    BAD(plm_hbm_find_nonlinear_mode(hbm, 1, 0, 1, NULL), f, "branch", "NULL");
    /* modes along x do not move a DOF along y */
    assert_true(done(ctx, chain_built(ctx, 1, &chain_of_8)));
    assert_true(done(ctx, plm_basis_create(chain_of_8, &of_chain)));
    assert_true(done(ctx, plm_hbm_create(of_chain, &h)));
    REFUSED(plm_hbm_find_nonlinear_mode(h, 1, 0, 1, &none), PLM_ERR_STATE, f, "basis", -1, "build it first");
    assert_true(done(ctx, plm_basis_set_string(of_chain, "kind", "full")));
    assert_true(done(ctx, plm_basis_set_double(of_chain, "frequency_min_hz", 2)));
    assert_true(done(ctx, plm_basis_set_double(of_chain, "frequency_max_hz", 4)));
    assert_true(done(ctx, plm_basis_build(of_chain)));
    BAD(plm_hbm_find_nonlinear_mode(h, 1, 13, 1e-3, &none), f, "dof", "does not move the DOF");
    assert_null(none);
}

static void of_points(void **state) {
    const char *energies = "plm_branch_get_energy", *multipliers = "plm_branch_get_multipliers",
               *defects = "plm_branch_get_periodicity_defect";
    double x = 7, y = 7, two[2] = {7, 7};
    int64_t n = 7, points = 0;
    (void)state;
    plm_branch_get_int(curve, "n_points", &points);
    BAD(plm_branch_get_energy(curve, -1, &x, &y), energies, "point", "point is -1");
    BAD(plm_branch_get_energy(curve, points, &x, &y), energies, "point", "must lie in 0..");
    BAD(plm_branch_get_periodicity_defect(curve, points, &x), defects, "point", "must lie in 0..");
    BAD(plm_branch_get_periodicity_defect(curve, 0, NULL), defects, "defect", "NULL");
    BAD(plm_branch_get_multipliers(curve, points, 2, two, two, &n), multipliers, "point", "must lie in 0..");
    BAD(plm_branch_get_multipliers(curve, 0, 4, NULL, two, &n), multipliers, "real", "NULL");
    BAD(plm_branch_get_multipliers(curve, 0, 4, two, NULL, &n), multipliers, "imag", "NULL");
    BAD(plm_branch_get_multipliers(curve, 0, 0, NULL, two, &n), multipliers, "real", "NULL");
    BAD(plm_branch_get_multipliers(curve, 0, 2, two, two, &n), multipliers, "capacity", "4 values");
    BAD(plm_branch_get_multipliers(curve, 0, -1, NULL, NULL, &n), multipliers, "capacity", "negative");
    BAD(plm_branch_get_multipliers(curve, 0, 0, NULL, NULL, NULL), multipliers, "count", "NULL");
    assert_true(x == 7 && y == 7 && two[0] == 7 && two[1] == 7 && n == 7);
    assert_int_equal(plm_branch_get_energy((plm_branch *)(void *)hbm, 0, &x, &y), PLM_ERR_HANDLE);
    assert_int_equal(plm_branch_get_multipliers(NULL, 0, 0, NULL, NULL, &n), PLM_ERR_HANDLE);
    assert_int_equal(plm_branch_get_periodicity_defect(NULL, 0, &x), PLM_ERR_HANDLE);
    assert_true(done(ctx, plm_branch_get_energy(curve, 0, NULL, NULL)));
}

static void a_new_basis_makes_old_branches_foreign(void **state) {
    plm_branch *none = NULL;
    int64_t count = 7;
    (void)state;
    assert_true(done(ctx, plm_basis_build(basis)));
    BAD(SWITCH(curve), "plm_hbm_switch_branch", "branch", "built anew");
    BAD(TRACK(curve), "plm_hbm_track_fold", "branch", "built anew");
    BAD(ISOLATED(curve), "plm_hbm_find_isolated", "main_branch", "built anew");
    REFUSED(plm_hbm_find_by_marching(hbm, 1, &curve, 1, 0, &count), PLM_ERR_ARGUMENT,
            "plm_hbm_find_by_marching", "known", 0, "built anew");
    assert_true(count == 7 && !none);
}

int main(void) {
#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(switch_branch),
        TEST(track_fold),
        TEST(searches),
        TEST(a_cancelled_search_leaves_what_was_found),
        TEST(one_request_stops_a_search),
        TEST(nonlinear_mode),
        TEST(of_points),
        TEST(a_new_basis_makes_old_branches_foreign),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
