/* The order in which a host counts its DOFs, and the axes in which it measures, are its own affair: whole
 * structures under permuted DOFs and turned axes give the same resonance to 1e-9, in the same words. Equal
 * frequencies are among them, whose modes have no direction but what the eigensolver happens to give. */
#include "chain.h"
#include "check.h"
#include "scene.h"

static plm_context *ctx;

static int open_context(void **state) {
    (void)state;
    return plm_context_create(PLM_API_VERSION, &ctx) != PLM_OK;
}
static int close_context(void **state) {
    (void)state;
    return plm_context_destroy(&ctx);
}

/* Dense, row by row: small enough to be turned by hand. */
typedef struct structure {
    int64_t n, z;
    double *m, *k;  /* n x n */
    double *b;      /* z x n */
    double *kn, *g; /* z */
    double *preload, *force;
    int64_t out;                   /* the DOF watched */
    int64_t n_planes, (*plane)[2]; /* pairs of DOFs that may be turned into one another */
    double alpha, beta, ratio;     /* damping */
} structure;

static double *zeros(int64_t n) {
    double *a = calloc((size_t)n, sizeof *a);
    assert_non_null(a);
    return a;
}

static structure empty(int64_t n, int64_t z) {
    structure s;
    memset(&s, 0, sizeof s);
    s.n = n, s.z = z;
    s.m = zeros(n * n), s.k = zeros(n * n), s.b = zeros(z * n), s.kn = zeros(z), s.g = zeros(z);
    s.preload = zeros(n), s.force = zeros(n);
    s.plane = calloc((size_t)n, sizeof *s.plane);
    assert_non_null(s.plane);
    return s;
}

static void release(structure *s) {
    free(s->m), free(s->k), free(s->b), free(s->kn), free(s->g), free(s->preload), free(s->force);
    free(s->plane);
}

static void turn_rows(double *a, int64_t rows, int64_t n, int64_t i, int64_t j, double c, double s) {
    for (int64_t r = 0; r < rows; ++r) { /* columns i and j of each row */
        const double x = a[r * n + i], y = a[r * n + j];
        a[r * n + i] = c * x + s * y, a[r * n + j] = -s * x + c * y;
    }
}
static void turn_columns(double *a, int64_t n, int64_t i, int64_t j, double c, double s) {
    for (int64_t r = 0; r < n; ++r) {
        const double x = a[i * n + r], y = a[j * n + r];
        a[i * n + r] = c * x + s * y, a[j * n + r] = -s * x + c * y;
    }
}

/* Other axes in every plane. */
static void turn(structure *s, double angle) {
    const double c = cos(angle), d = sin(angle);
    for (int64_t p = 0; p < s->n_planes; ++p) {
        const int64_t i = s->plane[p][0], j = s->plane[p][1];
        turn_rows(s->m, s->n, s->n, i, j, c, d), turn_columns(s->m, s->n, i, j, c, d);
        turn_rows(s->k, s->n, s->n, i, j, c, d), turn_columns(s->k, s->n, i, j, c, d);
        turn_rows(s->b, s->z, s->n, i, j, c, d);
        turn_rows(s->preload, 1, s->n, i, j, c, d), turn_rows(s->force, 1, s->n, i, j, c, d);
    }
}

/* A number from a seed, which it moves on. */
static uint64_t next(uint64_t *seed) {
    *seed ^= *seed << 13, *seed ^= *seed >> 7, *seed ^= *seed << 17;
    return *seed;
}

static void reorder(double *a, int64_t rows, int64_t n, const int64_t *place) {
    double *row = zeros(n);
    for (int64_t r = 0; r < rows; ++r) {
        for (int64_t i = 0; i < n; ++i) row[place[i]] = a[r * n + i];
        memcpy(a + r * n, row, (size_t)n * sizeof *row);
    }
    free(row);
}
static void transpose(double *a, int64_t n) {
    for (int64_t i = 0; i < n; ++i)
        for (int64_t j = 0; j < i; ++j) {
            const double t = a[i * n + j];
            a[i * n + j] = a[j * n + i], a[j * n + i] = t;
        }
}

static void permute(structure *s, uint64_t seed) {
    int64_t *place = calloc((size_t)s->n, sizeof *place);
    assert_non_null(place);
    for (int64_t i = 0; i < s->n; ++i) {
        const int64_t j = (int64_t)(next(&seed) % (uint64_t)(i + 1));
        place[i] = place[j], place[j] = i;
    }
    double *both[] = {s->m, s->k};
    for (int a = 0; a < 2; ++a)
        reorder(both[a], s->n, s->n, place), transpose(both[a], s->n), reorder(both[a], s->n, s->n, place);
    reorder(s->b, s->z, s->n, place), reorder(s->preload, 1, s->n, place), reorder(s->force, 1, s->n, place);
    s->out = place[s->out];
    for (int64_t p = 0; p < s->n_planes; ++p)
        s->plane[p][0] = place[s->plane[p][0]], s->plane[p][1] = place[s->plane[p][1]];
    free(place);
}

static int64_t lower_triangle(const double *a, int64_t n, int64_t *i, int64_t *j, double *v) {
    int64_t count = 0;
    for (int64_t r = 0; r < n; ++r)
        for (int64_t c = 0; c <= r; ++c)
            if (a[r * n + c] != 0) i[count] = r, j[count] = c, v[count++] = a[r * n + c];
    return count;
}

typedef struct answer {
    plm_status status;
    double hz, amplitude, error;
    char said[2000]; /* what is to be looked at; empty: nothing */
} answer;

static void hand_over(const structure *s, plm_model *model) {
    const int64_t most = s->n * (s->n + 1) / 2 + s->z * s->n;
    int64_t *i = calloc((size_t)most, sizeof *i), *j = calloc((size_t)most, sizeof *j), count;
    double *v = zeros(most);
    count = lower_triangle(s->m, s->n, i, j, v);
    assert_true(done(ctx, plm_model_set_matrix_i64(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY,
                                                   count, i, j, v)));
    count = lower_triangle(s->k, s->n, i, j, v);
    assert_true(done(ctx, plm_model_set_matrix_i64(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY,
                                                   count, i, j, v)));
    count = 0; /* compressed rows: i holds where each begins */
    for (int64_t r = 0; r < s->z; ++r) {
        i[r] = count;
        for (int64_t c = 0; c < s->n; ++c)
            if (s->b[r * s->n + c] != 0) j[count] = c, v[count++] = s->b[r * s->n + c];
    }
    i[s->z] = count;
    assert_true(done(ctx, plm_model_add_gap_rows_i64(model, 0, s->z, i, j, v, s->kn, s->g)));
    free(i), free(j), free(v);
}

static answer ask(const structure *s) {
    plm_model *model = NULL;
    plm_hbm *hbm = NULL;
    answer a;
    memset(&a, 0, sizeof a);
    assert_true(done(ctx, plm_model_create(ctx, s->n, &model)));
    hand_over(s, model);
    assert_true(done(ctx, plm_model_set_rayleigh_damping(model, s->alpha, s->beta)));
    if (s->ratio > 0) assert_true(done(ctx, plm_model_set_modal_damping(model, 1, &s->ratio)));
    assert_true(done(ctx, plm_model_set_preload(model, s->n, s->preload)));
    assert_true(done(ctx, plm_model_set_excitation(model, 1, s->n, s->force, NULL)));
    assert_true(plm_model_build(model) >= 0);
    a.status =
        plm_model_compute_response(model, s->out, PLM_PEAK, 1e-3, &a.hz, &a.amplitude, &a.error, NULL, &hbm);
    if (a.status >= 0)
        assert_int_equal(plm_hbm_get_string(hbm, "warning", sizeof a.said, a.said, NULL), PLM_OK);
    plm_hbm_destroy(&hbm);
    plm_model_destroy(&model);
    return a;
}

static int says(const answer *a, const char *words) {
    return strstr(a->said, words) != NULL;
}

static int agree(const answer *a, const answer *b) {
    const int same = a->status == b->status && !a->said[0] == !b->said[0];
    if (!same) printf("    status %d and %d, %s\n", (int)a->status, (int)b->status, b->said);
    return same & close_to(b->hz, a->hz, 1e-9) & close_to(b->amplitude, a->amplitude, 1e-9);
}

/* Consumes the structure. */
static answer same_however_counted(const char *name, structure *s) {
    const answer first = ask(s);
    int all = first.status >= 0;
    printf("    %s, %d DOFs: %.9g at %.9g Hz, error %.1e, status %d\n", name, (int)s->n, first.amplitude,
           first.hz, first.error, (int)first.status);
    /* of large ones the last alone, which has all of it */
    for (int variant = s->n < 100 ? 0 : 2; variant < 3; ++variant) {
        if (variant > 0) turn(s, 0.4 * variant);
        permute(s, 88172645463325252u + (uint64_t)variant);
        const answer next_one = ask(s);
        all &= agree(&first, &next_one);
    }
    release(s);
    assert_true(all);
    return first;
}

static void add_plane(structure *s, int64_t i, int64_t j) {
    s->plane[s->n_planes][0] = i, s->plane[s->n_planes++][1] = j;
}

/* A chain of n unit masses on springs k from DOF `first` on, its first spring to the ground. */
static void add_chain(structure *s, int64_t first, int64_t n, double k) {
    for (int64_t i = first; i < first + n; ++i) {
        s->m[i * s->n + i] = 1, s->k[i * s->n + i] += k;
        if (i == first) continue;
        s->k[(i - 1) * s->n + i - 1] += k;
        s->k[i * s->n + i - 1] = s->k[(i - 1) * s->n + i] = -k;
    }
}

/* Two planes of one shaft, whose bending modes come in pairs of one frequency; a stop at the tip in one of
 * them, and a force in the direction `angle` from it. */
static structure shaft(double angle) {
    enum { N = 6 };
    structure s = empty(2 * N, 1);
    add_chain(&s, 0, N, 1e4), add_chain(&s, N, N, 1e4);
    s.b[N - 1] = 1, s.kn[0] = 5e4, s.g[0] = 1e-3;
    s.force[N - 1] = cos(angle), s.force[2 * N - 1] = sin(angle);
    s.out = N - 1, s.ratio = 0.01;
    for (int64_t i = 0; i < N - 1; ++i) add_plane(&s, i, N + i);
    return s;
}

static void a_shaft_hears_the_plane_of_its_force(void **state) {
    (void)state;
    structure along = shaft(0), across = shaft(0.25 * acos(-1));
    const answer in_plane = same_however_counted("shaft, force towards the stop", &along),
                 oblique = same_however_counted("shaft, force at 45 degrees", &across);
    assert_true(in_plane.status >= 0 && !says(&in_plane, "resembles"));
    assert_true(oblique.status >= 0 && !says(&oblique, "resembles"));
    /* the planes do not know each other: a force towards the stop of the part that points there does it, too
     */
    structure part = shaft(0);
    part.force[part.out] = cos(0.25 * acos(-1));
    const answer alone = ask(&part);
    release(&part);
    assert_true(close_to(oblique.amplitude, alone.amplitude, 1e-6));
    assert_true(close_to(oblique.hz, alone.hz, 1e-6));
}

/* Two equal parts that touch along their length, one of them driven. Together they move without contact; one
 * against the other the contact opens and closes: two resonances, driven alike. */
static void two_equal_parts_have_a_tie_and_it_is_said(void **state) {
    enum { N = 5 };
    structure s = empty(2 * N, N);
    add_chain(&s, 0, N, 1e4), add_chain(&s, N, N, 1e4);
    for (int64_t i = 0; i < N; ++i) {
        s.b[i * s.n + i] = 1, s.b[i * s.n + N + i] = -1, s.kn[i] = 3e4;
        if (i < N - 1) add_plane(&s, i, N + i);
    }
    s.force[N - 1] = 1, s.out = N - 1, s.ratio = 0.02;
    const answer a = same_however_counted("two equal parts", &s);
    (void)state;
    assert_true(says(&a, "alike"));
}

static structure chain_of_nodes(int with_preload) {
    chain c;
    structure s = empty(CHAIN_DOFS, 2);
    chain_fill(&c);
    for (int64_t j = 0; j < CHAIN_DOFS; ++j)
        for (int64_t p = c.col_ptr[j]; p < c.col_ptr[j + 1]; ++p)
            s.m[c.row[p] * s.n + j] = c.m[p], s.k[c.row[p] * s.n + j] = c.k[p];
    s.b[6] = 1, s.b[15] = -1, s.b[s.n + 21] = 1;
    s.kn[0] = PLM_AUTO_STIFFNESS, s.kn[1] = 2e4;
    s.alpha = 0.5, s.beta = 2e-4, s.out = 12;
    memcpy(s.force, c.force, sizeof c.force);
    if (with_preload) memcpy(s.preload, c.preload, sizeof c.preload);
    for (int64_t node = 0; node < CHAIN_NODES; ++node) add_plane(&s, 3 * node + (node == 4), 3 * node + 2);
    return s;
}

static void a_chain_is_the_same_however_counted(void **state) {
    (void)state;
    for (int with_preload = 0; with_preload < 2; ++with_preload) {
        structure s = chain_of_nodes(with_preload);
        same_however_counted(with_preload ? "chain, pre-load" : "chain", &s);
    }
}

/* Without its supports; the output along y, so that x and z are free to be turned. */
static structure free_part(const scene *c) {
    int64_t *free_of = calloc((size_t)c->n_dof, sizeof *free_of), n = 0, next_fixed = 0;
    assert_non_null(free_of);
    for (int64_t i = 0; i < c->n_dof; ++i) {
        const int fixed = next_fixed < c->n_fixed && c->fixed[next_fixed] == i;
        next_fixed += fixed, free_of[i] = fixed ? -1 : n++;
    }
    structure s = empty(n, c->n_pairs);
    for (int64_t j = 0; j < c->n_dof; ++j)
        for (int64_t p = c->col_ptr[j]; p < c->col_ptr[j + 1]; ++p) {
            const int64_t i = free_of[c->row[p]], k = free_of[j];
            if (i >= 0 && k >= 0) s.m[i * n + k] = c->m[p], s.k[i * n + k] = c->k[p];
        }
    for (int64_t p = 0; p < c->n_pairs; ++p) {
        s.kn[p] = c->contact_stiffness[p] < 0 ? PLM_AUTO_STIFFNESS : c->contact_stiffness[p];
        s.g[p] = c->gap[p];
        for (int x = 0; x < 3; ++x) {
            const int64_t a = c->dof_a[3 * p + x], b = c->dof_b[3 * p + x];
            if (free_of[a] >= 0) s.b[p * n + free_of[a]] += c->normal[3 * p + x];
            if (b >= 0 && free_of[b] >= 0) s.b[p * n + free_of[b]] -= c->normal[3 * p + x];
        }
    }
    for (int64_t i = 0; i < c->n_dof; ++i) {
        if (free_of[i] < 0) continue;
        s.force[free_of[i]] = c->force[i];
        if (c->preload) s.preload[free_of[i]] = c->preload[i];
        if (i % 3 == 0) add_plane(&s, free_of[i], free_of[i + 2]);
    }
    s.out = free_of[c->output_dof], s.alpha = c->mass_damping, s.beta = c->stiffness_damping;
    free(free_of);
    return s;
}

static void a_cracked_plate_is_the_same_however_counted(void **state) {
    (void)state;
    for (int with_preload = 0; with_preload < 2; ++with_preload) {
        scene *c = NULL;
        assert_int_equal(scene_create("cracked_plate", "quick", with_preload, &c), SCENE_OK);
        structure s = free_part(c);
        scene_destroy(&c);
        same_however_counted(with_preload ? "cracked plate, pre-load" : "cracked plate", &s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_shaft_hears_the_plane_of_its_force),
        cmocka_unit_test(two_equal_parts_have_a_tie_and_it_is_said),
        cmocka_unit_test(a_chain_is_the_same_however_counted),
        cmocka_unit_test(a_cracked_plate_is_the_same_however_counted),
    };
    return cmocka_run_group_tests(tests, open_context, close_context);
}
