/* The bounds of the key table are those of the library: an option at its least and at its largest value is
 * accepted by the run it is for. A run may then fail for what the value does to it (a tolerance of 1e-15 need
 * not be reached), but not with the answer that the value itself is out of range. */
#include "check.h"

/* Refused for what else there is: the value has to fit the model, or another option. */
static const struct {
    int32_t kind;
    const char *key;
    int at_most;
} relative[] = {
    {PLM_KIND_SAMPLER, "mode", 1},            /* modes the model has */
    {PLM_KIND_BASIS, "n_discontinuities", 1}, /* its pairs */
    {PLM_KIND_BASIS, "n_pairs_carried", 1},   /* the same */
    {PLM_KIND_HBM, "min_step", 1},            /* below max_step */
};

typedef struct scene {
    plm_context *ctx;
    plm_model *model;
    plm_sampler *sampler;
    plm_basis *basis;
    plm_hbm *hbm;
    plm_transient *motion;
} scene;

static plm_status set(const scene *s, int32_t kind, const char *key, int32_t type, double v) {
    const int64_t n = (int64_t)v;
    if (type == PLM_TYPE_INT)
        return kind == PLM_KIND_MODEL     ? plm_model_set_int(s->model, key, n)
               : kind == PLM_KIND_SAMPLER ? plm_sampler_set_int(s->sampler, key, n)
               : kind == PLM_KIND_BASIS   ? plm_basis_set_int(s->basis, key, n)
               : kind == PLM_KIND_HBM     ? plm_hbm_set_int(s->hbm, key, n)
                                          : plm_transient_set_int(s->motion, key, n);
    return kind == PLM_KIND_MODEL     ? plm_model_set_double(s->model, key, v)
           : kind == PLM_KIND_SAMPLER ? plm_sampler_set_double(s->sampler, key, v)
           : kind == PLM_KIND_BASIS   ? plm_basis_set_double(s->basis, key, v)
           : kind == PLM_KIND_HBM     ? plm_hbm_set_double(s->hbm, key, v)
                                      : plm_transient_set_double(s->motion, key, v);
}

/* Unit mass on a unit spring, a stop of stiffness 3 at zero gap, 2 % damping. */
static plm_status model_of(scene *s) {
    const int32_t row_ptr[2] = {0, 1}, dof[1] = {0};
    const int32_t start[2] = {0, 1}, row[1] = {0};
    const double one[1] = {1}, stiffness[1] = {3}, gap[1] = {0}, ratio[1] = {0.02};
    plm_status e = plm_model_create(s->ctx, 1, &s->model);
    if (!e)
        e = plm_model_set_matrix_i32(s->model, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1, start, row, one);
    if (!e)
        e = plm_model_set_matrix_i32(s->model, PLM_STIFFNESS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 1, start, row,
                                     one);
    if (!e) e = plm_model_set_modal_damping(s->model, 1, ratio);
    if (!e) e = plm_model_add_gap_rows_i32(s->model, 0, 1, row_ptr, dof, one, stiffness, gap);
    if (!e) e = plm_model_set_excitation(s->model, 1, 1, one, NULL);
    return e;
}

static plm_status create(scene *s) {
    plm_status e = plm_context_create(PLM_API_VERSION, &s->ctx);
    if (!e) e = model_of(s);
    if (!e) e = plm_sampler_create(s->model, &s->sampler);
    if (!e) e = plm_basis_create(s->model, &s->basis);
    if (!e) e = plm_hbm_create(s->basis, &s->hbm);
    if (!e) e = plm_hbm_set_int(s->hbm, "n_harmonics", 3);
    if (!e) e = plm_hbm_set_int(s->hbm, "max_points", 3); /* enough to have used every option */
    return e;
}

/* Options of one kind of basis are described as "kind: ...". */
static void choose_kind(const scene *s, const char *description) {
    char kind[32];
    const char *colon = strchr(description, ':');
    if (!colon || colon - description > 30) return;
    memcpy(kind, description, (size_t)(colon - description));
    kind[colon - description] = 0;
    plm_basis_set_string(s->basis, "kind", kind);
}

static plm_status move(scene *s, int32_t kind, const char *key, int32_t type, double value) {
    plm_status e = plm_transient_create(s->model, s->basis, &s->motion);
    if (e) return e;
    plm_transient_set_double(s->motion, "frequency_hz", 0.2);
    plm_transient_set_int(s->motion, "periods", 1);
    plm_transient_set_double(s->motion, "settled", 1); /* so that a long run ends, too */
    if (kind == PLM_KIND_TRANSIENT) e = set(s, kind, key, type, value);
    if (e >= 0) e = plm_transient_run(s->motion);
    return e < 0 ? e : plm_transient_find_periodic(s->motion);
}

/* The first failure on the way through a whole run with one option set. */
static plm_status run(scene *s, int32_t kind, const char *key, int32_t type, double value,
                      const char *description) {
    plm_branch *curve = NULL;
    plm_status e = create(s);
    if (!e && kind == PLM_KIND_BASIS) choose_kind(s, description);
    if (!e && kind < PLM_KIND_BRANCH) e = set(s, kind, key, type, value);
    if (e >= 0) e = plm_model_build(s->model);
    if (e >= 0) e = plm_sampler_run(s->sampler);
    if (e >= 0) e = plm_basis_set_sampler(s->basis, s->sampler);
    if (e >= 0) e = plm_basis_build(s->basis);
    if (e >= 0 && kind == PLM_KIND_TRANSIENT) return move(s, kind, key, type, value);
    if (e >= 0 && !strcmp(key, "n_harmonics") && value > 100) /* one point is costly enough */
        return plm_hbm_solve(s->hbm, 0.2, NULL, 0, &curve);
    return e < 0 ? e : plm_hbm_sweep(s->hbm, &curve);
}

static int is_relative(int32_t kind, const char *key, int at_most) {
    size_t i;
    for (i = 0; i < sizeof relative / sizeof *relative; ++i)
        if (relative[i].kind == kind && !strcmp(relative[i].key, key) && relative[i].at_most == at_most)
            return 1;
    return 0;
}

/* 1 when the value was refused for itself. */
static int refused_at(int32_t kind, const char *key, int32_t type, double value, const char *description) {
    scene s;
    plm_status e;
    char argument[80] = "", text[400] = "";
    int64_t needed;
    int bad;
    memset(&s, 0, sizeof s);
    e = run(&s, kind, key, type, value, description);
    plm_context_get_error_argument(s.ctx, sizeof argument, argument, &needed);
    plm_context_get_error_text(s.ctx, sizeof text, text, &needed);
    bad = e == PLM_ERR_ARGUMENT && !strcmp(argument, key);
    if (bad) print_message("%s = %g: %s\n", key, value, text);
    plm_context_destroy(&s.ctx);
    return bad;
}

static void bounds_of_the_table_are_those_of_the_runs(void **state) {
    const int32_t kinds[] = {PLM_KIND_MODEL, PLM_KIND_SAMPLER, PLM_KIND_BASIS, PLM_KIND_HBM,
                             PLM_KIND_TRANSIENT};
    size_t k;
    int n_run = 0, n_refused = 0;
    (void)state;
    for (k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        int32_t count, i, type, is_option, at_most;
        assert_int_equal(plm_key_count(kinds[k], &count), PLM_OK);
        for (i = 0; i < count; ++i) {
            char key[80], description[400];
            int64_t needed;
            double bound[2];
            assert_int_equal(plm_key_info(kinds[k], i, &type, &is_option, &bound[0], &bound[1]), PLM_OK);
            if (!is_option || (type != PLM_TYPE_INT && type != PLM_TYPE_DOUBLE)) continue;
            plm_key_text(kinds[k], i, PLM_KEY_NAME, sizeof key, key, &needed);
            plm_key_text(kinds[k], i, PLM_KEY_DESCRIPTION, sizeof description, description, &needed);
            for (at_most = 0; at_most < 2; ++at_most) {
                if (bound[at_most] >= 1e60 || bound[at_most] <= -1e60) continue; /* that is: no bound */
                if (is_relative(kinds[k], key, at_most)) continue;
                n_refused += refused_at(kinds[k], key, type, bound[at_most], description);
                ++n_run;
            }
        }
    }
    print_message("    %d bounds run\n", n_run);
    assert_true(n_run > 70);
    assert_int_equal(n_refused, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(bounds_of_the_table_are_those_of_the_runs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
