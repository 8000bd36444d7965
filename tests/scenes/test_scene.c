/* test_scene.c: every scene's arrays are what scene.h promises; sizes are those of the paper. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bilinear_oscillator.h"
#include "coaxial_cylinders.h"
#include "cracked_plate.h"
#include "groups.h"

static const double pi = 3.14159265358979323846;

static scene *make(const char *name, const char *size, int with_preload) {
    scene *s = NULL;
    assert_int_equal(scene_create(name, size, with_preload, &s), SCENE_OK);
    assert_non_null(s);
    assert_string_equal(s->name, name);
    return s;
}

static int64_t place_of(const scene *s, int64_t row, int64_t col) {
    for (int64_t at = s->col_ptr[col]; at < s->col_ptr[col + 1]; at++)
        if (s->row[at] == row) return at;
    return -1;
}

static void check_matrices(const scene *s) {
    int64_t bad = 0;
    assert_int_equal(s->n_dof, 3 * s->n_nodes);
    assert_int_equal(s->col_ptr[0], 0);
    assert_int_equal(s->col_ptr[s->n_dof], s->nnz);
    for (int64_t col = 0; col < s->n_dof; col++)
        for (int64_t at = s->col_ptr[col]; at < s->col_ptr[col + 1]; at++) {
            const int64_t row = s->row[at], mirror = row >= 0 && row < s->n_dof ? place_of(s, col, row) : -1;
            bad += at > s->col_ptr[col] && row <= s->row[at - 1];
            bad += mirror < 0 || s->k[mirror] != s->k[at] || s->m[mirror] != s->m[at];
            bad += row == col && !(s->k[at] > 0 && s->m[at] > 0);
        }
    assert_int_equal(bad, 0);
}

static void check_supports_and_loads(const scene *s, int with_preload) {
    double force = 0, preload = 0;
    for (int64_t f = 0; f < s->n_fixed; f++)
        assert_true(s->fixed[f] >= 0 && s->fixed[f] < s->n_dof && (f == 0 || s->fixed[f] > s->fixed[f - 1]));
    for (int64_t dof = 0; dof < s->n_dof; dof++) {
        force += fabs(s->force[dof]);
        preload += with_preload ? fabs(s->preload[dof]) : 0;
    }
    assert_true(s->output_dof >= 0 && s->output_dof < s->n_dof);
    assert_true(force == 1 && s->force[s->output_dof] == 1);
    assert_true(with_preload ? preload > 0 : s->preload == NULL);
    for (int64_t f = 0; f < s->n_fixed; f++)
        assert_true(s->force[s->fixed[f]] == 0 && (!with_preload || s->preload[s->fixed[f]] == 0));
    assert_true(s->stiffness_damping + s->mass_damping > 0);
    assert_true(s->dominant_mode >= 1);
    assert_true(s->dominant_system == SCENE_OPEN || s->dominant_system == SCENE_SLIDING);
}

/* Least and greatest height of a node's neighbours over it, along `normal`. */
static void heights(const scene *s, int64_t dof, const double *normal, double *low, double *high) {
    const double *x = s->xyz + dof;
    *low = *high = 0;
    for (int64_t at = s->col_ptr[dof]; at < s->col_ptr[dof + 1]; at++) {
        const double *y = s->xyz + s->row[at] / 3 * 3;
        const double h = normal[0] * (y[0] - x[0]) + normal[1] * (y[1] - x[1]) + normal[2] * (y[2] - x[2]);
        *low = h < *low ? h : *low;
        *high = h > *high ? h : *high;
    }
}

static void check_pairs(const scene *s) {
    for (int64_t p = 0; p < s->n_pairs; p++) {
        const double *n = s->normal + 3 * p;
        const int64_t a = s->dof_a[3 * p], b = s->dof_b[3 * p];
        double low, high;
        assert_true(fabs(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-14);
        assert_true(s->gap[p] == 0);
        for (int c = 0; c < 3; c++) {
            assert_true(s->dof_a[3 * p + c] == a + c && a % 3 == 0 && a >= 0 && a < s->n_dof);
            assert_true(s->dof_b[3 * p + c] == (b == SCENE_NO_DOF ? SCENE_NO_DOF : b + c));
        }
        if (b == SCENE_NO_DOF) continue;
        assert_true(b != a && b % 3 == 0 && b >= 0 && b < s->n_dof);
        for (int c = 0; c < 3; c++) assert_true(s->xyz[a + c] == s->xyz[b + c]);
        assert_true(s->contact_stiffness[p] != 0); /* positive, or the choice left to the library */
        heights(s, a, n, &low, &high);             /* body a lies behind its normal */
        assert_true(low < -0.1 && high < 1e-12);
        heights(s, b, n, &low, &high); /* body b lies before it; a concave surface may also reach back */
        assert_true(high > 0.1);
    }
}

static void every_scene_keeps_the_promises_of_its_header(void **state) {
    (void)state;
    const char *sizes[] = {"quick", "paper"};
    for (int i = 0; i < scene_count(); i++)
        for (int size = 0; size < 2; size++)
            for (int with_preload = 0; with_preload < 2; with_preload++) {
                if (size == 1 && with_preload == 0) continue; /* the same matrices once more */
                scene *s = make(scene_name(i), sizes[size], with_preload);
                check_matrices(s);
                check_supports_and_loads(s, with_preload);
                check_pairs(s);
                scene_destroy(&s);
                assert_null(s);
            }
}

/* Mass that moves in direction c when the whole structure does; NaN if another direction takes part. */
static double total_mass(const scene *s, int c) {
    double total = 0;
    for (int64_t col = c; col < s->n_dof; col += 3) {
        double column = 0; /* summed apart: two million terms in one sum would lose three digits */
        for (int64_t at = s->col_ptr[col]; at < s->col_ptr[col + 1]; at++) {
            if (s->row[at] % 3 == c)
                column += s->m[at];
            else if (s->m[at] != 0)
                return NAN;
        }
        total += column;
    }
    return total;
}

static void total_mass_is_density_times_volume(void **state) {
    (void)state;
    scene *plate = make("cracked_plate", "paper", 0), *cylinders = make("coaxial_cylinders", "paper", 0);
    /* the walls are prisms over the ring between two polygons of 64 sides */
    const double ring = 64 / 2.0 * sin(2 * pi / 64), volume = ring * 55.5 * (9.6 * 9.6 - 8.4 * 8.4);
    for (int c = 0; c < 3; c++) {
        assert_true(fabs(total_mass(plate, c) / (7.8e-9 * 150 * 60 * 5) - 1) < 1e-12);
        assert_true(fabs(total_mass(cylinders, c) / (7.8e-9 * volume) - 1) < 1e-12);
    }
    scene_destroy(&plate);
    scene_destroy(&cylinders);
}

static void the_paper_sizes_are_exact(void **state) {
    (void)state;
    scene *s = make("cracked_plate", "paper", 0);
    assert_int_equal(s->n_dof, 18630);
    assert_int_equal(s->n_pairs, 90);
    assert_int_equal(s->n_fixed, 3 * 36 * 5);
    assert_true(s->xyz[s->dof_a[0]] == 75);
    scene_destroy(&s);

    s = make("coaxial_cylinders", "paper", 0);
    assert_int_equal(s->n_nodes, 23424);
    assert_int_equal(s->n_pairs, 256);
    assert_int_equal(s->n_fixed,
                     2 * (3 * 64 * 3 + 2 * 3)); /* clamped rings; two radial supports through each wall */
    scene_destroy(&s);
}

static void a_plate_with_another_crack_is_built_as_asked(void **state) {
    (void)state;
    cracked_plate_params p;
    scene *s = NULL;
    cracked_plate_quick(&p);
    p.nx = 24;
    p.ny = 13;
    p.crack_rows = 7;
    p.crack_position = p.length / 4;
    p.gap = 1e-3;
    p.contact_stiffness = 5e4;
    p.with_preload = 1;
    p.n_loads = 0;
    p.end_compression = 1000;
    assert_int_equal(cracked_plate_create(&p, &s), SCENE_OK);
    assert_int_equal(s->n_pairs, 7 * 3);
    double total[3] = {0, 0, 0};
    for (int64_t dof = 0; dof < s->n_dof; dof++) total[dof % 3] += s->preload[dof];
    assert_true(fabs(total[0] + 1000) < 1e-9 && total[1] == 0 && total[2] == 0);
    for (int64_t pair = 0; pair < s->n_pairs; pair++) {
        assert_true(s->xyz[s->dof_a[3 * pair]] == 37.5);
        assert_true(s->gap[pair] == 1e-3 && s->contact_stiffness[pair] == 5e4);
    }
    scene_destroy(&s);
}

/* Each crack doubles its nodes; two twins share a place, and beside them no nodes do. */
static void further_cracks_stand_evenly_along_x(void **state) {
    (void)state;
    cracked_plate_params p;
    scene *s = NULL;
    cracked_plate_quick(&p);
    p.crack_rows = 4;
    p.further_cracks = 2;
    assert_int_equal(cracked_plate_create(&p, &s), SCENE_OK);
    assert_int_equal(s->n_pairs, 3 * 4 * 3);
    assert_int_equal(s->n_nodes, 13 * 11 * 3 + s->n_pairs);
    for (int64_t pair = 0; pair < s->n_pairs; pair++) {
        const double *a = s->xyz + s->dof_a[3 * pair], *b = s->xyz + s->dof_b[3 * pair];
        assert_true(a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
        assert_true(fabs(a[0] - p.length * (double)(1 + pair / 12) / 4) < 1e-12);
        assert_true(a[1] > 0.6 * p.width && s->dof_a[3 * pair] != s->dof_b[3 * pair]);
    }
    scene_destroy(&s);
}

static void top_loads_keep_their_size_and_place(void **state) {
    (void)state;
    const double places[] = {0, 10, 74, 75, 75.5, 76, 149, 150};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        cracked_plate_params p;
        scene *s = NULL;
        double total = 0, moment = 0;
        cracked_plate_quick(&p);
        p.with_preload = 1;
        p.n_loads = 1;
        p.load_x[0] = places[i];
        p.load_fx[0] = 0;
        p.load_fy[0] = -3;
        assert_int_equal(cracked_plate_create(&p, &s), SCENE_OK);
        for (int64_t node = 0; node < s->n_nodes; node++) {
            total += s->preload[3 * node + 1];
            moment += s->preload[3 * node + 1] * s->xyz[3 * node];
        }
        assert_true(fabs(total + 3) < 1e-12 && fabs(moment + 3 * places[i]) < 1e-9);
        scene_destroy(&s);
    }
}

static void cylinder_options_are_built_as_asked(void **state) {
    (void)state;
    coaxial_cylinders_params p;
    scene *s = NULL;
    coaxial_cylinders_quick(&p);
    p.support.ring = 0;
    p.quality_factor = 0;
    p.overlap_rings = 0;
    assert_int_equal(coaxial_cylinders_create(&p, &s), SCENE_OK);
    assert_int_equal(s->n_pairs, 16);
    assert_int_equal(s->n_fixed, 2 * 3 * 16 * 2);
    assert_true(s->stiffness_damping == 0);
    scene_destroy(&s);
}

static void the_oscillator_holds_the_numbers_given(void **state) {
    (void)state;
    bilinear_oscillator_params p;
    scene *s = NULL;
    bilinear_oscillator_default(&p);
    p.mass = 2;
    p.stiffness = 7;
    p.damping = 0.5;
    p.gap = 0.25;
    p.contact_stiffness = 11;
    assert_int_equal(bilinear_oscillator_create(&p, &s), SCENE_OK);
    assert_int_equal(s->n_dof - s->n_fixed, 1);
    assert_true(s->m[0] == 2 && s->k[0] == 7 && s->mass_damping * s->m[0] == 0.5 &&
                s->stiffness_damping == 0);
    assert_true(s->gap[0] == 0.25 && s->contact_stiffness[0] == 11 && s->normal[0] == 1);
    assert_true(s->dof_a[0] == 0 && s->dof_b[0] == SCENE_NO_DOF);
    scene_destroy(&s);
}

static void bad_arguments_give_codes_and_leave_the_output_alone(void **state) {
    (void)state;
    scene *const untouched = (scene *)state;
    scene *s = untouched;
    assert_int_equal(scene_create("no such scene", "quick", 0, &s), SCENE_ERR_NAME);
    assert_int_equal(scene_create("cracked_plate", "huge", 0, &s), SCENE_ERR_SIZE);
    assert_int_equal(scene_create(NULL, "quick", 0, &s), SCENE_ERR_ARGUMENT);
    assert_int_equal(scene_create("cracked_plate", NULL, 0, &s), SCENE_ERR_ARGUMENT);
    assert_int_equal(scene_create("cracked_plate", "quick", 0, NULL), SCENE_ERR_ARGUMENT);
    assert_null(scene_name(-1));
    assert_null(scene_name(scene_count()));
    scene_destroy(NULL);
    for (int code = SCENE_ERR_ELEMENT - 1; code <= 1; code++) assert_true(strlen(scene_error_text(code)) > 0);
    assert_ptr_equal(s, untouched);
}

static void bad_plates_are_refused(void **state) {
    (void)state;
    scene *const untouched = (scene *)state;
    scene *s = untouched;
    cracked_plate_params good, p;
    cracked_plate_quick(&good);
    assert_int_equal(cracked_plate_create(NULL, &s), SCENE_ERR_ARGUMENT);
#define REFUSED(change)                                                                                      \
    do {                                                                                                     \
        p = good;                                                                                            \
        change;                                                                                              \
        assert_int_equal(cracked_plate_create(&p, &s), SCENE_ERR_ARGUMENT);                                  \
    } while (0)
    REFUSED(p.nx = 1);
    REFUSED(p.nz = 0);
    REFUSED(p.crack_rows = 0);
    REFUSED(p.crack_rows = p.ny);
    REFUSED(p.further_cracks = -1);
    REFUSED(p.further_cracks = p.nx - 1);
    REFUSED(p.columns_before_crack = p.nx);
    REFUSED(p.crack_position = 0);
    REFUSED(p.crack_position = p.length);
    REFUSED(p.width = -1);
    REFUSED(p.thickness = NAN);
    REFUSED(p.material.young = 0);
    REFUSED(p.n_loads = CRACKED_PLATE_LOADS + 1);
    REFUSED(p.load_x[0] = p.length + 1);
    REFUSED(p.load_fy[0] = INFINITY);
    REFUSED(p.quality_frequency_hz = 0);
    REFUSED(p.gap = NAN);
#undef REFUSED
    assert_ptr_equal(s, untouched);
}

static void bad_cylinders_and_oscillators_are_refused(void **state) {
    (void)state;
    scene *s = NULL;
    coaxial_cylinders_params good, p;
    bilinear_oscillator_params o;
    coaxial_cylinders_quick(&good);
    assert_int_equal(coaxial_cylinders_create(NULL, &s), SCENE_ERR_ARGUMENT);
#define REFUSED(change)                                                                                      \
    do {                                                                                                     \
        p = good;                                                                                            \
        change;                                                                                              \
        assert_int_equal(coaxial_cylinders_create(&p, &s), SCENE_ERR_ARGUMENT);                              \
    } while (0)
    REFUSED(p.n_around = 18);
    REFUSED(p.n_along = 0);
    REFUSED(p.overlap_rings = p.n_along + 1);
    REFUSED(p.support.ring = p.n_along + 1);
    REFUSED(p.wall = p.contact_radius);
    REFUSED(p.length = NAN);
    REFUSED(p.material.poisson = 0.5);
    REFUSED(p.quality_factor = -1);
#undef REFUSED
    bilinear_oscillator_default(&o);
    o.mass = 0;
    assert_int_equal(bilinear_oscillator_create(&o, &s), SCENE_ERR_ARGUMENT);
    assert_int_equal(bilinear_oscillator_create(NULL, &s), SCENE_ERR_ARGUMENT);
    assert_null(s);
}

int run_scene(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_scene_keeps_the_promises_of_its_header),
        cmocka_unit_test(total_mass_is_density_times_volume),
        cmocka_unit_test(the_paper_sizes_are_exact),
        cmocka_unit_test(a_plate_with_another_crack_is_built_as_asked),
        cmocka_unit_test(further_cracks_stand_evenly_along_x),
        cmocka_unit_test(top_loads_keep_their_size_and_place),
        cmocka_unit_test(cylinder_options_are_built_as_asked),
        cmocka_unit_test(the_oscillator_holds_the_numbers_given),
        cmocka_unit_test(bad_arguments_give_codes_and_leave_the_output_alone),
        cmocka_unit_test(bad_plates_are_refused),
        cmocka_unit_test(bad_cylinders_and_oscillators_are_refused),
    };
    return cmocka_run_group_tests_name("scene", tests, NULL, NULL);
}
