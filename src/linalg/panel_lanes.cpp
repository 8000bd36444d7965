#include "linalg/panel_lanes.hpp"
#include <algorithm>

namespace plm {
namespace {

/// Columns of L at once: what belongs to them stays in registers.
constexpr int at_once = 4;
/// Rows of L that are gone through for all columns before the next ones: right-hand sides there, and a few
/// columns of L, stay in the fastest cache.
constexpr std::int64_t row_block = 256;

template <class T, int bytes> struct VectorWith;
#define PLM_VECTOR_WITH(T, bytes)                                                                            \
    template <> struct VectorWith<T, bytes> { using Real = T __attribute__((vector_size(bytes))); };
PLM_VECTOR_WITH(float, 16)
PLM_VECTOR_WITH(float, 32)
PLM_VECTOR_WITH(double, 16)
PLM_VECTOR_WITH(double, 32)
#undef PLM_VECTOR_WITH

/// A row of right-hand sides, in vectors of so many bytes.
template <class T, int bytes> struct SideBySide {
    static constexpr int n = 64 / bytes, width = bytes / sizeof(T);
    using Vector = typename VectorWith<T, bytes>::Real;
    Vector v[n];

    PLM_IN_LANES static SideBySide load(const T *p) {
        SideBySide r;
        for (int i = 0; i < n; ++i) r.v[i] = load_vector<Vector>(p + i * width);
        return r;
    }
    PLM_IN_LANES void store(T *p) const {
        for (int i = 0; i < n; ++i) store_vector(v[i], p + i * width);
    }
    PLM_IN_LANES void add(T factor, const SideBySide &x) {
        for (int i = 0; i < n; ++i) v[i] += factor * x.v[i];
    }
};

/// Everything below for one length of the processor's vectors.
template <class T, int bytes> struct Kernel {
    using Row = SideBySide<T, bytes>;
    static constexpr std::int64_t lanes = side_by_side<T>, line = 64 / sizeof(T);

    /// Of the columns that come next: their strides are too long for the processor to guess.
    template <int count> PLM_IN_LANES static void fetch(const T *l, std::int64_t ld) {
        for (int c = 0; c < count; ++c) __builtin_prefetch(l + c * ld);
    }

    /// Y += sign L X for `count` columns of L; `anew`: Y begins with them.
    template <int count>
    PLM_IN_LANES static void add_columns(std::int64_t rows, const T *l, std::int64_t ld, const T *x, T sign,
                                         bool anew, T *y) {
        Row factor[count];
        for (int c = 0; c < count; ++c) factor[c] = Row{}, factor[c].add(sign, Row::load(x + c * lanes));
        for (std::int64_t i = 0; i < rows; ++i, y += lanes) {
            if (i % line == 0) fetch<count>(l + i + count * ld, ld);
            Row sum{};
            if (!anew) sum = Row::load(y);
            for (int c = 0; c < count; ++c) sum.add(l[i + c * ld], factor[c]);
            sum.store(y);
        }
    }
    /// Y -= L^T X for `count` columns of L.
    template <int count>
    PLM_IN_LANES static void subtract_columns(std::int64_t rows, const T *l, std::int64_t ld, const T *x,
                                              T *y) {
        Row sum[count] = {};
        for (std::int64_t i = 0; i < rows; ++i) {
            if (i % line == 0) fetch<at_once>(l + i - at_once * ld, ld);
            const Row xi = Row::load(x + i * lanes);
            for (int c = 0; c < count; ++c) sum[c].add(l[i + c * ld], xi);
        }
        for (int c = 0; c < count; ++c) {
            Row to = Row::load(y + c * lanes);
            to.add(-1, sum[c]);
            to.store(y + c * lanes);
        }
    }

    PLM_IN_LANES static void multiply(std::int64_t rows, std::int64_t n, const T *l, std::int64_t ld,
                                      const LaneRows<const T> &x, T sign, bool anew, const LaneRows<T> &y) {
        for (std::int64_t first = 0; first < rows; first += row_block) {
            const std::int64_t height = std::min(row_block, rows - first);
            for (std::int64_t c = 0; c < n; c += at_once)
                for (std::int64_t g = 0; g < x.groups; ++g) {
                    const T *block = l + first + c * ld, *from = x.group(g) + c * lanes;
                    T *to = y.group(g) + first * lanes;
                    const bool begins = anew && c == 0;
                    switch (n - c) {
                    case 1:
                        add_columns<1>(height, block, ld, from, sign, begins, to);
                        break;
                    case 2:
                        add_columns<2>(height, block, ld, from, sign, begins, to);
                        break;
                    case 3:
                        add_columns<3>(height, block, ld, from, sign, begins, to);
                        break;
                    default:
                        add_columns<at_once>(height, block, ld, from, sign, begins, to);
                    }
                }
        }
    }

    PLM_IN_LANES static void subtract_transposed(std::int64_t rows, std::int64_t n, const T *l,
                                                 std::int64_t ld, const LaneRows<const T> &x,
                                                 const LaneRows<T> &y) {
        for (std::int64_t first = 0; first < rows; first += row_block) {
            const std::int64_t height = std::min(row_block, rows - first);
            for (std::int64_t c = (n - 1) / at_once * at_once; c >= 0; c -= at_once)
                for (std::int64_t g = 0; g < x.groups; ++g) {
                    const T *block = l + first + c * ld, *from = x.group(g) + first * lanes;
                    T *to = y.group(g) + c * lanes;
                    switch (n - c) {
                    case 1:
                        subtract_columns<1>(height, block, ld, from, to);
                        break;
                    case 2:
                        subtract_columns<2>(height, block, ld, from, to);
                        break;
                    case 3:
                        subtract_columns<3>(height, block, ld, from, to);
                        break;
                    default:
                        subtract_columns<at_once>(height, block, ld, from, to);
                    }
                }
        }
    }

    /// x[i] -= l(i, j) x[j] below the diagonal, for a few rows.
    PLM_IN_LANES static void solve_few(std::int64_t n, const T *l, std::int64_t ld, T *x) {
        for (std::int64_t i = 1; i < n; ++i) {
            Row to = Row::load(x + i * lanes);
            for (std::int64_t j = 0; j < i; ++j) to.add(-l[i + j * ld], Row::load(x + j * lanes));
            to.store(x + i * lanes);
        }
    }
    PLM_IN_LANES static void solve_few_transposed(std::int64_t n, const T *l, std::int64_t ld, T *x) {
        for (std::int64_t j = n - 2; j >= 0; --j) {
            Row to = Row::load(x + j * lanes);
            for (std::int64_t i = j + 1; i < n; ++i) to.add(-l[i + j * ld], Row::load(x + i * lanes));
            to.store(x + j * lanes);
        }
    }

    PLM_IN_LANES static void solve(std::int64_t n, const T *l, std::int64_t ld, const LaneRows<T> &x) {
        for (std::int64_t j = 0; j < n; j += at_once) {
            const std::int64_t width = std::min<std::int64_t>(at_once, n - j), after = j + width;
            for (std::int64_t g = 0; g < x.groups; ++g)
                solve_few(width, l + j + j * ld, ld, x.group(g) + j * lanes);
            multiply(n - after, width, l + after + j * ld, ld, x.from(j), -1, false, x.from(after));
        }
    }
    PLM_IN_LANES static void solve_transposed(std::int64_t n, const T *l, std::int64_t ld,
                                              const LaneRows<T> &x) {
        for (std::int64_t j = (n - 1) / at_once * at_once; j >= 0; j -= at_once) {
            const std::int64_t width = std::min<std::int64_t>(at_once, n - j), after = j + width;
            subtract_transposed(n - after, width, l + after + j * ld, ld, x.from(after), x.from(j));
            for (std::int64_t g = 0; g < x.groups; ++g)
                solve_few_transposed(width, l + j + j * ld, ld, x.group(g) + j * lanes);
        }
    }
};

template <class T>
PLM_WIDE_LANES void multiply_wide(std::int64_t rows, std::int64_t n, const T *l, std::int64_t ld,
                                  const LaneRows<const T> &x, T sign, bool anew, const LaneRows<T> &y) {
    Kernel<T, 32>::multiply(rows, n, l, ld, x, sign, anew, y);
}
template <class T>
PLM_WIDE_LANES void subtract_wide(std::int64_t rows, std::int64_t n, const T *l, std::int64_t ld,
                                  const LaneRows<const T> &x, const LaneRows<T> &y) {
    Kernel<T, 32>::subtract_transposed(rows, n, l, ld, x, y);
}
template <class T>
PLM_WIDE_LANES void solve_wide(std::int64_t n, const T *l, std::int64_t ld, const LaneRows<T> &x) {
    Kernel<T, 32>::solve(n, l, ld, x);
}
template <class T>
PLM_WIDE_LANES void solve_transposed_wide(std::int64_t n, const T *l, std::int64_t ld, const LaneRows<T> &x) {
    Kernel<T, 32>::solve_transposed(n, l, ld, x);
}

} // namespace

template <class T>
void solve_lower(std::int64_t n, const T *l, std::int64_t ld, const LaneRows<T> &x, bool wide) {
    wide ? solve_wide(n, l, ld, x) : Kernel<T, 16>::solve(n, l, ld, x);
}

template <class T>
void solve_lower_transposed(std::int64_t n, const T *l, std::int64_t ld, const LaneRows<T> &x, bool wide) {
    wide ? solve_transposed_wide(n, l, ld, x) : Kernel<T, 16>::solve_transposed(n, l, ld, x);
}

template <class T>
void multiply_panel(std::int64_t rows, std::int64_t n, const T *l, std::int64_t ld,
                    const LaneRows<const T> &x, T sign, bool anew, const LaneRows<T> &y, bool wide) {
    wide ? multiply_wide(rows, n, l, ld, x, sign, anew, y)
         : Kernel<T, 16>::multiply(rows, n, l, ld, x, sign, anew, y);
}

template <class T>
void subtract_panel_transposed(std::int64_t rows, std::int64_t n, const T *l, std::int64_t ld,
                               const LaneRows<const T> &x, const LaneRows<T> &y, bool wide) {
    wide ? subtract_wide(rows, n, l, ld, x, y) : Kernel<T, 16>::subtract_transposed(rows, n, l, ld, x, y);
}

#define PLM_PANELS_OF(T)                                                                                     \
    template void solve_lower(std::int64_t, const T *, std::int64_t, const LaneRows<T> &, bool);             \
    template void solve_lower_transposed(std::int64_t, const T *, std::int64_t, const LaneRows<T> &, bool);  \
    template void multiply_panel(std::int64_t, std::int64_t, const T *, std::int64_t,                        \
                                 const LaneRows<const T> &, T, bool, const LaneRows<T> &, bool);             \
    template void subtract_panel_transposed(std::int64_t, std::int64_t, const T *, std::int64_t,             \
                                            const LaneRows<const T> &, const LaneRows<T> &, bool);
PLM_PANELS_OF(float)
PLM_PANELS_OF(double)
#undef PLM_PANELS_OF

} // namespace plm
