/*
 * brick.c: 8-node brick with Wilson's incompatible modes 1 - xi^2, 1 - eta^2, 1 - zeta^2 in Taylor's
 * corrected form.
 *
 * The plain brick locks: in bending it answers with parasitic shear and shifts every bending frequency
 * upwards. The three extra displacement modes per direction let its faces curve; they belong to one element
 * only and are condensed out.
 */
#include "brick.h"

#include <math.h>
#include <string.h>

#include "scene.h"

enum { CORNERS = 8, FUNCTIONS = 11, DOFS = 24, ALL_DOFS = 33 }; /* functions: 8 corners + 3 incompatible */

static const double corner[CORNERS][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                          {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

int brick_material_check(const brick_material *mat) {
    /* written so that NaN fails each test */
    if (!mat || !(mat->young > 0) || !(mat->poisson > -1 && mat->poisson < 0.5) || !(mat->density > 0))
        return SCENE_ERR_ARGUMENT;
    return isfinite(mat->young) && isfinite(mat->density) ? SCENE_OK : SCENE_ERR_ARGUMENT;
}

/* Trilinear shape functions and their derivatives with respect to xi, eta, zeta. */
static void corner_functions(const double xi[3], double n[CORNERS], double dn[CORNERS][3]) {
    for (int a = 0; a < CORNERS; a++) {
        double f[3];
        for (int i = 0; i < 3; i++) f[i] = 1 + corner[a][i] * xi[i];
        n[a] = f[0] * f[1] * f[2] / 8;
        dn[a][0] = corner[a][0] * f[1] * f[2] / 8;
        dn[a][1] = f[0] * corner[a][1] * f[2] / 8;
        dn[a][2] = f[0] * f[1] * corner[a][2] / 8;
    }
}

/* Determinant of jac[i][j] = dx_j / dxi_i; inv receives its inverse, so that grad_x = inv grad_xi. */
static double jacobian(const double xyz[24], double dn[CORNERS][3], double inv[3][3]) {
    double jac[3][3] = {{0}};
    for (int a = 0; a < CORNERS; a++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) jac[i][j] += dn[a][i] * xyz[3 * a + j];

    double cof[3][3];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            cof[i][j] = jac[i1][j1] * jac[i2][j2] - jac[i1][j2] * jac[i2][j1];
        }
    double det = jac[0][0] * cof[0][0] + jac[0][1] * cof[0][1] + jac[0][2] * cof[0][2];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) inv[j][i] = cof[i][j] / det;
    return det;
}

/*
 * Gradients of the incompatible modes. Taylor's correction: the Jacobian of the element's centre, scaled by
 * det0 / det, so that their integral over a distorted element vanishes and a constant stress does no work on
 * them (patch test).
 */
static void incompatible_gradients(const double xi[3], double inv0[3][3], double ratio, double g[3][3]) {
    for (int mode = 0; mode < 3; mode++)
        for (int j = 0; j < 3; j++) g[mode][j] = -2 * xi[mode] * inv0[j][mode] * ratio;
}

/* Lower triangle of k += weight B' D B, written in blocks: lambda ga gb' + mu (gb ga' + ga.gb I). */
static void add_stiffness(double g[FUNCTIONS][3], double lambda, double mu, double weight, double *k) {
    for (int a = 0; a < FUNCTIONS; a++)
        for (int b = 0; b <= a; b++) {
            double dot = g[a][0] * g[b][0] + g[a][1] * g[b][1] + g[a][2] * g[b][2];
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    k[(3 * a + i) * ALL_DOFS + 3 * b + j] +=
                        weight * (lambda * g[a][i] * g[b][j] + mu * (g[a][j] * g[b][i] + (i == j ? dot : 0)));
        }
}

/* Eliminates DOFs 24..32 from the lower triangle; their block is positive definite, so no pivoting is needed.
 */
static void condense(double *k) {
    for (int p = ALL_DOFS - 1; p >= DOFS; p--)
        for (int i = 0; i < p; i++) {
            double factor = k[p * ALL_DOFS + i] / k[p * ALL_DOFS + p];
            for (int j = 0; j <= i; j++) k[i * ALL_DOFS + j] -= factor * k[p * ALL_DOFS + j];
        }
}

int brick_matrices(const double xyz[24], const brick_material *mat, double k[24 * 24], double m[8 * 8]) {
    const double lambda = mat->young * mat->poisson / ((1 + mat->poisson) * (1 - 2 * mat->poisson));
    const double mu = mat->young / (2 * (1 + mat->poisson));
    const double centre[3] = {0, 0, 0};
    double n[CORNERS], dn[CORNERS][3], inv[3][3], inv0[3][3], all[ALL_DOFS * ALL_DOFS] = {0};

    corner_functions(centre, n, dn);
    const double det0 = jacobian(xyz, dn, inv0);
    if (!(det0 > 0)) return SCENE_ERR_ELEMENT;

    memset(m, 0, 8 * 8 * sizeof *m);
    for (int point = 0; point < 8;
         point++) { /* 2 x 2 x 2 Gauss, all weights one: exact for this mass up to distortion */
        double xi[3], g[FUNCTIONS][3] = {{0}};
        for (int i = 0; i < 3; i++) xi[i] = corner[point][i] / sqrt(3.0);
        corner_functions(xi, n, dn);
        const double det = jacobian(xyz, dn, inv);
        if (!(det > 0)) return SCENE_ERR_ELEMENT;

        for (int a = 0; a < CORNERS; a++)
            for (int j = 0; j < 3; j++)
                for (int i = 0; i < 3; i++) g[a][j] += inv[j][i] * dn[a][i];
        incompatible_gradients(xi, inv0, det0 / det, g + CORNERS);
        add_stiffness(g, lambda, mu, det, all);
        for (int a = 0; a < CORNERS; a++)
            for (int b = 0; b < CORNERS; b++) m[a * CORNERS + b] += mat->density * det * (n[a] * n[b]);
    }

    condense(all);
    for (int i = 0; i < DOFS; i++)
        for (int j = 0; j <= i; j++) k[i * DOFS + j] = k[j * DOFS + i] = all[i * ALL_DOFS + j];
    return SCENE_OK;
}
