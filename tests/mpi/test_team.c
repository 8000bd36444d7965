/* A scene whose entries, supports, contact rows and loads are dealt out over the ranks, against the same
 * scene as a model of one process: modes, equilibrium and peak. Then misuse. */
#include <math.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plm/plm_mpi.h"
#include "scene_model.h"

enum { MODES = 8 };

typedef struct results {
    double hz[MODES], peak[2];
    double *field; /* at the peak, n_dof */
} results;

static int rank, size, failures;

static void expect(int holds, const char *what) {
    if (holds) return;
    failures++;
    printf("rank %d of %d: %s\n", rank, size, what);
}

static void close_to(double got, double wanted, double tolerance, const char *what) {
    char text[200];
    snprintf(text, sizeof text, "%s is %.15g instead of %.15g", what, got, wanted);
    expect(fabs(got - wanted) <= tolerance * fabs(wanted), text);
}

static int64_t draw(int64_t k, int64_t below) {
    return (int64_t)(((uint64_t)k * 0x9e3779b97f4a7c15u >> 33) % (uint64_t)below);
}

/* What this rank has of the scene: entries and rows by chance, so that most are of DOFs it does not own. */
static plm_status hand_over(plm_team *team, const scene *s) {
    plm_status status = PLM_OK;
    for (int64_t node = 0; node < s->n_nodes && !status; node++) {
        const int64_t dof[3] = {3 * node, 3 * node + 1, 3 * node + 2};
        if (draw(node, size) == rank) status = plm_team_own_dofs_i64(team, 0, 3, dof);
    }
    for (int64_t c = 0; c < s->n_dof && !status; c++) {
        if (draw(c + 5, size) != rank) continue;
        const int64_t first = s->col_ptr[c], n = s->col_ptr[c + 1] - first;
        int64_t *column = malloc((size_t)n * sizeof *column);
        for (int64_t k = 0; k < n; k++) column[k] = c;
        status =
            plm_team_add_entries_i64(team, PLM_MASS, PLM_FULL, 0, n, s->row + first, column, s->m + first);
        if (!status)
            status = plm_team_add_entries_i64(team, PLM_STIFFNESS, PLM_FULL, 0, n, s->row + first, column,
                                              s->k + first);
        free(column);
    }
    for (int64_t k = 0; k < s->n_fixed && !status; k++)
        if (draw(k, size) == rank) status = plm_team_fix_dofs_i64(team, 0, 1, s->fixed + k);
    for (int64_t p = 0; p < s->n_pairs && !status;
         p++) { /* in order, so that they have the numbers of the scene */
        if (p * size / s->n_pairs != rank) continue;
        int64_t dof[6], ptr[2] = {0, 3};
        double coefficient[6];
        for (int i = 0; i < 3; i++) {
            dof[i] = s->dof_a[3 * p + i], coefficient[i] = s->normal[3 * p + i];
            if (s->dof_b[0] == SCENE_NO_DOF) continue;
            dof[3 + i] = s->dof_b[3 * p + i], coefficient[3 + i] = -s->normal[3 * p + i], ptr[1] = 6;
        }
        status = plm_team_add_gap_rows_i64(team, 0, 1, ptr, dof, coefficient, s->contact_stiffness + p,
                                           s->gap + p);
    }
    for (int64_t k = 0; k < s->n_dof && !status; k++) {
        if (draw(k + 9, size) != rank) continue;
        if (s->preload && s->preload[k] != 0)
            status = plm_team_add_preload_i64(team, 0, 1, &k, s->preload + k);
        if (!status && s->force[k] != 0)
            status = plm_team_add_excitation_i64(team, 1, 0, 1, &k, s->force + k, NULL);
    }
    return status;
}

static plm_status compute(plm_model *model, const scene *s, results *r) {
    plm_branch *curve = NULL;
    plm_hbm *hbm = NULL;
    plm_status status = plm_model_build(model);
    if (status < 0) return status;
    status = plm_model_get_modes(model, 0, NULL, MODES, r->hz, NULL);
    if (status < 0) return status;
    status = plm_model_compute_response(model, s->output_dof, PLM_HALF_PEAK_TO_PEAK, 1e-3, &r->peak[0],
                                        &r->peak[1], NULL, &curve, &hbm);
    if (status < 0) return status;
    r->field = calloc((size_t)s->n_dof, sizeof *r->field);
    return plm_branch_get_field(curve, 0, 0.25, s->n_dof, r->field);
}

/* The part of the field that this rank owns. */
typedef struct share {
    const scene *s;
    int64_t n;
    double sum;
} share;
static int32_t receive(plm_team *team, int64_t n, const int64_t *dof, const double *value, void *user) {
    share *mine = user;
    (void)team;
    mine->n = n, mine->sum = 0;
    for (int64_t k = 0; k < n; k++) {
        if (draw(dof[k] / 3, size) != rank) return 7;
        mine->sum += value[k] * (double)(dof[k] + 1);
    }
    return 0;
}

static void say(plm_context *ctx, plm_team *team) {
    char text[600] = "";
    if (ctx) plm_context_get_error_text(ctx, sizeof text, text, NULL);
    printf("context: %s\n", text);
    plm_team_get_error_text(team, sizeof text, text, NULL);
    printf("team: %s\n", text);
}

static void scene_over_ranks(const char *name) {
    scene *s = NULL;
    plm_team *team = NULL;
    share mine = {NULL, 0, 0};
    expect(scene_create(name, "quick", 1, &s) == SCENE_OK, "the scene");
    mine.s = s;
    expect(!plm_team_create(MPI_Comm_c2f(MPI_COMM_WORLD), s->n_dof, &team), "plm_team_create");
    expect(!plm_team_set_field(team, receive, &mine), "plm_team_set_field");
    expect(!hand_over(team, s), "parts");
    if (rank == 0) {
        plm_context *ctx = NULL;
        plm_model *model = NULL;
        results one = {{0}, {0}, NULL}, many = {{0}, {0}, NULL};
        plm_context_create(PLM_API_VERSION, &ctx);
        scene_to_unbuilt_model(ctx, s, &model);
        expect(compute(model, s, &one) >= 0, "the model of one process");
        plm_status status = plm_team_create_model(team, ctx, &model);
        if (!status) status = plm_model_set_rayleigh_damping(model, s->mass_damping, s->stiffness_damping);
        if (!status) status = compute(model, s, &many);
        if (status < 0) say(ctx, team);
        expect(status >= 0, "the model of the team");
        for (int k = 0; k < MODES; k++) close_to(many.hz[k], one.hz[k], 1e-9, "a natural frequency");
        close_to(many.peak[0], one.peak[0], 1e-8, "the frequency of the peak");
        close_to(many.peak[1], one.peak[1], 1e-8, "the peak");
        double size_of_field = 0, error = 0;
        for (int64_t k = 0; many.field && k < s->n_dof; k++) {
            size_of_field = fmax(size_of_field, fabs(one.field[k]));
            error = fmax(error, fabs(many.field[k] - one.field[k]));
        }
        close_to(size_of_field + error, size_of_field, 1e-7, "a field");
        if (many.field) expect(!plm_team_deliver(team, s->n_dof, many.field), "plm_team_deliver");
        expect(!plm_team_dismiss(team, status < 0 ? status : PLM_OK), "plm_team_dismiss");
        free(one.field), free(many.field);
        plm_context_destroy(&ctx); /* after the team has been dismissed: the model is let go in silence */
    } else {
        expect(plm_team_serve(team) == PLM_OK, "plm_team_serve");
    }
    double all[2] = {0, 0}, here[2] = {(double)mine.n, mine.sum};
    MPI_Reduce(here, all, 2, MPI_DOUBLE, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0)
        expect((int64_t)all[0] == s->n_dof && all[1] != 0, "every DOF of a field is delivered once");
    expect(!plm_team_destroy(&team) && !team, "plm_team_destroy");
    scene_destroy(&s);
}

static int text_has(plm_team *team, const char *words) {
    char text[600] = "";
    plm_team_get_error_text(team, sizeof text, text, NULL);
    if (strstr(text, words)) return 1;
    printf("rank %d: \"%s\" does not say \"%s\"\n", rank, text, words);
    return 0;
}

static plm_team *two_dofs(void) {
    plm_team *team = NULL;
    expect(!plm_team_create(MPI_Comm_c2f(MPI_COMM_WORLD), 2, &team), "plm_team_create");
    return team;
}

/* Rank 0 makes the model, or tries; the others serve. All have `wanted` in the end. */
static void all_have(plm_team *team, plm_status wanted, const char *words) {
    plm_status status;
    if (rank == 0) {
        plm_context *ctx = NULL;
        plm_model *model = NULL;
        plm_context_create(PLM_API_VERSION, &ctx);
        status = plm_team_create_model(team, ctx, &model);
        plm_team_dismiss(team, status);
        plm_context_destroy(&ctx);
    } else {
        status = plm_team_serve(team);
    }
    expect(status == wanted, "one status on all ranks");
    expect(text_has(team, words), "the text");
    expect(!plm_team_destroy(&team), "plm_team_destroy");
}

static void misuse(void) {
    const int64_t both[2] = {0, 1}, one = 0, outside = 2, two[2] = {1, 1};
    const double nan_value = NAN, values[2] = {1, 2};
    plm_team *team = NULL, *stale;
    expect(plm_team_create(MPI_Comm_c2f(MPI_COMM_WORLD), rank == size - 1 ? 0 : 2, &team) ==
                   PLM_ERR_ARGUMENT &&
               !team,
           "n_dof");
    expect(text_has(NULL, "n_dof"), "the text");
    if (size > 1) {
        expect(plm_team_create(MPI_Comm_c2f(MPI_COMM_WORLD), 2 + rank, &team) == PLM_ERR_ARGUMENT,
               "n_dof differs");
        expect(text_has(NULL, "not the same"), "the text");
    }
    team = two_dofs();
    expect(plm_team_own_dofs_i64(team, 2, 1, &one) == PLM_ERR_ARGUMENT && text_has(team, "index_base"),
           "index_base");
    all_have(team, PLM_ERR_ARGUMENT, "index_base");
    team = two_dofs();
    if (rank == size - 1)
        expect(plm_team_own_dofs_i64(team, 0, 1, &outside) == PLM_ERR_ARGUMENT, "a DOF outside");
    all_have(team, PLM_ERR_ARGUMENT, "dof[0] is 2");
    team = two_dofs();
    if (rank == size - 1)
        expect(plm_team_add_entries_i64(team, PLM_MASS, PLM_FULL, 0, 1, &one, &one, &nan_value) ==
                   PLM_ERR_MATRIX,
               "NaN");
    all_have(team, PLM_ERR_MATRIX, "not finite");
    team = two_dofs();
    if (rank == 0) plm_team_own_dofs_i64(team, 0, 1, &one);
    all_have(team, PLM_ERR_ARGUMENT, "no rank owns DOF 1");
    team = two_dofs();
    if (rank == 0) plm_team_own_dofs_i64(team, 0, 2, both);
    if (rank == size - 1) plm_team_own_dofs_i64(team, 1, 1, two);
    all_have(team, PLM_ERR_ARGUMENT, "is owned by rank");
    team = two_dofs();
    if (rank == 0) plm_team_own_dofs_i64(team, 0, 2, both);
    plm_team_add_entries_i64(team, PLM_STIFFNESS, PLM_FULL, 0, 1, both, both + 1, values);
    all_have(team, PLM_ERR_MATRIX, "not symmetric");

    team = two_dofs(); /* destroyed with nobody dismissed, and used afterwards */
    stale = team;
    expect(!plm_team_destroy(&team) && !plm_team_destroy(&team), "plm_team_destroy");
    expect(plm_team_own_dofs_i64(stale, 0, 2, both) == PLM_ERR_HANDLE, "a stale handle");
    expect(plm_team_create_model(stale, NULL, NULL) == PLM_ERR_HANDLE, "a stale handle");
    team = two_dofs();
    if (rank == 0)
        expect(plm_team_serve(team) == PLM_ERR_STATE && text_has(team, "rank 0"), "rank 0 does not serve");
    else
        expect(plm_team_dismiss(team, 0) == PLM_ERR_STATE && text_has(team, "rank 0 alone"),
               "rank 0 alone dismisses");
    expect(!plm_team_destroy(&team), "plm_team_destroy");
}

int main(int argc, char **argv) {
    int all = 0;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    if (argc > 1)
        scene_over_ranks(argv[1]);
    else
        misuse();
    MPI_Allreduce(&failures, &all, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    if (rank == 0) printf("%d failures\n", all);
    MPI_Finalize();
    return all > 0;
}
