/* coaxial_cylinders.c: see coaxial_cylinders.h. */
#include "coaxial_cylinders.h"

#include <math.h>
#include <string.h>

#include "assembly.h"
#include "scene_build.h"

static const double pi = 3.14159265358979323846;

/* One cylinder's nodes: r through the wall, t around (periodic), z along the axis. */
typedef struct tube {
    int64_t first_node, around, along, through;
    double radius, wall, z0, length;
} tube;

void coaxial_cylinders_paper(coaxial_cylinders_params *p) {
    memset(p, 0, sizeof *p);
    p->contact_radius = 9;
    p->wall = 0.6;
    p->length = 55.5;
    p->n_around = 64;
    p->n_along = 60;
    p->n_wall = 2;
    p->overlap_rings = 3;
    p->support = (cylinder_support){30, 1, 0};
    p->material = (brick_material){2e5, 0.3, 7.8e-9};
    p->contact_stiffness = -1;
    p->force = 1;
    p->quality_factor = 100;
    p->quality_frequency_hz = 5050;
    p->radial_preload = 1;
}

void coaxial_cylinders_quick(coaxial_cylinders_params *p) {
    coaxial_cylinders_paper(p);
    p->n_around = 16;
    p->n_along = 12;
    p->n_wall = 1;
    p->overlap_rings = 1;
    p->support.ring = 6;
}

static int bad_params(const coaxial_cylinders_params *p) {
    const int32_t most = 4000; /* bricks along a side */
    if (p->n_around < 4 || p->n_around > most || p->n_around % 4 || p->n_along < 1 || p->n_along > most ||
        p->n_wall < 1 || p->n_wall > 100 || p->overlap_rings < 0 || p->overlap_rings > p->n_along ||
        p->support.ring < 0 || p->support.ring > p->n_along)
        return 1;
    if (!(p->contact_radius > p->wall) || !(p->wall > 0) || !(p->length > 0) ||
        !isfinite(p->contact_radius) || !isfinite(p->wall) || !isfinite(p->length) ||
        brick_material_check(&p->material))
        return 1;
    return !isfinite(p->gap) || !isfinite(p->contact_stiffness) || !isfinite(p->force) ||
           !(p->quality_factor >= 0) || (p->quality_factor > 0 && !(p->quality_frequency_hz > 0)) ||
           !isfinite(p->radial_preload);
}

static tube inner_tube(const coaxial_cylinders_params *p) {
    return (tube){0, p->n_around, p->n_along, p->n_wall, p->contact_radius - p->wall, p->wall, 0, p->length};
}

static int64_t node_count(const tube *c) {
    return c->around * (c->along + 1) * (c->through + 1);
}

static tube outer_tube(const coaxial_cylinders_params *p) {
    tube c = inner_tube(p);
    c.first_node = node_count(&c);
    c.radius = p->contact_radius;
    c.z0 = p->length * (double)(p->n_along - p->overlap_rings) / (double)p->n_along;
    return c;
}

static int64_t node_at(const tube *c, int64_t r, int64_t t, int64_t z) {
    return c->first_node + (z * c->around + t % c->around) * (c->through + 1) + r;
}

/* Direction of the angle 2 pi t / around; the four axes come out exact, and so do the mirror images. */
static void radial_direction(int64_t t, int64_t around, double direction[3]) {
    const int64_t quarter = around / 4, turns = t / quarter % 4, rest = t % quarter;
    const double angle = 2 * pi * (double)rest / (double)around;
    const double c = rest ? cos(angle) : 1, s = rest ? sin(angle) : 0;
    direction[0] = turns == 0 ? c : turns == 1 ? -s : turns == 2 ? -c : s;
    direction[1] = turns == 0 ? s : turns == 1 ? c : turns == 2 ? -s : -c;
    direction[2] = 0;
}

static void place_tube(const tube *c, int64_t first_brick, brick_mesh *mesh) {
    static const int step[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
                                   {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}; /* r, t, z is a right-handed triad */
    for (int64_t z = 0; z <= c->along; z++)
        for (int64_t t = 0; t < c->around; t++)
            for (int64_t r = 0; r <= c->through; r++) {
                double *x = mesh->xyz + 3 * node_at(c, r, t, z), direction[3];
                const double radius = c->radius + c->wall * (double)r / (double)c->through;
                radial_direction(t, c->around, direction);
                x[0] = radius * direction[0];
                x[1] = radius * direction[1];
                x[2] = c->z0 + c->length * (double)z / (double)c->along;
            }

    int64_t *brick = mesh->brick + 8 * first_brick;
    for (int64_t z = 0; z < c->along; z++)
        for (int64_t t = 0; t < c->around; t++)
            for (int64_t r = 0; r < c->through; r++)
                for (int a = 0; a < 8; a++)
                    *brick++ = node_at(c, r + step[a][0], t + step[a][1], z + step[a][2]);
}

/* The outer surface of one tube and the inner surface of the other meet in the overlap; make their nodes
 * equal to the bit. */
static void join_contact_nodes(const coaxial_cylinders_params *p, const tube *in, const tube *out,
                               brick_mesh *mesh) {
    for (int64_t z = 0; z <= p->overlap_rings; z++)
        for (int64_t t = 0; t < in->around; t++)
            memcpy(mesh->xyz + 3 * node_at(out, 0, t, z),
                   mesh->xyz + 3 * node_at(in, in->through, t, in->along - p->overlap_rings + z),
                   3 * sizeof *mesh->xyz);
}

static int is_fixed(const tube *c, int64_t clamped_z, const cylinder_support *support, int64_t t, int64_t z,
                    int component) {
    if (z == clamped_z) return 1;
    const int64_t from_clamp = z > clamped_z ? z - clamped_z : clamped_z - z;
    const int at_support = support->ring > 0 && from_clamp == support->ring && t % (c->around / 2) == 0;
    return at_support && ((support->radial && component == 0) || (support->axial && component == 2));
}

/* Walks a tube's nodes in their order; returns the number of fixed DOFs, and writes them where `fixed` is not
 * NULL. */
static int64_t list_fixed(const tube *c, int64_t clamped_z, const cylinder_support *support, int64_t *fixed) {
    int64_t count = 0;
    for (int64_t z = 0; z <= c->along; z++)
        for (int64_t t = 0; t < c->around; t++)
            for (int64_t r = 0; r <= c->through; r++)
                for (int component = 0; component < 3; component++) {
                    if (!is_fixed(c, clamped_z, support, t, z, component)) continue;
                    if (fixed) fixed[count] = 3 * node_at(c, r, t, z) + component;
                    count++;
                }
    return count;
}

static void add_pairs(const coaxial_cylinders_params *p, const tube *in, const tube *out, scene *s) {
    int64_t pair = 0;
    for (int64_t z = 0; z <= p->overlap_rings; z++)
        for (int64_t t = 0; t < in->around; t++) {
            const int64_t a = node_at(in, in->through, t, in->along - p->overlap_rings + z);
            double normal[3];
            radial_direction(t, in->around, normal);
            scene_set_pair(s, pair++, a, node_at(out, 0, t, z), normal, p->gap, p->contact_stiffness);
            for (int c = 0; c < 3 && p->with_preload; c++)
                s->preload[3 * a + c] = p->radial_preload * normal[c];
        }
}

static int fill(const coaxial_cylinders_params *p, const tube *in, const tube *out, const brick_mesh *mesh,
                scene *s) {
    const int64_t fixed_in = list_fixed(in, 0, &p->support, NULL);
    const int64_t fixed_out = list_fixed(out, out->along, &p->support, NULL);
    int status = assemble_bricks(mesh, &p->material, s);
    if (!status)
        status =
            scene_allocate(s, fixed_in + fixed_out, in->around * (p->overlap_rings + 1), p->with_preload);
    if (status) return status;

    list_fixed(in, 0, &p->support, s->fixed);
    list_fixed(out, out->along, &p->support, s->fixed + fixed_in);
    add_pairs(p, in, out, s);

    /* Point A: the outer cylinder's free edge, outer surface, at the angle pi/2, along y: the direction of
     * first bending. */
    s->output_dof = 3 * node_at(out, out->through, out->around / 4, 0) + 1;
    s->force[s->output_dof] = p->force;
    if (p->quality_factor > 0)
        s->stiffness_damping = 1 / (p->quality_factor * 2 * pi * p->quality_frequency_hz);
    s->dominant_system = SCENE_SLIDING;
    s->dominant_mode = 1;
    return SCENE_OK;
}

int coaxial_cylinders_create(const coaxial_cylinders_params *p, scene **result) {
    if (!p || !result || bad_params(p)) return SCENE_ERR_ARGUMENT;
    const tube in = inner_tube(p), out = outer_tube(p);
    const int64_t bricks_each = in.around * in.along * in.through;

    brick_mesh mesh;
    int status = brick_mesh_create(2 * node_count(&in), 2 * bricks_each, &mesh);
    if (status) return status;
    place_tube(&in, 0, &mesh);
    place_tube(&out, bricks_each, &mesh);
    join_contact_nodes(p, &in, &out, &mesh);

    scene *s = scene_new("coaxial_cylinders");
    status = s ? fill(p, &in, &out, &mesh, s) : SCENE_ERR_MEMORY;
    brick_mesh_free(&mesh);
    if (status)
        scene_destroy(&s);
    else
        *result = s;
    return status;
}
