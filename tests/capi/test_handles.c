/* A handle that is NULL, stale, foreign or of the wrong kind gives PLM_ERR_HANDLE in every function, and
 * nothing is written. Destroying works in any order. */
#include "check.h"
#include "oscillator.h"

/* where outputs would go */
static union {
    int32_t i;
    int64_t l;
    double d;
    char text[64];
    void *p;
} out[4], before[4];
static double numbers[64];

/* One function per entry of plm.h: called with an arbitrary pointer as its handle and valid arguments
 * otherwise. */
#define CASE(kind, name, ...)                                                                                \
    static plm_status call_##name(void *handle) {                                                            \
        plm_##kind *h = (plm_##kind *)handle;                                                                \
        return name(h, __VA_ARGS__);                                                                         \
    }
#define CASE0(kind, name)                                                                                    \
    static plm_status call_##name(void *handle) {                                                            \
        return name((plm_##kind *)handle);                                                                   \
    }
#define KEYED(kind)                                                                                          \
    CASE(kind, plm_##kind##_set_int, "n_harmonics", 3)                                                       \
    CASE(kind, plm_##kind##_set_double, "tolerance", 1e-3)                                                   \
    CASE(kind, plm_##kind##_set_string, "kind", "full")
#define READ(kind)                                                                                           \
    CASE(kind, plm_##kind##_get_int, "n_dof", &out[0].l)                                                     \
    CASE(kind, plm_##kind##_get_double, "shift", &out[0].d)                                                  \
    CASE(kind, plm_##kind##_get_string, "kind", 8, out[0].text, &out[1].l)
#define READ_ARRAYS(kind)                                                                                    \
    CASE(kind, plm_##kind##_get_array, "rest_force", 1, &out[0].d, &out[1].l)                                \
    CASE(kind, plm_##kind##_get_int_array, "rest_closed", 1, &out[0].l, &out[1].l)

CASE(context, plm_context_set_log, NULL, NULL)
CASE(context, plm_context_set_progress, NULL, NULL)
CASE(context, plm_context_set_solver, NULL, NULL, NULL, NULL)
CASE(context, plm_context_set_inertia, NULL)
CASE(context, plm_context_get_error_text, 8, out[0].text, &out[1].l)
CASE(context, plm_context_get_error_function, 8, out[0].text, &out[1].l)
CASE(context, plm_context_get_error_argument, 8, out[0].text, &out[1].l)
CASE(context, plm_context_get_error_info, &out[0].i, &out[1].i, &out[2].l, &out[3].l)
CASE(context, plm_model_create, 3, (plm_model **)&out[0].p)

static const int32_t i32[8] = {0, 1, 2, 3};
static const int64_t i64[8] = {0, 1, 2, 3};
static const int32_t other32[3] = {1, 2, 0};
static const int64_t other64[3] = {1, 2, 0};
static const int32_t far32[3] = {4, 5, 6};
static const int64_t far64[3] = {4, 5, 6};
static const int32_t face_dof32[9] = {3, 4, 5, 6, 7, 8, 9, 10, 11}, face_ptr32[2] = {0, 3};
static const int64_t face_dof64[9] = {3, 4, 5, 6, 7, 8, 9, 10, 11}, face_ptr64[2] = {0, 3};
static const double face[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const double one[3] = {1, 0, 0};
CASE(model, plm_model_set_matrix_i32, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 3, i32, i32, one)
CASE(model, plm_model_set_matrix_i64, PLM_MASS, PLM_CSC, PLM_FULL, 0, PLM_COPY, 3, i64, i64, one)
CASE(model, plm_model_set_rayleigh_damping, 0, 0)
CASE(model, plm_model_set_modal_damping, 1, one + 1)
CASE(model, plm_model_set_structural_damping, 0)
CASE(model, plm_model_fix_dofs_i32, 0, 1, i32)
CASE(model, plm_model_fix_dofs_i64, 0, 1, i64)
CASE(model, plm_model_add_constraints_i32, 0, 1, i32, i32, one)
CASE(model, plm_model_add_constraints_i64, 0, 1, i64, i64, one)
CASE(model, plm_model_add_rigid_link_i32, 0, 3, i32, one, 1, 3, far32, numbers)
CASE(model, plm_model_add_rigid_link_i64, 0, 3, i64, one, 1, 3, far64, numbers)
CASE(model, plm_model_add_distributing_coupling_i32, 0, 3, i32, numbers, 1, far32, numbers, NULL)
CASE(model, plm_model_add_distributing_coupling_i64, 0, 3, i64, numbers, 1, far64, numbers, NULL)
CASE(model, plm_model_add_tie_i32, 0, 1, other32, one, 3, face_dof32, face, 1, face_ptr32, i32, 5, &out[0].d)
CASE(model, plm_model_add_tie_i64, 0, 1, other64, one, 3, face_dof64, face, 1, face_ptr64, i64, 5, &out[0].d)
CASE(model, plm_model_add_surface_i32, 0, 3, face_dof32, face, NULL, 1, face_ptr32, i32, &out[0].l)
CASE(model, plm_model_add_surface_i64, 0, 3, face_dof64, face, NULL, 1, face_ptr64, i64, &out[0].l)
CASE(model, plm_model_add_surface_contact, 0, 1, 0, 1, 1, 0)
CASE(model, plm_model_set_rest_force, 1, one)
CASE(model, plm_model_set_multipliers_i32, 0, 1, i32)
CASE(model, plm_model_set_multipliers_i64, 0, 1, i64)
CASE(model, plm_model_set_elimination_order_i32, 0, 3, other32)
CASE(model, plm_model_set_elimination_order_i64, 0, 3, other64)
CASE(model, plm_model_add_node_pairs_i32, 0, 1, i32, other32, one, one, NULL)
CASE(model, plm_model_add_node_pairs_i64, 0, 1, i64, other64, one, one, NULL)
CASE(model, plm_model_add_ground_contacts_i32, 0, 1, i32, one, one, NULL)
CASE(model, plm_model_add_ground_contacts_i64, 0, 1, i64, one, one, NULL)
CASE(model, plm_model_add_gap_rows_i32, 0, 1, i32, i32, one, one, NULL)
CASE(model, plm_model_add_gap_rows_i64, 0, 1, i64, i64, one, one, NULL)
CASE(model, plm_model_set_preload, 3, one)
CASE(model, plm_model_set_excitation, 1, 3, one, NULL)
CASE(model, plm_model_set_growing_excitation, 1, 2, 3, one, NULL)
CASE(model, plm_model_set_base_motion, 0, 1, 3, one, NULL)
CASE(model, plm_model_set_gap_motion, 1, 0, one, NULL)
CASE(model, plm_model_add_outputs_i32, 0, 1, i32, i32, one, &out[0].l)
CASE(model, plm_model_add_outputs_i64, 0, 1, i64, i64, one, &out[0].l)
KEYED(model)
READ(model)
READ_ARRAYS(model)
CASE(model, plm_model_estimate_memory, &out[0].d)
CASE0(model, plm_model_build)
CASE0(model, plm_model_solve_rest)
CASE(model, plm_model_get_modes, PLM_SYSTEM_OPEN, NULL, 1, numbers, NULL)
CASE(model, plm_model_audit, &out[0].l)
CASE(model, plm_model_get_finding, 0, &out[0].i, &out[1].d, 8, out[2].text, &out[3].l)
CASE(model, plm_sampler_create, (plm_sampler **)&out[0].p)
CASE(model, plm_basis_create, (plm_basis **)&out[0].p)
KEYED(sampler)
READ(sampler)
READ_ARRAYS(sampler)
CASE(sampler, plm_sampler_add_dominant_mode, PLM_SYSTEM_OPEN, 1)
CASE0(sampler, plm_sampler_run)
KEYED(basis)
READ(basis)
READ_ARRAYS(basis)
CASE(basis, plm_basis_set_sampler, NULL)
CASE(basis, plm_basis_set_parent, NULL)
CASE(basis, plm_basis_set_responses, 0, NULL)
CASE0(basis, plm_basis_build)
CASE(basis, plm_basis_get_vectors, 0, 0, 1, numbers, 3)
CASE(basis, plm_basis_get_residual, 0, 0, 3, one, &out[0].d)
CASE(basis, plm_hbm_create, (plm_hbm **)&out[0].p)
KEYED(hbm)
READ(hbm)
CASE(hbm, plm_hbm_sweep, (plm_branch **)&out[0].p)
CASE(hbm, plm_hbm_solve, 1, NULL, 0, (plm_branch **)&out[0].p)
CASE(hbm, plm_hbm_find_peak, NULL, 0, PLM_PEAK, 0, &out[0].d, &out[1].d, NULL)
CASE(hbm, plm_hbm_estimate_error, NULL, 0, 0, PLM_PEAK, 0, &out[0].d, &out[1].d)
READ(branch)
READ_ARRAYS(branch)
CASE(branch, plm_branch_get_amplitude, 0, PLM_PEAK, 0, 1, &out[0].d, &out[1].l)
CASE(branch, plm_branch_get_coefficients, 0, 0, 1, numbers)
CASE(branch, plm_branch_get_history, 0, 0, 1, numbers)
CASE(branch, plm_branch_get_field, 0, 0, 3, numbers)
CASE(branch, plm_branch_get_contact, 0, 1, numbers, NULL, NULL)
CASE(branch, plm_branch_get_closed_share, 0, 1, numbers)
CASE(branch, plm_branch_get_full_residual, 0, &out[0].d)
CASE(model, plm_transient_create, NULL, (plm_transient **)&out[0].p)
KEYED(transient)
READ(transient)
READ_ARRAYS(transient)
CASE(transient, plm_transient_observe_i32, 0, 1, i32)
CASE(transient, plm_transient_observe_i64, 0, 1, i64)
CASE(transient, plm_transient_set_state, 3, one, one)
CASE(transient, plm_transient_start_at, NULL, 0)
CASE0(transient, plm_transient_run)
CASE0(transient, plm_transient_find_periodic)
CASE(transient, plm_transient_get_state, 3, numbers, numbers)
CASE(transient, plm_transient_get_history, 0, 1, &out[0].d, &out[1].l)
CASE(transient, plm_transient_get_multipliers, 1, &out[0].d, &out[1].d, &out[2].l)

enum { CONTEXT, MODEL, SAMPLER, BASIS, HBM, BRANCH, TRANSIENT, KINDS };

#define KEYED_ENTRIES(KIND, kind)                                                                            \
    {KIND, "plm_" #kind "_set_int", call_plm_##kind##_set_int},                                              \
        {KIND, "plm_" #kind "_set_double", call_plm_##kind##_set_double}, {                                  \
        KIND, "plm_" #kind "_set_string", call_plm_##kind##_set_string                                       \
    }
#define READ_ENTRIES(KIND, kind)                                                                             \
    {KIND, "plm_" #kind "_get_int", call_plm_##kind##_get_int},                                              \
        {KIND, "plm_" #kind "_get_double", call_plm_##kind##_get_double}, {                                  \
        KIND, "plm_" #kind "_get_string", call_plm_##kind##_get_string                                       \
    }
#define ARRAY_ENTRIES(KIND, kind)                                                                            \
    {KIND, "plm_" #kind "_get_array", call_plm_##kind##_get_array}, {                                        \
        KIND, "plm_" #kind "_get_int_array", call_plm_##kind##_get_int_array                                 \
    }
#define ENTRY(KIND, name)                                                                                    \
    { KIND, #name, call_##name }

static const struct {
    int kind;
    const char *name;
    plm_status (*call)(void *);
} functions[] = {ENTRY(CONTEXT, plm_context_set_log),
                 ENTRY(CONTEXT, plm_context_set_progress),
                 ENTRY(CONTEXT, plm_context_set_solver),
                 ENTRY(CONTEXT, plm_context_set_inertia),
                 ENTRY(CONTEXT, plm_context_get_error_text),
                 ENTRY(CONTEXT, plm_context_get_error_function),
                 ENTRY(CONTEXT, plm_context_get_error_argument),
                 ENTRY(CONTEXT, plm_context_get_error_info),
                 ENTRY(CONTEXT, plm_model_create),
                 ENTRY(MODEL, plm_model_set_matrix_i32),
                 ENTRY(MODEL, plm_model_set_matrix_i64),
                 ENTRY(MODEL, plm_model_set_rayleigh_damping),
                 ENTRY(MODEL, plm_model_set_modal_damping),
                 ENTRY(MODEL, plm_model_set_structural_damping),
                 ENTRY(MODEL, plm_model_fix_dofs_i32),
                 ENTRY(MODEL, plm_model_fix_dofs_i64),
                 ENTRY(MODEL, plm_model_add_constraints_i32),
                 ENTRY(MODEL, plm_model_add_constraints_i64),
                 ENTRY(MODEL, plm_model_add_rigid_link_i32),
                 ENTRY(MODEL, plm_model_add_rigid_link_i64),
                 ENTRY(MODEL, plm_model_add_distributing_coupling_i32),
                 ENTRY(MODEL, plm_model_add_distributing_coupling_i64),
                 ENTRY(MODEL, plm_model_add_tie_i32),
                 ENTRY(MODEL, plm_model_add_tie_i64),
                 ENTRY(MODEL, plm_model_add_surface_i32),
                 ENTRY(MODEL, plm_model_add_surface_i64),
                 ENTRY(MODEL, plm_model_add_surface_contact),
                 ENTRY(MODEL, plm_model_set_rest_force),
                 ENTRY(MODEL, plm_model_set_multipliers_i32),
                 ENTRY(MODEL, plm_model_set_multipliers_i64),
                 ENTRY(MODEL, plm_model_set_elimination_order_i32),
                 ENTRY(MODEL, plm_model_set_elimination_order_i64),
                 ENTRY(MODEL, plm_model_add_node_pairs_i32),
                 ENTRY(MODEL, plm_model_add_node_pairs_i64),
                 ENTRY(MODEL, plm_model_add_ground_contacts_i32),
                 ENTRY(MODEL, plm_model_add_ground_contacts_i64),
                 ENTRY(MODEL, plm_model_add_gap_rows_i32),
                 ENTRY(MODEL, plm_model_add_gap_rows_i64),
                 ENTRY(MODEL, plm_model_set_preload),
                 ENTRY(MODEL, plm_model_set_excitation),
                 ENTRY(MODEL, plm_model_set_growing_excitation),
                 ENTRY(MODEL, plm_model_set_base_motion),
                 ENTRY(MODEL, plm_model_set_gap_motion),
                 ENTRY(MODEL, plm_model_add_outputs_i32),
                 ENTRY(MODEL, plm_model_add_outputs_i64),
                 KEYED_ENTRIES(MODEL, model),
                 READ_ENTRIES(MODEL, model),
                 ARRAY_ENTRIES(MODEL, model),
                 ENTRY(MODEL, plm_model_estimate_memory),
                 ENTRY(MODEL, plm_model_build),
                 ENTRY(MODEL, plm_model_solve_rest),
                 ENTRY(MODEL, plm_model_get_modes),
                 ENTRY(MODEL, plm_model_audit),
                 ENTRY(MODEL, plm_model_get_finding),
                 ENTRY(MODEL, plm_sampler_create),
                 ENTRY(MODEL, plm_basis_create),
                 KEYED_ENTRIES(SAMPLER, sampler),
                 READ_ENTRIES(SAMPLER, sampler),
                 ARRAY_ENTRIES(SAMPLER, sampler),
                 ENTRY(SAMPLER, plm_sampler_add_dominant_mode),
                 ENTRY(SAMPLER, plm_sampler_run),
                 KEYED_ENTRIES(BASIS, basis),
                 READ_ENTRIES(BASIS, basis),
                 ARRAY_ENTRIES(BASIS, basis),
                 ENTRY(BASIS, plm_basis_set_sampler),
                 ENTRY(BASIS, plm_basis_set_parent),
                 ENTRY(BASIS, plm_basis_set_responses),
                 ENTRY(BASIS, plm_basis_build),
                 ENTRY(BASIS, plm_basis_get_vectors),
                 ENTRY(BASIS, plm_basis_get_residual),
                 ENTRY(BASIS, plm_hbm_create),
                 KEYED_ENTRIES(HBM, hbm),
                 READ_ENTRIES(HBM, hbm),
                 ENTRY(HBM, plm_hbm_sweep),
                 ENTRY(HBM, plm_hbm_solve),
                 ENTRY(HBM, plm_hbm_find_peak),
                 ENTRY(HBM, plm_hbm_estimate_error),
                 READ_ENTRIES(BRANCH, branch),
                 ARRAY_ENTRIES(BRANCH, branch),
                 ENTRY(BRANCH, plm_branch_get_amplitude),
                 ENTRY(BRANCH, plm_branch_get_coefficients),
                 ENTRY(BRANCH, plm_branch_get_history),
                 ENTRY(BRANCH, plm_branch_get_field),
                 ENTRY(BRANCH, plm_branch_get_contact),
                 ENTRY(BRANCH, plm_branch_get_closed_share),
                 ENTRY(BRANCH, plm_branch_get_full_residual),
                 ENTRY(MODEL, plm_transient_create),
                 KEYED_ENTRIES(TRANSIENT, transient),
                 READ_ENTRIES(TRANSIENT, transient),
                 ARRAY_ENTRIES(TRANSIENT, transient),
                 ENTRY(TRANSIENT, plm_transient_observe_i32),
                 ENTRY(TRANSIENT, plm_transient_observe_i64),
                 ENTRY(TRANSIENT, plm_transient_set_state),
                 ENTRY(TRANSIENT, plm_transient_start_at),
                 ENTRY(TRANSIENT, plm_transient_run),
                 ENTRY(TRANSIENT, plm_transient_find_periodic),
                 ENTRY(TRANSIENT, plm_transient_get_state),
                 ENTRY(TRANSIENT, plm_transient_get_history),
                 ENTRY(TRANSIENT, plm_transient_get_multipliers)};
enum { N_FUNCTIONS = sizeof functions / sizeof functions[0] };

typedef struct {
    plm_context *context;
    plm_model *model;
    plm_sampler *sampler;
    plm_basis *basis;
    plm_hbm *hbm;
} handles;

static int make(handles *h) {
    memset(h, 0, sizeof *h);
    return plm_context_create(PLM_API_VERSION, &h->context) == 0 &&
           plm_model_create(h->context, 3, &h->model) == 0 &&
           plm_sampler_create(h->model, &h->sampler) == 0 && plm_basis_create(h->model, &h->basis) == 0 &&
           plm_hbm_create(h->basis, &h->hbm) == 0;
}

/* every function refuses `handle`, except those of `own` kind; nothing is written */
static int all_refuse(void *handle, int own, const char *what) {
    int k, ok = 1;
    for (k = 0; k < N_FUNCTIONS; ++k) {
        plm_status s;
        if (functions[k].kind == own) continue;
        memset(out, 0x5a, sizeof out);
        memset(before, 0x5a, sizeof before);
        s = functions[k].call(handle);
        if (s != PLM_ERR_HANDLE || memcmp(out, before, sizeof out) != 0) {
            printf("    %s with a %s handle: status %d\n", functions[k].name, what, (int)s);
            ok = 0;
        }
    }
    return ok;
}

static void null_and_foreign_handles_are_refused(void **state) {
    double somewhere[4] = {0, 0, 0, 0};
    (void)state;
    assert_true(all_refuse(NULL, -1, "NULL"));
    assert_true(all_refuse(somewhere, -1, "foreign"));
    assert_true(all_refuse((char *)somewhere + 1, -1, "odd foreign"));
    assert_true(all_refuse((void *)1, -1, "made-up"));
    assert_true(all_refuse((void *)~(uintptr_t)0, -1, "made-up"));
}

static void wrong_kinds_are_refused(void **state) {
    handles h;
    (void)state;
    assert_true(make(&h));
    assert_true(all_refuse(h.context, CONTEXT, "context"));
    assert_true(all_refuse(h.model, MODEL, "model"));
    assert_true(all_refuse(h.sampler, SAMPLER, "sampler"));
    assert_true(all_refuse(h.basis, BASIS, "basis"));
    assert_true(all_refuse(h.hbm, HBM, "hbm"));
    assert_int_equal(plm_context_destroy(&h.context), PLM_OK);
}

static void stale_handles_are_refused(void **state) {
    handles h, copy;
    (void)state;
    assert_true(make(&h));
    copy = h;
    assert_int_equal(plm_context_destroy(&h.context), PLM_OK);
    assert_null(h.context);
    assert_true(all_refuse(copy.context, -1, "stale context"));
    assert_true(all_refuse(copy.model, -1, "stale model"));
    assert_true(all_refuse(copy.sampler, -1, "stale sampler"));
    assert_true(all_refuse(copy.basis, -1, "stale basis"));
    assert_true(all_refuse(copy.hbm, -1, "stale hbm"));
    assert_true(make(&h)); /* the slots are used again, by handles of other values */
    assert_true(h.context != copy.context && h.model != copy.model && h.hbm != copy.hbm);
    assert_true(all_refuse(copy.model, -1, "stale model"));
    assert_int_equal(plm_context_destroy(&h.context), PLM_OK);
}

static void destroying_twice_or_nothing(void **state) {
    handles h, copy;
    plm_branch *no_branch = NULL;
    (void)state;
    assert_true(make(&h));
    copy = h;
    assert_int_equal(plm_model_destroy(NULL), PLM_OK);
    assert_int_equal(plm_sampler_destroy(NULL), PLM_OK);
    assert_int_equal(plm_basis_destroy(NULL), PLM_OK);
    assert_int_equal(plm_hbm_destroy(NULL), PLM_OK);
    assert_int_equal(plm_branch_destroy(NULL), PLM_OK);
    assert_int_equal(plm_branch_destroy(&no_branch), PLM_OK);
    assert_int_equal(plm_context_destroy(NULL), PLM_OK);
    no_branch = (plm_branch *)(void *)h.model;
    assert_int_equal(plm_branch_destroy(&no_branch), PLM_ERR_HANDLE);
    assert_non_null(no_branch);
    /* parents first: children keep what they need */
    assert_int_equal(plm_model_destroy(&h.model), PLM_OK);
    assert_null(h.model);
    assert_int_equal(plm_model_destroy(&h.model), PLM_OK);
    assert_int_equal(plm_model_destroy(&copy.model), PLM_OK); /* gone already */
    assert_null(copy.model);
    assert_int_equal(plm_basis_destroy(&h.basis), PLM_OK);
    assert_int_equal(plm_basis_destroy(&copy.basis), PLM_OK); /* gone already */
    assert_null(copy.basis);
    assert_int_equal(plm_hbm_set_int(h.hbm, "n_harmonics", 3), PLM_OK);
    assert_int_equal(plm_sampler_set_int(h.sampler, "n_samples", 3), PLM_OK);
    assert_int_equal(plm_hbm_destroy(&h.hbm), PLM_OK);
    assert_int_equal(plm_hbm_destroy(&copy.hbm), PLM_OK); /* gone already */
    assert_null(copy.hbm);
    assert_int_equal(plm_sampler_destroy(&h.sampler), PLM_OK);
    assert_int_equal(plm_sampler_destroy(&copy.sampler), PLM_OK); /* gone already */
    assert_null(copy.sampler);
    assert_int_equal(plm_context_destroy(&h.context), PLM_OK);
    assert_int_equal(plm_context_destroy(&copy.context), PLM_OK); /* gone already */
    assert_null(copy.context);
}

/* In any order: the context first, and what was made in it afterwards, even when new objects have taken their
 * places. */
static void the_context_goes_first(void **state) {
    handles h, next;
    plm_branch *not_mine;
    (void)state;
    assert_true(make(&h));
    assert_int_equal(plm_context_destroy(&h.context), PLM_OK);
    assert_true(make(&next));
    assert_int_equal(plm_model_set_int(h.model, "max_blocks", 3), PLM_ERR_HANDLE);
    not_mine = (plm_branch *)(void *)h.model;
    assert_int_equal(plm_branch_destroy(&not_mine), PLM_ERR_HANDLE);
    assert_int_equal(plm_hbm_destroy(&h.hbm), PLM_OK);
    assert_int_equal(plm_basis_destroy(&h.basis), PLM_OK);
    assert_int_equal(plm_sampler_destroy(&h.sampler), PLM_OK);
    assert_int_equal(plm_model_destroy(&h.model), PLM_OK);
    assert_true(h.hbm == NULL && h.basis == NULL && h.sampler == NULL && h.model == NULL);
    assert_int_equal(plm_model_set_int(next.model, "max_blocks", 3), PLM_OK); /* the others live */
    plm_context_destroy(&next.context);
}

static void contexts_do_not_mix(void **state) {
    handles one, two;
    (void)state;
    assert_true(make(&one));
    assert_true(make(&two));
    assert_true(refused(one.context, plm_basis_set_sampler(one.basis, two.sampler), PLM_ERR_HANDLE,
                        "plm_basis_set_sampler", "sampler", -1, "another context"));
    assert_true(refused(one.context, plm_basis_set_parent(one.basis, two.basis), PLM_ERR_HANDLE,
                        "plm_basis_set_parent", "parent", -1, "another context"));
    assert_true(refused(one.context, plm_basis_set_sampler(one.basis, NULL), PLM_ERR_HANDLE,
                        "plm_basis_set_sampler", "sampler", -1, "no live handle"));
    plm_context_destroy(&one.context);
    plm_context_destroy(&two.context);
}

/* A handle of a live object with another number of its place, near and far, is none; the bits are those of
 * registry.cpp, the place in the lower ones. */
static void handles_of_places_that_do_not_exist_are_refused(void **state) {
    handles h;
    int bit, beyond;
    (void)state;
    assert_true(make(&h));
    for (bit = 1; bit < (int)(8 * sizeof(uintptr_t)); ++bit)
        for (beyond = 0; beyond < 64; ++beyond) {
            const uintptr_t bits =
                ((uintptr_t)(void *)h.model ^ ((uintptr_t)1 << bit)) + 2 * (uintptr_t)beyond;
            plm_model *forged = (plm_model *)(void *)bits;
            if (forged == h.model) continue;
            assert_int_equal(plm_model_set_int(forged, "max_blocks", 3), PLM_ERR_HANDLE);
        }
    assert_int_equal(plm_model_set_int(h.model, "max_blocks", 3), PLM_OK);
    plm_context_destroy(&h.context);
}

/* ---- what is left in a context goes youngest first: the host's factors tell ---- */
static struct {
    int number; /* of the model that is built */
    int n_gone, gone[64];
} order;
typedef struct {
    double value;
    int number;
} factor_1x1;

static int32_t order_factor(plm_context *ctx, int64_t n, const int64_t *col_ptr, const int64_t *row,
                            const double *value, int32_t positive_definite, void **factor, void *user) {
    factor_1x1 *f = malloc(sizeof *f);
    (void)ctx, (void)col_ptr, (void)row, (void)positive_definite, (void)user;
    if (n != 1 || !f) return 1;
    f->value = value[0], f->number = order.number;
    *factor = f;
    return 0;
}
static int32_t order_solve(plm_context *ctx, void *factor, int64_t nrhs, double *x, int64_t ldx, void *user) {
    int64_t k;
    (void)ctx, (void)user;
    for (k = 0; k < nrhs; ++k) x[k * ldx] /= ((const factor_1x1 *)factor)->value;
    return 0;
}
static void order_release(plm_context *ctx, void *factor, void *user) {
    (void)ctx, (void)user;
    if (order.n_gone < 64) order.gone[order.n_gone++] = ((const factor_1x1 *)factor)->number;
    free(factor);
}

static void the_youngest_goes_first(void **state) {
    static const oscillator sane = {1, 0.1, 3, 0.1, 1};
    plm_context *ctx = NULL;
    plm_model *model[4] = {NULL, NULL, NULL, NULL};
    int k, seen = 4;
    (void)state;
    assert_int_equal(plm_context_create(PLM_API_VERSION, &ctx), PLM_OK);
    assert_int_equal(plm_context_set_solver(ctx, order_factor, order_solve, order_release, &order), PLM_OK);
    for (k = 0; k < 4; ++k) {
        order.number = k;
        assert_true(done(ctx, oscillator_built(ctx, &sane, 1, &model[k], NULL)));
        /* the last one takes the place of one that was made before the others */
        if (k == 2) assert_int_equal(plm_model_destroy(&model[0]), PLM_OK);
    }
    order.n_gone = 0;
    assert_int_equal(plm_context_destroy(&ctx), PLM_OK);
    assert_true(order.n_gone >= 3);
    for (k = 0; k < order.n_gone; ++k) { /* some have several factors */
        assert_true(order.gone[k] <= seen && order.gone[k] > 0);
        seen = order.gone[k];
    }
    assert_int_equal(order.gone[0], 3);
    assert_int_equal(seen, 1);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(null_and_foreign_handles_are_refused),
        cmocka_unit_test(wrong_kinds_are_refused),
        cmocka_unit_test(stale_handles_are_refused),
        cmocka_unit_test(destroying_twice_or_nothing),
        cmocka_unit_test(the_context_goes_first),
        cmocka_unit_test(contexts_do_not_mix),
        cmocka_unit_test(handles_of_places_that_do_not_exist_are_refused),
        cmocka_unit_test(the_youngest_goes_first),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
