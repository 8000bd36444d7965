/* model.c: from matrices to a built model, and what can be asked of it. */
#include "example.h"
#include "tall_host.h"
#include <math.h>
#include <stdio.h>

/* the same two masses again and again, in every way to hand things over */
static int matrices(plm_context *ctx) {
    /* [plm_model_create] [plm_model_destroy] */
    plm_model *model = NULL;
    TRY(plm_model_create(ctx, 2, &model)); /* two DOFs */
    TRY(plm_model_destroy(&model));
    /* [plm_model_create] [plm_model_destroy] */
    TRY(plm_model_create(ctx, 2, &model));

    /* [plm_model_set_matrix_i32] */
    /* lower triangle by compressed columns, counted from 0 as in C */
    const int32_t column_start[] = {0, 2, 3}, row[] = {0, 1, 1};
    const double stiffness[] = {20000, -10000, 10000};
    TRY(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_CSC, PLM_LOWER, 0, PLM_COPY, 3, column_start, row,
                                 stiffness));
    /* [plm_model_set_matrix_i32] */

    /* [plm_model_set_matrix_i64] */
    /* triplets with wide integers, counted from 1 as in Fortran; entries of the same place are summed */
    const int64_t i[] = {1, 2, 2}, j[] = {1, 2, 2};
    const double mass[] = {1, 0.5, 0.5};
    TRY(plm_model_set_matrix_i64(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 1, PLM_COPY, 3, i, j, mass));
    /* [plm_model_set_matrix_i64] */

    /* [plm_model_set_rayleigh_damping] */
    TRY(plm_model_set_rayleigh_damping(model, 0.5, 2e-4)); /* C = 0.5 M + 0.0002 K */
    /* [plm_model_set_rayleigh_damping] */

    /* [plm_model_set_modal_damping] */
    const double ratio[] = {0.01, 0.02}; /* the first mode 1 %, all others 2 % */
    TRY(plm_model_set_modal_damping(model, 2, ratio));
    /* [plm_model_set_modal_damping] */

    /* [plm_model_set_structural_damping] */
    TRY(plm_model_set_structural_damping(model, 0.002)); /* K (1 + 0.002 i) */
    /* [plm_model_set_structural_damping] */
    return plm_model_build(model);
}

static int contacts(plm_context *ctx) {
    plm_model *model = NULL;
    TRY(plm_model_create(ctx, 6, &model)); /* two nodes with three DOFs each */
    const double k_n[] = {5000}, normal[] = {1, 0, 0}, gap[] = {0.001};

    /* [plm_model_fix_dofs_i32] */
    const int32_t held[] = {1, 2};
    TRY(plm_model_fix_dofs_i32(model, 0, 2, held));
    /* [plm_model_fix_dofs_i32] */
    /* [plm_model_fix_dofs_i64] */
    const int64_t held_too[] = {5, 6}; /* counted from 1 */
    TRY(plm_model_fix_dofs_i64(model, 1, 2, held_too));
    /* [plm_model_fix_dofs_i64] */

    /* [plm_model_set_elimination_order_i32] */
    const int32_t order[] = {3, 0, 4, 1, 5, 2};
    TRY(plm_model_set_elimination_order_i32(model, 0, 6, order));
    /* [plm_model_set_elimination_order_i32] */
    /* [plm_model_set_elimination_order_i64] */
    const int64_t order_from_1[] = {4, 1, 5, 2, 6, 3};
    TRY(plm_model_set_elimination_order_i64(model, 1, 6, order_from_1)); /* in place of the one before */
    TRY(plm_model_set_elimination_order_i64(model, 1, 0, NULL));         /* and back to the library's own */
    /* [plm_model_set_elimination_order_i64] */

    /* [plm_model_add_node_pairs_i32] */
    /* node 0 against node 1 along x, touching at first, the stiffness chosen by the library */
    const int32_t a[] = {0, 1, 2}, b[] = {3, 4, 5};
    const double chosen[] = {PLM_AUTO_STIFFNESS};
    TRY(plm_model_add_node_pairs_i32(model, 0, 1, a, b, normal, chosen, NULL));
    /* [plm_model_add_node_pairs_i32] */
    /* [plm_model_add_node_pairs_i64] */
    const int64_t far_a[] = {1, 0, 0}, far_b[] = {4, 0, 0}; /* from 1, so that 0 is "no such DOF" */
    TRY(plm_model_add_node_pairs_i64(model, 1, 1, far_a, far_b, normal, k_n, gap));
    /* [plm_model_add_node_pairs_i64] */

    /* [plm_model_add_ground_contacts_i32] */
    const int32_t node[] = {3, 4, 5}; /* 1 mm before it runs into a wall at its right */
    TRY(plm_model_add_ground_contacts_i32(model, 0, 1, node, normal, k_n, gap));
    /* [plm_model_add_ground_contacts_i32] */
    /* [plm_model_add_ground_contacts_i64] */
    const int64_t node_64[] = {3, -1, -1};
    TRY(plm_model_add_ground_contacts_i64(model, 0, 1, node_64, normal, k_n, gap));
    /* [plm_model_add_ground_contacts_i64] */

    /* [plm_model_add_constraints_i32] */
    /* q_4 = (q_3 + q_5) / 2: a node in the middle of an edge */
    const int32_t tie_ptr[] = {0, 3}, tie_dof[] = {4, 3, 5};
    const double tie[] = {1, -0.5, -0.5};
    TRY(plm_model_add_constraints_i32(model, 0, 1, tie_ptr, tie_dof, tie));
    /* [plm_model_add_constraints_i32] */
    /* [plm_model_add_constraints_i64] */
    const int64_t wide_tie_ptr[] = {0, 3}, wide_tie_dof[] = {4, 3, 5}; /* the same once more: left out */
    TRY(plm_model_add_constraints_i64(model, 0, 1, wide_tie_ptr, wide_tie_dof, tie));
    /* [plm_model_add_constraints_i64] */

    /* [plm_model_add_gap_rows_i32] */
    /* u = q_0 - (q_3 + q_4) / 2: a node against the middle of an edge */
    const int32_t row_ptr[] = {0, 3}, dof[] = {0, 3, 4};
    const double coefficient[] = {1, -0.5, -0.5};
    TRY(plm_model_add_gap_rows_i32(model, 0, 1, row_ptr, dof, coefficient, k_n, gap));
    /* [plm_model_add_gap_rows_i32] */
    /* [plm_model_add_gap_rows_i64] */
    const int64_t wide_ptr[] = {0, 1}, wide_dof[] = {3};
    TRY(plm_model_add_gap_rows_i64(model, 0, 1, wide_ptr, wide_dof, coefficient, k_n, NULL));
    /* [plm_model_add_gap_rows_i64] */

    /* [plm_model_set_rest_force] */
    /* the first of the six pairs by now presses with 250 N at rest, the second just touches, the others keep
     * gaps */
    const double at_rest[] = {250, 0, PLM_KEEP_GAP, PLM_KEEP_GAP, PLM_KEEP_GAP, PLM_KEEP_GAP};
    TRY(plm_model_set_rest_force(model, 6, at_rest));
    /* [plm_model_set_rest_force] */

    /* [plm_model_set_gap_motion] */
    /* six pairs by now, of which the wall of the third one shakes, and that of the fourth a quarter later */
    const double shakes[] = {0, 0, 1e-4, 0, 0, 0}, later[] = {0, 0, 0, -1e-4, 0, 0};
    TRY(plm_model_set_gap_motion(model, 1, 6, shakes, later));
    TRY(plm_model_set_gap_motion(model, 2, 6, shakes, NULL)); /* and with twice the frequency */
    TRY(plm_model_set_gap_motion(model, 2, 0, NULL, NULL));   /* which is taken back */
    /* [plm_model_set_gap_motion] */

    /* [plm_model_add_outputs_i32] */
    /* how far the nodes move apart, and their mean: looked at as DOFs 6 and 7 */
    const int32_t sum_ptr[] = {0, 2, 4}, sum_dof[] = {0, 3, 0, 3};
    const double sums[] = {1, -1, 0.5, 0.5};
    int64_t apart = 0;
    TRY(plm_model_add_outputs_i32(model, 0, 2, sum_ptr, sum_dof, sums, &apart));
    EXPECT(apart == 6);
    /* [plm_model_add_outputs_i32] */
    /* [plm_model_add_outputs_i64] */
    const int64_t wide_sum_ptr[] = {0, 2}, wide_sum_dof[] = {0, 4}; /* one more */
    TRY(plm_model_add_outputs_i64(model, 0, 1, wide_sum_ptr, wide_sum_dof, sums, &apart));
    EXPECT(apart == 8);
    /* [plm_model_add_outputs_i64] */
    return 0;
}

static int couplings(plm_context *ctx) {
    plm_model *model = NULL;
    TRY(plm_model_create(ctx, 3, &model));
    /* [plm_model_set_multipliers_i32] */
    /* two masses on springs, tied by DOF 2, a multiplier: its row of K says q_0 - q_1 = 0 */
    const int32_t row[] = {0, 1, 2, 2}, column[] = {0, 1, 0, 1}, multiplier[] = {2};
    const double m[] = {1, 2}, k[] = {1000, 3000, 1, -1};
    TRY(plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 2, row, column, m));
    TRY(plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_LOWER, 0, PLM_COPY, 4, row, column,
                                 k));
    TRY(plm_model_set_multipliers_i32(model, 0, 1, multiplier));
    /* [plm_model_set_multipliers_i32] */
    /* [plm_model_set_multipliers_i64] */
    const int64_t from_1[] = {3};
    TRY(plm_model_set_multipliers_i64(model, 1, 1, from_1)); /* in place of those before */
    /* [plm_model_set_multipliers_i64] */
    TRY(plm_model_build(model));
    TRY(plm_model_destroy(&model));

    TRY(plm_model_create(ctx, 15, &model));
    /* [plm_model_add_rigid_link_i32] */
    /* the nodes with DOFs 0 to 2 and 3 to 5 follow that with DOFs 9 to 14, its rotations among them */
    const int32_t hub[] = {9, 10, 11, 12, 13, 14}, rim[] = {0, 1, 2, 3, 4, 5};
    const double centre[] = {0, 0, 0}, at[] = {100, 0, 0, 0, 100, 0};
    TRY(plm_model_add_rigid_link_i32(model, 0, 6, hub, centre, 2, 3, rim, at));
    /* [plm_model_add_rigid_link_i32] */
    /* [plm_model_add_rigid_link_i64] */
    const int64_t wide_hub[] = {10, 11, 12, 13, 14, 15},
                  wide_rim[] = {1, 2, 3, 0, 5, 6}; /* from 1: 0 is none */
    TRY(plm_model_add_rigid_link_i64(model, 1, 6, wide_hub, centre, 2, 3, wide_rim, at));
    /* [plm_model_add_rigid_link_i64] */
    TRY(plm_model_destroy(&model));

    TRY(plm_model_create(ctx, 15, &model));
    /* [plm_model_set_coordinates_i32] */
    /* three nodes of a plane, without DOFs along z */
    const int32_t in_plane[] = {0, 1, -1, 2, 3, -1, 4, 5, -1};
    const double in_plane_at[] = {0, 0, 0, 100, 0, 0, 0, 100, 0};
    TRY(plm_model_set_coordinates_i32(model, 0, 3, 3, in_plane, in_plane_at));
    /* [plm_model_set_coordinates_i32] */
    /* [plm_model_set_coordinates_i64] */
    const int64_t shell_node[] = {1, 2, 3, 4, 5, 6}; /* counted from 1, with rotations */
    TRY(plm_model_set_coordinates_i64(model, 1, 1, 6, shell_node, in_plane_at));
    /* [plm_model_set_coordinates_i64] */
    TRY(plm_model_destroy(&model));

    TRY(plm_model_create(ctx, 15, &model));
    /* [plm_model_add_distributing_coupling_i32] */
    /* a load at the middle of three nodes, DOFs 9 to 14, goes to them as a force and a moment would */
    const int32_t middle[] = {9, 10, 11, 12, 13, 14}, nodes[] = {0, 1, 2, 3, 4, 5, 6, 7, 8};
    const double load_at[] = {30, 30, 0}, corners[] = {0, 0, 0, 100, 0, 0, 0, 100, 0}, area[] = {2, 1, 1};
    TRY(plm_model_add_distributing_coupling_i32(model, 0, 6, middle, load_at, 3, nodes, corners, area));
    /* [plm_model_add_distributing_coupling_i32] */
    TRY(plm_model_destroy(&model));

    TRY(plm_model_create(ctx, 15, &model));
    /* [plm_model_add_distributing_coupling_i64] */
    const int64_t mean[] = {9, 10, 11}, wide_nodes[] = {0, 1, 2, 3, 4, 5, 6, 7, 8}; /* without rotations */
    TRY(plm_model_add_distributing_coupling_i64(model, 0, 3, mean, load_at, 3, wide_nodes, corners, NULL));
    /* [plm_model_add_distributing_coupling_i64] */
    TRY(plm_model_destroy(&model));

    TRY(plm_model_create(ctx, 15, &model));
    /* [plm_model_add_surface_i32] */
    /* a face of four nodes, its normal up, and over it a node that stands for 40 mm2 */
    const int32_t below_dof[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}, below_ptr[] = {0, 4},
                  below_node[] = {0, 1, 2, 3}, over_dof[] = {12, 13, 14};
    const double below_at[] = {0, 0, 0, 10, 0, 0, 10, 10, 0, 0, 10, 0}, over_at[] = {3, 4, 0.1},
                 over_area[] = {40};
    int64_t below = 0, over = 0;
    TRY(plm_model_add_surface_i32(model, 0, 4, below_dof, below_at, NULL, 1, below_ptr, below_node, &below));
    TRY(plm_model_add_surface_i32(model, 0, 1, over_dof, over_at, over_area, 0, NULL, NULL, &over));
    /* [plm_model_add_surface_i32] */
    /* [plm_model_add_surface_contact] */
    TRY(plm_model_add_surface_contact(model, over, below, 0, 1e3, 1, 0)); /* k_n: 1e3 N/mm3 * 40 mm2 */
    int64_t n_surface_pairs = 0;
    TRY(plm_model_get_int(model, "n_pairs", &n_surface_pairs));
    /* [plm_model_add_surface_contact] */
    EXPECT(n_surface_pairs == 1);
    /* [plm_model_add_surface_i64] */
    const int64_t wall_ptr[] = {0, 3}, wall_node[] = {0, 1, 2}; /* a rigid triangle, its normal down */
    const double wall_at[] = {0, 0, 1, 0, 10, 1, 10, 0, 1};
    const int64_t none[] = {-1, -1, -1, -1, -1, -1, -1, -1, -1};
    int64_t wall = 0;
    TRY(plm_model_add_surface_i64(model, 0, 3, none, wall_at, NULL, 1, wall_ptr, wall_node, &wall));
    /* [plm_model_add_surface_i64] */
    TRY(plm_model_destroy(&model));

    TRY(plm_model_create(ctx, 15, &model));
    /* [plm_model_add_tie_i32] */
    /* the node with DOFs 12 to 14 stands 0.1 mm over a face of four nodes */
    const int32_t node[] = {12, 13, 14}, face_dof[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11},
                  face_ptr[] = {0, 4}, face_node[] = {0, 1, 2, 3};
    const double node_at[] = {30, 40, 0.1}, face_at[] = {0, 0, 0, 100, 0, 0, 100, 100, 0, 0, 100, 0};
    double distance[1];
    TRY(plm_model_add_tie_i32(model, 0, 1, node, node_at, 4, face_dof, face_at, 1, face_ptr, face_node, 1,
                              distance));
    /* [plm_model_add_tie_i32] */
    EXPECT(distance[0] > 0.0999 && distance[0] < 0.1001);
    /* [plm_model_add_tie_i64] */
    const int64_t wide_node[] = {12, 13, 14}, wide_face[] = {0, 1, 2, 3, 4, 5, 6, 7, 8},
                  wide_face_ptr[] = {0, 3}, wide_face_node[] = {0, 1, 2}; /* a triangle of the first three */
    TRY(plm_model_add_tie_i64(model, 0, 1, wide_node, node_at, 3, wide_face, face_at, 1, wide_face_ptr,
                              wide_face_node, 10, NULL));
    /* [plm_model_add_tie_i64] */
    TRY(plm_model_destroy(&model));
    return 0;
}

/* both masses of the rod move with the one DOF that the host kept: T = (0.5, 1) */
static int32_t whole_motion(plm_context *ctx, int64_t n_dof, int64_t n_columns, const double *reduced,
                            int64_t n_full, double *full, void *user) {
    const double *t = user;
    (void)ctx;
    for (int64_t j = 0; j < n_columns; ++j)
        for (int64_t i = 0; i < n_full; ++i) full[i + j * n_full] = t[i] * reduced[j * n_dof];
    return 0;
}

static int superelement(plm_context *ctx) {
    static double t[] = {0.5, 1};
    plm_model *model = NULL;
    TRY(plm_model_create(ctx, 1, &model));
    /* [plm_model_set_dense_matrix] */
    const double m[] = {1.25}, k[] = {5000}; /* T^T M T and T^T K T, n_dof x n_dof by columns */
    TRY(plm_model_set_dense_matrix(model, PLM_MASS, PLM_FULL, m, 1));
    TRY(plm_model_set_dense_matrix(model, PLM_STIFFNESS, PLM_LOWER, k, 1));
    TRY(plm_model_set_double(model, "reduction_error", 0.01)); /* what the host knows of its reduction */
    /* [plm_model_set_dense_matrix] */
    /* [plm_model_add_dense_gap_rows] */
    const double row[] = {1}, k_n[] = {5000}, gap[] = {1e-5}; /* B T */
    TRY(plm_model_add_dense_gap_rows(model, 1, row, 1, k_n, gap));
    /* [plm_model_add_dense_gap_rows] */
    /* [plm_model_set_recovery] */
    TRY(plm_model_set_recovery(model, 2, whole_motion, t)); /* t must live as long as the model */
    /* [plm_model_set_recovery] */
    const double force[] = {1};
    TRY(plm_model_set_excitation(model, 1, 1, force, NULL));
    TRY(plm_model_set_rayleigh_damping(model, 0, 5e-4));
    TRY(plm_model_build(model));

    /* [plm_model_recover] */
    double hz[1], shape[1], whole_shape[2];
    TRY(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 1, hz, shape));
    TRY(plm_model_recover(model, 1, shape, 2, whole_shape)); /* on both masses */
    /* [plm_model_recover] */
    EXPECT(whole_shape[0] == 0.5 * whole_shape[1]);

    plm_branch *curve = NULL;
    double peak_hz, peak;
    TRY(plm_model_compute_response(model, 0, PLM_PEAK, 0.05, &peak_hz, &peak, NULL, &curve, NULL));
    /* [plm_model_recover_amplitude] */
    int64_t count;
    double amplitude[1000]; /* of the first mass, at every point of the curve */
    TRY(plm_model_recover_amplitude(model, curve, 0, PLM_PEAK, 0, 1000, amplitude, &count));
    /* [plm_model_recover_amplitude] */
    return 0;
}

/* A host that keeps matrices, vectors and factors to itself: tall_operation() of examples/c/tall_host.c does
 * all operations on its own arrays. */
static int behind_operations(plm_context *ctx) {
    static const double m[] = {1, 0, 0, 1}, k[] = {20000, -10000, -10000, 10000};
    static tall_host host;
    plm_model *model = NULL;
    TRY(plm_model_create(ctx, 2, &model));
    /* [plm_model_set_tall_operations] */
    host.n = 2, host.m = m, host.k = k, host.ctx = ctx;
    TRY(plm_model_set_tall_operations(model, tall_operation,
                                      &host)); /* host must live as long as the model */
    TRY(plm_model_build(model));               /* with no matrix in the library */
    /* [plm_model_set_tall_operations] */
    double hz[2];
    TRY(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 2, hz, NULL));
    EXPECT(fabs(hz[0] - 9.8363) < 1e-3); /* sqrt(1e4 (3 - sqrt 5) / 2) / 2 pi */
    return 0;
}

static int loads_and_options(plm_model *model) {
    /* [plm_model_set_preload] */
    const double pressing[] = {0, 3};
    TRY(plm_model_set_preload(model, 2, pressing));
    /* [plm_model_set_preload] */

    /* [plm_model_set_excitation] */
    const double real[] = {0, 1}, imaginary[] = {0, -0.5};
    TRY(plm_model_set_excitation(model, 1, 2, real, imaginary)); /* cos + 0.5 sin */
    TRY(plm_model_set_excitation(model, 2, 2, real, NULL));      /* and the second harmonic */
    TRY(plm_model_set_excitation(model, 2, 2, NULL, NULL));      /* which is taken back */
    /* [plm_model_set_excitation] */

    /* [plm_model_set_growing_excitation] */
    const double unbalance[] = {0, 2e-3}; /* 0.2 kg turning 10 mm off its axis: kg m, for forces in N */
    TRY(plm_model_set_growing_excitation(model, 1, 2, 2, unbalance, NULL));
    TRY(plm_model_set_growing_excitation(model, 1, 2, 2, NULL, NULL)); /* and none */
    /* [plm_model_set_growing_excitation] */

    /* [plm_model_set_base_motion] */
    const double shaken[] = {9.81, 0}; /* a DOF that is fixed shakes with 1 g */
    TRY(plm_model_set_base_motion(model, PLM_ACCELERATION, 1, 2, shaken, NULL));
    TRY(plm_model_set_base_motion(model, PLM_ACCELERATION, 1, 2, NULL, NULL)); /* here none is */
    /* [plm_model_set_base_motion] */

    /* [plm_model_set_int] [plm_model_set_double] [plm_model_set_string] */
    TRY(plm_model_set_int(model, "verify_counts", 1));
    TRY(plm_model_set_double(model, "space_tolerance", 1e-8));
    TRY(plm_model_set_string(model, "solver", "auto")); /* who factors the sparse matrices */
    /* [plm_model_set_int] [plm_model_set_double] [plm_model_set_string] */
    return 0;
}

static int memory_needed(plm_model *model) {
    /* [plm_model_estimate_memory] */
    double bytes, factor;
    TRY(plm_model_set_double(model, "memory_limit", 4096)); /* MiB: the build fails rather than take more */
    TRY(plm_model_estimate_memory(model, &bytes));
    TRY(plm_model_get_double(model, "memory_factor", &factor));
    printf("about %.1f MiB at most, %.1f of them the factor\n", bytes / 1048576, factor / 1048576);
    /* [plm_model_estimate_memory] */
    EXPECT(bytes > factor && factor > 0);
    return 0;
}

static int results(plm_model *model) {
    /* [plm_model_build] */
    const plm_status built = plm_model_build(model);
    if (built < 0) return __LINE__; /* e.g. PLM_ERR_NOT_POSITIVE_DEFINITE: see plm_context_get_error_text */
    /* [plm_model_build] */

    /* [plm_model_get_int] [plm_model_get_double] */
    int64_t free_dofs;
    double local;
    TRY(plm_model_get_int(model, "n_free", &free_dofs));
    TRY(plm_model_get_double(model, "local_stiffness", &local));
    printf("%d free DOFs, local stiffness %.4g N/m\n", (int)free_dofs, local);
    /* [plm_model_get_int] [plm_model_get_double] */

    /* [plm_model_get_string] */
    char word[40]; /* no result of a model is a text yet: PLM_ERR_KEY */
    const plm_status no_text = plm_model_get_string(model, "description", sizeof word, word, NULL);
    /* [plm_model_get_string] */
    EXPECT(no_text == PLM_ERR_KEY);

    /* [plm_model_solve_rest] [plm_model_get_array] [plm_model_get_int_array] */
    double penetration[1];
    int64_t closed[1], count;
    TRY(plm_model_solve_rest(model));
    TRY(plm_model_get_array(model, "rest_penetration", 1, penetration, &count));
    TRY(plm_model_get_int_array(model, "rest_closed", 1, closed, &count));
    printf("at rest the stop is %s, u = %.3g m\n", closed[0] ? "closed" : "open", penetration[0]);
    /* [plm_model_solve_rest] [plm_model_get_array] [plm_model_get_int_array] */

    /* [plm_model_get_modes] */
    const int32_t all_closed[] = {1};
    double hz[2], shape[2 * 2];
    TRY(plm_model_get_modes(model, PLM_SYSTEM_OPEN, NULL, 2, hz, NULL));
    TRY(plm_model_get_modes(model, PLM_SYSTEM_GIVEN, all_closed, 2, hz, shape)); /* shape: 2 x 2 */
    /* [plm_model_get_modes] */

    /* [plm_model_count_modes] */
    int64_t below;
    TRY(plm_model_count_modes(model, 1.001 * hz[0], &below)); /* 1: no mode below the first was missed */
    /* [plm_model_count_modes] */
    EXPECT(below == 1);

    /* [plm_model_audit] [plm_model_get_finding] */
    int64_t findings;
    TRY(plm_model_audit(model, &findings));
    for (int64_t k = 0; k < findings; k++) {
        int32_t severity;
        double value;
        char text[200];
        TRY(plm_model_get_finding(model, k, &severity, &value, sizeof text, text, NULL));
        if (severity > 0) printf("look at this: %s\n", text);
    }
    /* [plm_model_audit] [plm_model_get_finding] */
    EXPECT(findings > 0 && closed[0] == 1 && hz[0] > 0);
    return 0;
}

static int whole_way(plm_context *ctx) {
    plm_model *model = NULL;
    TRY(start_model(ctx, &model));
    TRY(plm_model_build(model));

    /* [plm_model_compute_response] */
    double hz, amplitude, error; /* of the peak of DOF 1, which may be wrong by one in a thousand */
    plm_branch *curve = NULL;    /* or NULL instead of &curve, and for the solver */
    TRY(plm_model_compute_response(model, 1, PLM_PEAK, 1e-3, &hz, &amplitude, &error, &curve, NULL));
    printf("peak: %.4f mm at %.3f Hz, wrong by about %.0e\n", 1e3 * amplitude, hz, error);
    /* [plm_model_compute_response] */
    EXPECT(error < 1e-3 && amplitude > 0.013 && amplitude < 0.014);
    return 0;
}

int example(plm_context *ctx) {
    plm_model *model = NULL;
    int line = matrices(ctx);
    if (!line) line = contacts(ctx);
    if (!line) line = couplings(ctx);
    if (!line) line = superelement(ctx);
    if (!line) line = behind_operations(ctx);
    if (!line) line = whole_way(ctx);
    if (line) return line;
    TRY(start_model(ctx, &model));
    line = loads_and_options(model);
    if (!line) line = memory_needed(model);
    return line ? line : results(model);
}
