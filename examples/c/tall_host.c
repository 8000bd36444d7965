#include "tall_host.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static int is_held(const tall_host *h, const char *more, int64_t i) {
    return (h->held && h->held[i]) || (more && more[i]);
}

static tall_thing *find(tall_host *h, int64_t handle) {
    int64_t t;
    for (t = 0; t < h->n_things; ++t)
        if (h->thing[t].handle == handle) return &h->thing[t];
    return NULL;
}

/* The block with room for so many columns, made where it is not there. */
static tall_thing *grown(tall_host *h, int64_t handle, int64_t cols) {
    tall_thing *x = find(h, handle);
    double *value;
    if (!x) {
        if (h->n_things == TALL_MOST_THINGS || handle <= 0) return NULL;
        x = &h->thing[h->n_things++];
        memset(x, 0, sizeof *x);
        x->handle = handle;
    }
    if (cols <= x->cols) return x;
    value = realloc(x->value, (size_t)(h->n * cols) * sizeof *value);
    if (!value) return NULL;
    memset(value + h->n * x->cols, 0, (size_t)(h->n * (cols - x->cols)) * sizeof *value);
    x->value = value, x->cols = cols;
    return x;
}

static void drop(tall_host *h, tall_thing *x) {
    free(x->value), free(x->held);
    *x = h->thing[--h->n_things];
}

void tall_host_clear(tall_host *h) {
    while (h->n_things > 0) drop(h, &h->thing[0]);
}

/* Columns that must be there already. */
static double *columns(tall_host *h, int64_t handle, int64_t first, int64_t cols) {
    tall_thing *x = find(h, handle);
    if (!x || x->held || first < 0 || first + cols > x->cols) return h->wrong++, NULL;
    return x->value + h->n * first;
}
static double *written(tall_host *h, int64_t handle, int64_t first, int64_t cols) {
    tall_thing *x = find(h, handle);
    if (first < 0 || (x && x->held) || first > (x ? x->cols : 0)) return h->wrong++, NULL; /* a hole */
    x = grown(h, handle, first + cols);
    return x ? x->value + h->n * first : NULL;
}

static double entry(const tall_host *h, const double *f, int64_t i, int64_t j) {
    const int64_t p = i + h->n * j;
    if (is_held(h, NULL, i) || is_held(h, NULL, j)) return 0;
    return f[0] * h->m[p] + f[1] * h->k[p] + (h->c ? f[2] * h->c[p] : 0);
}

static void facts(const tall_host *h, double *out) {
    const double m[] = {1, 0, 0}, k[] = {0, 1, 0}, c[] = {0, 0, 1};
    const double *of[] = {m, k, c};
    double *ratio = malloc((size_t)h->n * sizeof *ratio);
    int64_t i, j, q, n = 0;
    out[4] = HUGE_VAL, out[6] = out[7] = -1, out[9] = h->c != NULL;
    for (i = 0; i < h->n; ++i) {
        const double mi = entry(h, m, i, i), ki = entry(h, k, i, i);
        int coupled = 0;
        for (j = 0; j < h->n; ++j) {
            coupled |= j != i && entry(h, k, i, j) != 0;
            for (q = 0; q < 3; ++q) out[10 + q] = fmax(out[10 + q], fabs(entry(h, of[q], i, j)));
        }
        if (is_held(h, NULL, i)) continue;
        out[0] += 1, out[1] += mi > 0, out[2] += mi, out[3] += ki, out[4] = fmin(out[4], ki);
        if (mi > 0 && ki > 0 && ratio) ratio[n++] = ki / mi;
        if (mi > 0 || ki > 0) continue;
        if (!coupled && out[6] < 0) out[6] = (double)i;
        if (coupled && out[8]++ == 0) out[7] = (double)i;
    }
    for (i = 1; i < n; ++i) /* the median, by insertion */
        for (j = i; j > 0 && ratio[j - 1] > ratio[j]; --j) {
            const double swap = ratio[j];
            ratio[j] = ratio[j - 1], ratio[j - 1] = swap;
        }
    out[5] = n > 0 ? ratio[n / 2] : 0;
    free(ratio);
    if (h->told[0] != 0) memcpy(out, h->told, sizeof h->told);
}

/* in (-1, 1), of a DOF, a column and a seed alone */
static double noise(int64_t i, int64_t j, int64_t seed) {
    const double x =
        sin(12.9898 * (double)(i + 1) + 78.233 * (double)(j + 1) + 37.719 * (double)(seed % 1009));
    return 2 * (43758.5453 * x - floor(43758.5453 * x)) - 1;
}

static int fill(tall_host *h, const int64_t *a, const double *f) {
    double *x = written(h, a[0], 0, a[1]);
    int64_t i, j;
    if (!x) return 1;
    for (j = 0; j < a[1]; ++j)
        for (i = 0; i < h->n; ++i)
            x[i + h->n * j] =
                is_held(h, NULL, i) ? 0 : f[0] + f[1] * sin((double)i) + f[2] * noise(i, j, a[2]);
    return 0;
}

static int copy(tall_host *h, const int64_t *a) {
    const size_t column = (size_t)h->n * sizeof(double);
    double *kept = malloc(column * (size_t)a[3]), *x;
    int64_t k;
    for (k = 0; kept && k < a[3]; ++k) {
        const double *y = columns(h, a[2], a[4 + k], 1);
        if (!y) break;
        memcpy(kept + h->n * k, y, column);
    }
    x = kept && k == a[3] ? written(h, a[0], a[1], a[3]) : NULL;
    if (x) memcpy(x, kept, column * (size_t)a[3]);
    free(kept);
    return !x;
}

static int combine(tall_host *h, const int64_t *a, const double *f, const double *s) {
    const int64_t n = h->n, cols = a[2], inner = a[5];
    double *row = malloc((size_t)(inner + 1) * sizeof *row), *x;
    const double *y;
    int64_t i, j, q;
    if (a[0] == a[3] && inner > 0 && a[1] < a[4] + inner && a[4] < a[1] + cols &&
        (f[0] != 0 || a[1] != a[4] || cols > inner))
        h->wrong++;
    x = f[0] == 0 ? written(h, a[0], a[1], cols) : columns(h, a[0], a[1], cols);
    y = inner > 0 ? columns(h, a[3], a[4], inner) : x;
    if (!row || !x || !y) return free(row), 1;
    for (i = 0; i < n; ++i) {
        for (q = 0; q < inner; ++q) row[q] = y[i + n * q]; /* x may be y */
        for (j = 0; j < cols; ++j) {
            double sum = 0;
            if (a[6] && inner > 0)
                sum = row[j] * s[j];
            else
                for (q = 0; q < inner; ++q) sum += row[q] * s[q + inner * j];
            x[i + n * j] = (f[0] == 0 ? 0 : f[0] * x[i + n * j]) + f[1] * sum;
        }
    }
    free(row);
    return 0;
}

static int gram(tall_host *h, const int64_t *a, double *out) {
    const double *x = columns(h, a[0], a[1], a[2]), *y = columns(h, a[3], a[4], a[5]);
    int64_t i, p, q;
    if (!x || !y) return 1;
    for (q = 0; q < a[5]; ++q)
        for (p = 0; p < a[2]; ++p) {
            double sum = 0;
            if (a[6] && p != q) continue;
            for (i = 0; i < h->n; ++i) {
                const double product = x[i + h->n * p] * y[i + h->n * q];
                sum += a[7] ? fabs(product) : product;
            }
            out[a[6] ? p : p + a[2] * q] = sum;
        }
    return 0;
}

/* y = A x, and |A| |x| where terms is not NULL */
static void multiply(const tall_host *h, const double *f, const double *x, double *y, double *terms) {
    int64_t i, j;
    for (i = 0; i < h->n; ++i) {
        y[i] = 0;
        if (terms) terms[i] = 0;
        for (j = 0; j < h->n; ++j) {
            const double product = entry(h, f, i, j) * x[j];
            y[i] += product;
            if (terms) terms[i] += fabs(product);
        }
    }
}

static int apply(tall_host *h, const int64_t *a, const double *f) {
    double *x = written(h, a[0], a[1], a[4]);
    const double *y = columns(h, a[2], a[3], a[4]);
    int64_t j;
    if (!x || !y || a[0] == a[2]) return 1;
    x = columns(h, a[0], a[1], a[4]);
    for (j = 0; j < a[4]; ++j) multiply(h, f, y + h->n * j, x + h->n * j, NULL);
    return 0;
}

/* L D L^T without pivoting in place of the lower triangle; DOFs that are held have a one on the diagonal. */
static void eliminate(double *a, int64_t n, const char *held, int definite, double *out) {
    double least = HUGE_VAL, most = 0;
    int64_t i, j, k;
    out[4] = -1;
    for (k = 0; k < n; ++k) {
        const double pivot = a[k + n * k];
        if (held[k]) continue;
        if (definite ? !(pivot > 0) : !(fabs(pivot) > 1e-14 * most)) {
            out[3] = definite ? 1 : 2, out[4] = (double)k;
            return;
        }
        least = fmin(least, fabs(pivot)), most = fmax(most, fabs(pivot));
        out[0] += pivot < 0;
        for (i = k + 1; i < n; ++i) {
            const double l = a[i + n * k] / pivot;
            for (j = k + 1; l != 0 && j <= i; ++j) a[i + n * j] -= l * a[j + n * k];
        }
        for (i = k + 1; i < n; ++i) a[i + n * k] /= pivot;
    }
    out[1] = least / most, out[2] = (double)(n * (n + 1) / 2);
}

static int factor(tall_host *h, const int64_t *a, const double *f, const double *value, double *out) {
    const int64_t n = h->n, n_held = a[2], n_entries = a[3], *held = a + 4, *row = held + n_held,
                  *column = row + n_entries;
    tall_thing *x = find(h, a[0]) ? NULL : grown(h, a[0], n);
    int64_t i, j, e;
    if (!x) return 1;
    x->held = calloc((size_t)n, 1);
    if (!x->held) return 1;
    for (e = 0; e < n_held; ++e) x->held[held[e]] = 1;
    for (j = 0; j < n; ++j)
        for (i = j; i < n; ++i) x->value[i + n * j] = entry(h, f, i, j);
    for (e = 0; e < n_entries; ++e) {
        if (row[e] < column[e]) h->wrong++;
        x->value[row[e] + n * column[e]] += value[e];
    }
    for (j = 0; j < n; ++j) x->held[j] = (char)is_held(h, x->held, j);
    for (j = 0; j < n; ++j)
        for (i = j; i < n; ++i)
            if (x->held[i] || x->held[j]) x->value[i + n * j] = i == j;
    eliminate(x->value, n, x->held, a[1] == 0, out);
    if (h->says_nothing && a[1] == 1) out[0] = -1;
    if (out[3] != 0 || a[1] == 1) drop(h, x);
    return 0;
}

static void solve_one(const tall_host *h, const tall_thing *f, double *x) {
    const int64_t n = h->n;
    int64_t i, j;
    for (i = 0; i < n; ++i)
        if (f->held[i]) x[i] = 0;
    for (j = 0; j < n; ++j)
        for (i = j + 1; i < n; ++i) x[i] -= f->value[i + n * j] * x[j];
    for (i = 0; i < n; ++i) x[i] /= f->value[i + n * i];
    for (j = n - 1; j >= 0; --j)
        for (i = j + 1; i < n; ++i) x[j] -= f->value[i + n * j] * x[i];
}

static int solve(tall_host *h, const int64_t *a) {
    const tall_thing *f = find(h, a[0]);
    double *x = columns(h, a[1], a[2], a[3]);
    int64_t j;
    if (!f || !f->held || !x) return 1;
    for (j = 0; j < a[3]; ++j) solve_one(h, f, x + h->n * j);
    return 0;
}

static int responses(tall_host *h, const int64_t *a, const double *value, double *out) {
    const int64_t n = h->n, s = a[4], t = s + a[3], *dof = a + 6, *column = dof + a[5];
    const double mass[] = {1, 0, 0};
    const tall_thing *f = find(h, a[0]);
    const double *y = a[3] > 0 ? columns(h, a[1], a[2], a[3]) : NULL;
    double *force, *x, *mx;
    int64_t e, i, p, q;
    if (!f || !f->held || (a[3] > 0 && !y)) return 1;
    if (h->says_nothing) return 0;
    force = calloc((size_t)(3 * n * t), sizeof *force);
    if (!force) return 1;
    x = force + n * t, mx = x + n * t;
    for (e = 0; e < a[5]; ++e)
        if (!f->held[dof[e]]) force[dof[e] + n * column[e]] += value[e];
    if (y) memcpy(force + n * s, y, (size_t)(n * a[3]) * sizeof *y);
    memcpy(x, force, (size_t)(n * t) * sizeof *x);
    for (q = 0; q < t; ++q) {
        solve_one(h, f, x + n * q);
        multiply(h, mass, x + n * q, mx + n * q, NULL);
    }
    out[0] = 1;
    for (q = 0; q < t; ++q)
        for (p = 0; p < t; ++p)
            for (i = 0; i < n; ++i) {
                out[1 + p + t * q] += force[i + n * p] * x[i + n * q];
                out[1 + t * t + p + t * q] += x[i + n * p] * mx[i + n * q];
            }
    free(force);
    return 0;
}

static int rows(tall_host *h, const int64_t *a, double *out) {
    const int64_t n = a[3] < 0 ? h->n : a[3];
    const double *x = columns(h, a[0], a[1], a[2]);
    int64_t i, j;
    if (!x) return 1;
    for (j = 0; j < a[2]; ++j)
        for (i = 0; i < n; ++i) out[i + n * j] = x[(a[3] < 0 ? i : a[4 + i]) + h->n * j];
    return 0;
}

static int set_rows(tall_host *h, const int64_t *a, const double *f, const double *in) {
    const int64_t n = a[3] < 0 ? h->n : a[3];
    double *x = columns(h, a[0], a[1], a[2]);
    int64_t i, j;
    if (!x) return 1;
    for (j = 0; j < a[2]; ++j)
        for (i = 0; i < n; ++i) {
            const int64_t dof = a[3] < 0 ? i : a[4 + i];
            double *at = &x[dof + h->n * j];
            *at = is_held(h, NULL, dof) ? 0 : (f[0] == 0 ? 0 : f[0] * *at) + in[i + n * j];
        }
    return 0;
}

static int look(tall_host *h, const int64_t *a, double *out) {
    const double *x = columns(h, a[0], a[1], a[2]);
    int64_t i, j;
    if (!x) return 1;
    out[0] = 1;
    for (i = 0; i < h->n; ++i) {
        double size = 0;
        for (j = 0; j < a[2]; ++j) size = hypot(size, x[i + h->n * j]);
        if (!isfinite(size)) out[0] = 0;
        if (size > out[1]) out[1] = size, out[2] = (double)i;
    }
    return 0;
}

static int energy(tall_host *h, const int64_t *a, const double *f, double *out) {
    const double *x = columns(h, a[0], a[1], a[2]);
    int64_t i, j, p;
    if (!x) return 1;
    for (j = 0; j < a[2]; ++j, x += h->n) {
        long double sum = 0, terms = 0; /* where long is not longer the test's tolerance still has room */
        for (p = 0; p < h->n; ++p)
            for (i = 0; i < h->n; ++i) {
                const long double term = (long double)entry(h, f, i, p) * x[i] * x[p];
                sum += term, terms += fabsl(term);
            }
        out[2 * j] = (double)sum, out[2 * j + 1] = (double)terms;
    }
    return 0;
}

static int residual(tall_host *h, const int64_t *a, double rounding, const double *lambda, double *out) {
    const double stiffness[] = {0, 1, 0};
    const double *x = columns(h, a[0], a[1], a[4]), *y = columns(h, a[2], a[3], a[4]);
    double *kx = malloc((size_t)(2 * h->n) * sizeof *kx);
    int64_t i, j;
    if (!x || !y || !kx) return free(kx), 1;
    for (j = 0; j < a[4]; ++j) {
        multiply(h, stiffness, x + h->n * j, kx, kx + h->n);
        for (i = 0; i < h->n; ++i)
            out[j] =
                hypot(out[j], fmax(0, fabs(kx[i] - lambda[j] * y[i + h->n * j]) - rounding * kx[h->n + i]));
    }
    free(kx);
    return 0;
}

static void end(tall_host *h, int32_t operation, const int64_t *a) {
    int64_t i;
    if (operation == PLM_TALL_END) {
        h->ends++;
        tall_host_clear(h);
        return;
    }
    for (i = 1; i <= a[0]; ++i) {
        tall_thing *x = find(h, a[i]);
        if (x) drop(h, x);
    }
}

int32_t tall_operation(plm_context *ctx, int32_t operation, const int64_t *a, const double *f,
                       const double *in, double *out, void *user) {
    tall_host *h = user;
    int64_t i;
    if (ctx != h->ctx || operation < 0 || operation >= TALL_OPERATIONS || h->ends > 0) return h->wrong++, 1;
    h->of[operation]++;
    if (operation == PLM_TALL_END || operation == PLM_TALL_FREE) return end(h, operation, a), 0;
    if (++h->calls == h->fail_at) return TALL_FAILURE;
    switch (operation) {
    case PLM_TALL_FACTS:
        return facts(h, out), 0;
    case PLM_TALL_FILL:
        return fill(h, a, f);
    case PLM_TALL_COPY:
        return copy(h, a);
    case PLM_TALL_COMBINE:
        return combine(h, a, f, in);
    case PLM_TALL_GRAM:
        return gram(h, a, out);
    case PLM_TALL_APPLY:
        return apply(h, a, f);
    case PLM_TALL_FACTOR:
        return factor(h, a, f, in, out);
    case PLM_TALL_SOLVE:
        return solve(h, a);
    case PLM_TALL_RESPONSES:
        return responses(h, a, in, out);
    case PLM_TALL_ROWS:
        return rows(h, a, out);
    case PLM_TALL_SET_ROWS:
        return set_rows(h, a, f, in);
    case PLM_TALL_LOOK:
        return look(h, a, out);
    case PLM_TALL_ENERGY:
        return energy(h, a, f, out);
    case PLM_TALL_RESIDUAL:
        return residual(h, a, f[0], in, out);
    default:
        for (i = 0; i < a[0]; ++i) out[i] = entry(h, f, a[1 + i], a[1 + i]);
        return 0;
    }
}
