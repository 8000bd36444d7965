/*
 * scene.h: one complete test case as a finite-element host would hold it.
 *
 * A scene is a structure (sparse M and K), its supports, its contact pairs, its static pre-load and its
 * harmonic excitation. The code in this folder is the "host": a small brick FE program without libplm.
 *
 * Units are those of the scene's author; all scenes made of bricks use mm, N, t (= N s2/mm), hence MPa, t/mm3
 * and Hz.
 */
#ifndef SCENE_H
#define SCENE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Results of every function that can fail. Outputs are untouched on failure. */
enum {
    SCENE_OK = 0,
    SCENE_ERR_ARGUMENT = -1, /* NULL pointer, or a parameter out of its range */
    SCENE_ERR_NAME = -2,     /* no scene of this name: see scene_name() */
    SCENE_ERR_SIZE = -3,     /* size is neither "paper" nor "quick" */
    SCENE_ERR_MEMORY = -4,
    SCENE_ERR_ELEMENT = -5 /* a brick is turned inside out or has no volume */
};

/* A node-to-ground pair has no node b; its three entries of dof_b hold this value. */
#define SCENE_NO_DOF (-1)

enum { SCENE_OPEN = 0, SCENE_SLIDING = 1 };

/*
 * Everything the arrays hold belongs to the scene and is released by scene_destroy().
 * Indices are base 0. Equation of motion: M q" + C q' + K q = force cos(omega t) + preload - B' N,
 * with C = mass_damping M + stiffness_damping K, N = max(contact_stiffness u, 0), u = B q - gap.
 */
typedef struct scene {
    char name[64];

    int64_t n_nodes;
    double *xyz;   /* 3 n_nodes, node-major */
    int64_t n_dof; /* 3 n_nodes: dof = 3 node + component; the clamped ones are included */

    /* M and K share one pattern: CSC, both triangles stored, rows ascending in each column. */
    int64_t nnz;
    int64_t *col_ptr; /* n_dof + 1 */
    int64_t *row;     /* nnz */
    double *m, *k;    /* nnz each */

    int64_t n_fixed;
    int64_t *fixed; /* n_fixed clamped DOFs, ascending */

    /* Pair p joins a node of body a to a node of body b (or to the ground, SCENE_NO_DOF). */
    int64_t n_pairs;
    int64_t *dof_a, *dof_b;    /* 3 n_pairs each: the x, y, z DOFs of the two nodes */
    double *normal;            /* 3 n_pairs: unit normal out of body a, towards b */
    double *gap;               /* n_pairs: penetration = normal.(q_a - q_b) - gap */
    double *contact_stiffness; /* n_pairs; negative: let the library choose (10 x the local stiffness) */

    double *preload;    /* n_dof static forces, or NULL when the scene has none */
    double *force;      /* n_dof: real amplitude of harmonic 1 */
    int64_t output_dof; /* the DOF whose response is watched (also the driven DOF of every scene here) */

    double stiffness_damping; /* beta in C = alpha M + beta K, in s */
    double mass_damping;      /* alpha in 1/s; 0 for all scenes made of bricks */

    /* The mode that dominates the response, known for the scene's default parameters. */
    int32_t dominant_system; /* SCENE_OPEN or SCENE_SLIDING */
    int32_t dominant_mode;   /* 1-based number in that system */
} scene;

/* The names scene_create() understands: index 0 .. scene_count() - 1; NULL outside. */
int scene_count(void);
const char *scene_name(int index);

/*
 * Builds the scene `name` with its default parameters at `size`, "paper" (the size of the published case) or
 * "quick" (seconds in a test); with_preload != 0 adds the static load. *out receives a new scene: release
 * with scene_destroy().
 */
int scene_create(const char *name, const char *size, int with_preload, scene **out);

/* Releases the scene and nulls the pointer; accepts NULL and a pointer to NULL. */
void scene_destroy(scene **s);

/* A sentence for a result code; never NULL; static storage. */
const char *scene_error_text(int code);

#ifdef __cplusplus
}
#endif

#endif
