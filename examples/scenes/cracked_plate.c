/* cracked_plate.c: see cracked_plate.h. */
#include "cracked_plate.h"

#include <math.h>
#include <string.h>

#include "assembly.h"
#include "scene_build.h"

/* The grid of nodes: i along x, j along y, k along z; the doubled nodes of the cracks are numbered last. */
typedef struct plate_grid {
    int64_t nx, ny, nz, crack_i, crack_j; /* the crack's doubled nodes: i = crack_i, j >= crack_j */
    int64_t n_cracks;                     /* several: at i = crack_at(c) */
} plate_grid;

static const double pi = 3.14159265358979323846;

void cracked_plate_paper(cracked_plate_params *p) {
    memset(p, 0, sizeof *p);
    p->length = 150;
    p->width = 60;
    p->thickness = 5;
    p->nx = 33;
    p->ny = 35;
    p->nz = 4;
    p->crack_position = 75;
    p->crack_rows = 18;
    p->material = (brick_material){2e5, 0.3, 7.8e-9};
    p->contact_stiffness = 3.2e4; /* about the local stiffness, 1 / median(diag(B K^-1 B')) */
    p->force = 1;
    p->quality_factor = 100;
    p->quality_frequency_hz = 1700;
    /*
     * Two oblique forces on the top edge, a quarter of the length to either side of the crack, towards each
     * other and downwards. Their thrust presses the faces together, their bending opens the mouth: the two
     * rows of pairs next to the front of the crack stay closed, 10 of 90, and the opening grows evenly
     * towards the mouth. The size gives openings at rest like those of the vibration under 1 N at the
     * resonance, about 5e-4 mm, so that every pair opens and closes there.
     */
    p->n_loads = 2;
    p->load_x[0] = 37.5;
    p->load_x[1] = 112.5;
    p->load_fx[0] = 200;
    p->load_fx[1] = -200;
    p->load_fy[0] = p->load_fy[1] = -254;
}

void cracked_plate_isolated(cracked_plate_params *p) {
    cracked_plate_paper(p);
    p->nx = 24;
    p->ny = 13;
    p->nz = 1;
    p->crack_position = 37.5;
    p->crack_rows = 7;
    p->contact_stiffness = -1;
    p->quality_factor = 500;
    p->quality_frequency_hz = 1500;
    p->with_preload = 1;
    p->n_loads = 0;
    p->end_compression = 92;
}

void cracked_plate_quick(cracked_plate_params *p) {
    cracked_plate_paper(p);
    p->nx = 12;
    p->ny = 10;
    p->nz = 2;
    p->crack_rows = 5;
    p->contact_stiffness = 4.1e4;
    p->load_fy[0] = p->load_fy[1] = -244; /* the row of pairs next to the front stays closed, 3 of 15 */
}

static int bad_mesh(const cracked_plate_params *p) {
    const int32_t most = 2000; /* bricks along a side */
    return p->nx < 2 || p->nx > most || p->ny < 2 || p->ny > most || p->nz < 1 || p->nz > most ||
           p->crack_rows < 1 || p->crack_rows >= p->ny || p->further_cracks < 0 ||
           p->further_cracks > p->nx - 2 || p->columns_before_crack < 0 || p->columns_before_crack >= p->nx ||
           !(p->length > 0) || !(p->width > 0) || !(p->thickness > 0) || !isfinite(p->length) ||
           !isfinite(p->width) || !isfinite(p->thickness) || !(p->crack_position > 0) ||
           !(p->crack_position < p->length) || brick_material_check(&p->material);
}

static int bad_loads(const cracked_plate_params *p) {
    if (p->n_loads < 0 || p->n_loads > CRACKED_PLATE_LOADS || !isfinite(p->end_compression)) return 1;
    for (int32_t l = 0; l < p->n_loads; l++)
        if (!(p->load_x[l] >= 0 && p->load_x[l] <= p->length) || !isfinite(p->load_fx[l]) ||
            !isfinite(p->load_fy[l]))
            return 1;
    return !isfinite(p->gap) || !isfinite(p->contact_stiffness) || !isfinite(p->force) ||
           !(p->quality_factor >= 0) || (p->quality_factor > 0 && !(p->quality_frequency_hz > 0));
}

static plate_grid grid_of(const cracked_plate_params *p) {
    plate_grid g = {
        p->nx, p->ny, p->nz, p->columns_before_crack, p->ny + 1 - p->crack_rows, p->further_cracks + 1};
    if (g.crack_i == 0) {
        g.crack_i = llround(p->nx * p->crack_position / p->length);
        g.crack_i = g.crack_i < 1 ? 1 : g.crack_i > p->nx - 1 ? p->nx - 1 : g.crack_i;
    }
    return g;
}

static int64_t node_at(const plate_grid *g, int64_t i, int64_t j, int64_t k) {
    return (i * (g->ny + 1) + j) * (g->nz + 1) + k;
}

/* The column of nodes of crack c, and the crack there, or -1. */
static int64_t crack_at(const plate_grid *g, int64_t c) {
    return g->n_cracks == 1 ? g->crack_i : g->nx * (c + 1) / (g->n_cracks + 1);
}

static int64_t crack_of(const plate_grid *g, int64_t i) {
    const int64_t c = g->n_cracks == 1 ? 0 : (i * (g->n_cracks + 1) + g->nx - 1) / g->nx - 1;
    return c >= 0 && c < g->n_cracks && crack_at(g, c) == i ? c : -1;
}

static int64_t pairs_of_crack(const plate_grid *g) {
    return (g->ny + 1 - g->crack_j) * (g->nz + 1);
}

static int64_t pair_at(const plate_grid *g, int64_t c, int64_t j, int64_t k) {
    return c * pairs_of_crack(g) + (j - g->crack_j) * (g->nz + 1) + k;
}

/* The node seen by the bricks beyond a crack: its twin where the plate is cut. */
static int64_t node_beyond(const plate_grid *g, int64_t i, int64_t j, int64_t k) {
    const int64_t c = j >= g->crack_j ? crack_of(g, i) : -1;
    return c < 0 ? node_at(g, i, j, k) : (g->nx + 1) * (g->ny + 1) * (g->nz + 1) + pair_at(g, c, j, k);
}

/* Each side of the crack has its own even spacing, so that a plane of nodes lies on the crack. */
static double x_of_column(const cracked_plate_params *p, const plate_grid *g, int64_t i) {
    if (g->n_cracks > 1) return p->length * (double)i / (double)g->nx;
    if (i <= g->crack_i) return p->crack_position * (double)i / (double)g->crack_i;
    return p->crack_position +
           (p->length - p->crack_position) * (double)(i - g->crack_i) / (double)(g->nx - g->crack_i);
}

static void place_nodes(const cracked_plate_params *p, const plate_grid *g, brick_mesh *mesh) {
    for (int64_t i = 0; i <= g->nx; i++)
        for (int64_t j = 0; j <= g->ny; j++)
            for (int64_t k = 0; k <= g->nz; k++) {
                const double x[3] = {x_of_column(p, g, i), p->width * (double)j / (double)g->ny,
                                     p->thickness * (double)k / (double)g->nz};
                memcpy(mesh->xyz + 3 * node_at(g, i, j, k), x, sizeof x);
                memcpy(mesh->xyz + 3 * node_beyond(g, i, j, k), x, sizeof x);
            }
}

static void place_bricks(const plate_grid *g, brick_mesh *mesh) {
    static const int step[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    int64_t at = 0;
    for (int64_t i = 0; i < g->nx; i++)
        for (int64_t j = 0; j < g->ny; j++)
            for (int64_t k = 0; k < g->nz; k++)
                for (int a = 0; a < 8; a++) {
                    const int64_t ia = i + step[a][0], ja = j + step[a][1], ka = k + step[a][2];
                    mesh->brick[at++] = ia == i ? node_beyond(g, ia, ja, ka) : node_at(g, ia, ja, ka);
                }
}

/* Adds a line load across the thickness, from first_node upwards: the end nodes carry half a share. */
static void add_line_load(const plate_grid *g, int64_t first_node, int component, double total,
                          double *load) {
    for (int64_t k = 0; k <= g->nz; k++) {
        const double share = (k == 0 || k == g->nz ? 0.5 : 1.0) / (double)g->nz;
        load[3 * (first_node + k) + component] += share * total;
    }
}

/*
 * A load between two columns of nodes is shared like the shape functions of the edge. A load exactly on the
 * crack acts on its near lip; one just beyond it is shared with the far lip.
 */
static void add_top_load(const cracked_plate_params *p, const plate_grid *g, double x, int component,
                         double total, double *load) {
    int64_t i = 0;
    while (i < g->nx - 1 && x_of_column(p, g, i + 1) < x) i++;
    const double x0 = x_of_column(p, g, i), x1 = x_of_column(p, g, i + 1), right = (x - x0) / (x1 - x0);
    add_line_load(g, node_beyond(g, i, g->ny, 0), component, (1 - right) * total, load);
    add_line_load(g, node_at(g, i + 1, g->ny, 0), component, right * total, load);
}

static void add_preload(const cracked_plate_params *p, const plate_grid *g, double *load) {
    for (int32_t l = 0; l < p->n_loads; l++) {
        add_top_load(p, g, p->load_x[l], 0, p->load_fx[l], load);
        add_top_load(p, g, p->load_x[l], 1, p->load_fy[l], load);
    }
    for (int64_t j = 0; j <= g->ny; j++) {
        const double share = (j == 0 || j == g->ny ? 0.5 : 1.0) / (double)g->ny;
        add_line_load(g, node_at(g, g->nx, j, 0), 0, -share * p->end_compression, load);
    }
}

static int fill(const cracked_plate_params *p, const plate_grid *g, const brick_mesh *mesh, scene *s) {
    const double along_x[3] = {1, 0, 0};
    int status = assemble_bricks(mesh, &p->material, s);
    if (!status)
        status = scene_allocate(s, 3 * (g->ny + 1) * (g->nz + 1), g->n_cracks * pairs_of_crack(g),
                                p->with_preload);
    if (status) return status;

    for (int64_t f = 0; f < s->n_fixed; f++) s->fixed[f] = f; /* the nodes of x = 0 come first */
    for (int64_t c = 0; c < g->n_cracks; c++)
        for (int64_t j = g->crack_j; j <= g->ny; j++)
            for (int64_t k = 0; k <= g->nz; k++)
                scene_set_pair(s, pair_at(g, c, j, k), node_at(g, crack_at(g, c), j, k),
                               node_beyond(g, crack_at(g, c), j, k), along_x, p->gap, p->contact_stiffness);

    /* One node is driven and watched; the middle of the thickness (for an even nz) leaves out-of-plane
     * bending alone. */
    s->output_dof = 3 * node_at(g, g->nx, g->ny / 2, g->nz / 2) + 1;
    s->force[s->output_dof] = p->force;
    if (p->with_preload) add_preload(p, g, s->preload);
    if (p->quality_factor > 0)
        s->stiffness_damping = 1 / (p->quality_factor * 2 * pi * p->quality_frequency_hz);
    s->dominant_system = SCENE_OPEN;
    s->dominant_mode = 4;
    return SCENE_OK;
}

int cracked_plate_create(const cracked_plate_params *p, scene **out) {
    if (!p || !out || bad_mesh(p) || bad_loads(p)) return SCENE_ERR_ARGUMENT;
    const plate_grid g = grid_of(p);
    const int64_t n_nodes = (g.nx + 1) * (g.ny + 1) * (g.nz + 1) + g.n_cracks * pairs_of_crack(&g);

    brick_mesh mesh;
    int status = brick_mesh_create(n_nodes, g.nx * g.ny * g.nz, &mesh);
    if (status) return status;
    place_nodes(p, &g, &mesh);
    place_bricks(&g, &mesh);

    scene *s = scene_new("cracked_plate");
    status = s ? fill(p, &g, &mesh, s) : SCENE_ERR_MEMORY;
    brick_mesh_free(&mesh);
    if (status)
        scene_destroy(&s);
    else
        *out = s;
    return status;
}
