/*
 * assembly.c: from bricks to sparse matrices.
 *
 * The pattern is found on the graph of nodes, nine times smaller than that of the DOFs: two nodes are coupled
 * when they share a brick, and each coupled pair of nodes is a dense 3 x 3 block. M has the pattern of K,
 * with zeros off the blocks' diagonals.
 */
#include "assembly.h"

#include <stdlib.h>
#include <string.h>

/* Lists of int64 hung on nodes: entries of node n are item[start[n]] .. item[start[n + 1] - 1]. */
typedef struct node_lists {
    int64_t *start; /* n_nodes + 1 */
    int64_t *item;
} node_lists;

static void node_lists_free(node_lists *lists) {
    free(lists->start);
    free(lists->item);
    lists->start = lists->item = NULL;
}

int brick_mesh_create(int64_t n_nodes, int64_t n_bricks, brick_mesh *mesh) {
    const int64_t limit = INT64_C(100000000); /* far above use, far below the overflow of any product here */
    if (!mesh || n_nodes < 1 || n_bricks < 1 || n_nodes > limit || n_bricks > limit)
        return SCENE_ERR_ARGUMENT;
    brick_mesh made = {n_nodes, NULL, n_bricks, NULL};
    made.xyz = calloc((size_t)(3 * n_nodes), sizeof *made.xyz);
    made.brick = calloc((size_t)(8 * n_bricks), sizeof *made.brick);
    if (!made.xyz || !made.brick) {
        brick_mesh_free(&made);
        return SCENE_ERR_MEMORY;
    }
    *mesh = made;
    return SCENE_OK;
}

void brick_mesh_free(brick_mesh *mesh) {
    if (!mesh) return;
    free(mesh->xyz);
    free(mesh->brick);
    memset(mesh, 0, sizeof *mesh);
}

/* The bricks around each node, by counting sort. */
static int bricks_of_nodes(const brick_mesh *mesh, node_lists *around) {
    const int64_t n_entries = 8 * mesh->n_bricks;
    around->start = calloc((size_t)(mesh->n_nodes + 2), sizeof *around->start);
    around->item = malloc((size_t)n_entries * sizeof *around->item);
    if (!around->start || !around->item) return SCENE_ERR_MEMORY;

    /* counted two places up, so that filling leaves start[n] where it belongs */
    int64_t *next = around->start + 1;
    for (int64_t e = 0; e < n_entries; e++) next[mesh->brick[e] + 1]++;
    for (int64_t n = 0; n < mesh->n_nodes; n++) next[n + 1] += next[n];
    for (int64_t e = 0; e < n_entries; e++) around->item[next[mesh->brick[e]]++] = e / 8;
    return SCENE_OK;
}

static int ascending(const void *left, const void *right) {
    const int64_t a = *(const int64_t *)left, b = *(const int64_t *)right;
    return (a > b) - (a < b);
}

/* Collects the nodes coupled to `node`, each once; seen[] holds the last node that met each one. Returns
 * their number. */
static int64_t collect_neighbours(const brick_mesh *mesh, const node_lists *around, int64_t node,
                                  int64_t *seen, int64_t *found) {
    int64_t count = 0;
    for (int64_t at = around->start[node]; at < around->start[node + 1]; at++)
        for (int a = 0; a < 8; a++) {
            const int64_t other = mesh->brick[8 * around->item[at] + a];
            if (seen[other] == node) continue;
            seen[other] = node;
            found[count++] = other;
        }
    return count;
}

/* The nodes coupled to each node (itself included), ascending. */
static int neighbours_of_nodes(const brick_mesh *mesh, const node_lists *around, node_lists *coupled) {
    int64_t most = 0;
    for (int64_t n = 0; n < mesh->n_nodes; n++) {
        const int64_t bricks = around->start[n + 1] - around->start[n];
        most +=
            8 *
            bricks; /* every corner counted as often as it is met: an upper bound, twice the need at most */
    }
    int64_t *seen = malloc((size_t)mesh->n_nodes * sizeof *seen);
    coupled->start = malloc((size_t)(mesh->n_nodes + 1) * sizeof *coupled->start);
    coupled->item = malloc((size_t)most * sizeof *coupled->item);
    if (!seen || !coupled->start || !coupled->item) {
        free(seen);
        return SCENE_ERR_MEMORY;
    }

    for (int64_t n = 0; n < mesh->n_nodes; n++) seen[n] = -1;
    coupled->start[0] = 0;
    for (int64_t n = 0; n < mesh->n_nodes; n++) {
        int64_t *mine = coupled->item + coupled->start[n];
        const int64_t count = collect_neighbours(mesh, around, n, seen, mine);
        qsort(mine, (size_t)count, sizeof *mine, ascending);
        coupled->start[n + 1] = coupled->start[n] + count;
    }
    free(seen);
    return SCENE_OK;
}

/* Expands the graph of nodes into the CSC pattern of the DOFs: column 3n + c starts at 9 start[n] + 3 c
 * degree(n). */
static int make_pattern(const node_lists *coupled, scene *s) {
    s->nnz = 9 * coupled->start[s->n_nodes];
    s->col_ptr = malloc((size_t)(s->n_dof + 1) * sizeof *s->col_ptr);
    s->row = malloc((size_t)s->nnz * sizeof *s->row);
    s->m = calloc((size_t)s->nnz, sizeof *s->m);
    s->k = calloc((size_t)s->nnz, sizeof *s->k);
    if (!s->col_ptr || !s->row || !s->m || !s->k) return SCENE_ERR_MEMORY;

    int64_t at = 0;
    for (int64_t n = 0; n < s->n_nodes; n++)
        for (int c = 0; c < 3; c++) {
            s->col_ptr[3 * n + c] = at;
            for (int64_t e = coupled->start[n]; e < coupled->start[n + 1]; e++)
                for (int i = 0; i < 3; i++) s->row[at++] = 3 * coupled->item[e] + i;
        }
    s->col_ptr[s->n_dof] = at;
    return SCENE_OK;
}

/* Position of `other` among the nodes coupled to `node` (it is there: both are corners of one brick). */
static int64_t place_of(const node_lists *coupled, int64_t node, int64_t other) {
    int64_t low = coupled->start[node], high = coupled->start[node + 1] - 1;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (coupled->item[middle] < other)
            low = middle + 1;
        else
            high = middle;
    }
    return low - coupled->start[node];
}

static void scatter(const int64_t nodes[8], const double *ke, const double *me, const node_lists *coupled,
                    scene *s) {
    for (int b = 0; b < 8; b++)
        for (int a = 0; a < 8; a++) {
            const int64_t block = 3 * place_of(coupled, nodes[b], nodes[a]);
            for (int c = 0; c < 3; c++) {
                const int64_t at = s->col_ptr[3 * nodes[b] + c] + block;
                for (int i = 0; i < 3; i++) s->k[at + i] += ke[(3 * a + i) * 24 + 3 * b + c];
                s->m[at + c] += me[8 * a + b];
            }
        }
}

static int add_bricks(const brick_mesh *mesh, const brick_material *material, const node_lists *coupled,
                      scene *s) {
    double xyz[24], ke[24 * 24], me[8 * 8];
    for (int64_t e = 0; e < mesh->n_bricks; e++) {
        const int64_t *nodes = mesh->brick + 8 * e;
        for (int a = 0; a < 8; a++) memcpy(xyz + 3 * a, mesh->xyz + 3 * nodes[a], 3 * sizeof *xyz);
        const int status = brick_matrices(xyz, material, ke, me);
        if (status) return status;
        scatter(nodes, ke, me, coupled, s);
    }
    return SCENE_OK;
}

static int bad_node_number(const brick_mesh *mesh) {
    for (int64_t e = 0; e < 8 * mesh->n_bricks; e++)
        if (mesh->brick[e] < 0 || mesh->brick[e] >= mesh->n_nodes) return 1;
    return 0;
}

int assemble_bricks(const brick_mesh *mesh, const brick_material *material, scene *s) {
    if (!mesh || !mesh->xyz || !mesh->brick || !s || brick_material_check(material) || bad_node_number(mesh))
        return SCENE_ERR_ARGUMENT;
    s->n_nodes = mesh->n_nodes;
    s->n_dof = 3 * mesh->n_nodes;
    s->xyz = malloc((size_t)s->n_dof * sizeof *s->xyz);
    if (!s->xyz) return SCENE_ERR_MEMORY;
    memcpy(s->xyz, mesh->xyz, (size_t)s->n_dof * sizeof *s->xyz);

    node_lists around = {NULL, NULL}, coupled = {NULL, NULL};
    int status = bricks_of_nodes(mesh, &around);
    if (!status) status = neighbours_of_nodes(mesh, &around, &coupled);
    if (!status) status = make_pattern(&coupled, s);
    if (!status) status = add_bricks(mesh, material, &coupled, s);
    node_lists_free(&around);
    node_lists_free(&coupled);
    return status;
}
