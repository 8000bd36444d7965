// Loops over many small problems of one shape run several of them side by side, one in each lane of the
// processor's vectors. The same source is compiled twice: for any processor, and for those with vectors of
// 256 bit, for which the loop asks at run time.
#pragma once
#include <cstdint>

namespace plm {

#define PLM_IN_LANES inline __attribute__((always_inline))
/// The compilation for wide vectors, to be called where has_wide_lanes().
#if defined(__x86_64__)
#define PLM_WIDE_LANES __attribute__((target("avx2,fma")))
inline bool has_wide_lanes() {
    static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    return has;
}
#else
#define PLM_WIDE_LANES
inline bool has_wide_lanes() {
    return false;
}
#endif

/// More than one vector, so that one is computed while the other waits for its last result.
constexpr std::int64_t n_lanes = 8;

template <int width> struct VectorOf;
template <> struct VectorOf<2> {
    using Real = double __attribute__((vector_size(16)));
    using Bits = long long __attribute__((vector_size(16)));
};
template <> struct VectorOf<4> {
    using Real = double __attribute__((vector_size(32)));
    using Bits = long long __attribute__((vector_size(32)));
};

/// A vector anywhere in memory. Where memcpy copies one, gcc takes it through the stack in halves, and
/// reading those as one waits ten times as long as the arithmetic; a vector type that says it is not aligned
/// loses that in a template of clang's.
template <class Vector> struct __attribute__((packed, may_alias)) Unaligned { Vector v; };
template <class Vector> PLM_IN_LANES Vector load_vector(const void *p) {
    return static_cast<const Unaligned<Vector> *>(p)->v;
}
template <class Vector> PLM_IN_LANES void store_vector(Vector v, void *p) {
    static_cast<Unaligned<Vector> *>(p)->v = v;
}

/// Of each lane whether something holds; `width` lanes to a vector.
template <int width> struct LaneMask {
    static constexpr int n = n_lanes / width;
    using Vector = typename VectorOf<width>::Bits;
    Vector v[n];

    PLM_IN_LANES friend LaneMask operator&(const LaneMask &x, const LaneMask &y) {
        LaneMask r;
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] & y.v[i];
        return r;
    }
    PLM_IN_LANES friend LaneMask operator|(const LaneMask &x, const LaneMask &y) {
        LaneMask r;
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] | y.v[i];
        return r;
    }
    PLM_IN_LANES friend LaneMask operator^(const LaneMask &x, const LaneMask &y) {
        LaneMask r;
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] ^ y.v[i];
        return r;
    }
    PLM_IN_LANES LaneMask operator!() const {
        LaneMask r;
        for (int i = 0; i < n; ++i) r.v[i] = ~v[i];
        return r;
    }
    PLM_IN_LANES bool any() const {
        Vector some = v[0];
        for (int i = 1; i < n; ++i) some |= v[i];
        long long bits = some[0];
        for (int l = 1; l < width; ++l) bits |= some[l];
        return bits != 0;
    }
    PLM_IN_LANES void store(bool *out) const {
        for (int l = 0; l < n_lanes; ++l) out[l] = v[l / width][l % width] != 0;
    }
};

/// A double in each lane.
template <int width> struct Lanes {
    static constexpr int n = n_lanes / width;
    using Vector = typename VectorOf<width>::Real;
    using Mask = LaneMask<width>;
    Vector v[n];

    PLM_IN_LANES static Lanes load(const double *p) {
        Lanes r;
        for (int i = 0; i < n; ++i) r.v[i] = load_vector<Vector>(p + i * width);
        return r;
    }
    PLM_IN_LANES void store(double *p) const {
        for (int i = 0; i < n; ++i) store_vector(v[i], p + i * width);
    }
    PLM_IN_LANES static Lanes all(double value) {
        Lanes r;
        for (int i = 0; i < n; ++i) r.v[i] = value - Vector{};
        return r;
    }

#define PLM_LANE_OPERATOR(op)                                                                                \
    PLM_IN_LANES friend Lanes operator op(const Lanes &x, const Lanes &y) {                                  \
        Lanes r;                                                                                             \
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] op y.v[i];                                               \
        return r;                                                                                            \
    }                                                                                                        \
    PLM_IN_LANES friend Lanes operator op(double x, const Lanes &y) {                                        \
        Lanes r;                                                                                             \
        for (int i = 0; i < n; ++i) r.v[i] = x op y.v[i];                                                    \
        return r;                                                                                            \
    }
    PLM_LANE_OPERATOR(+)
    PLM_LANE_OPERATOR(-)
    PLM_LANE_OPERATOR(*)
    PLM_LANE_OPERATOR(/)
#undef PLM_LANE_OPERATOR
#define PLM_LANE_COMPARISON(op)                                                                              \
    PLM_IN_LANES friend Mask operator op(const Lanes &x, const Lanes &y) {                                   \
        Mask r;                                                                                              \
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] op y.v[i];                                               \
        return r;                                                                                            \
    }                                                                                                        \
    PLM_IN_LANES friend Mask operator op(const Lanes &x, double y) {                                         \
        Mask r;                                                                                              \
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] op y;                                                    \
        return r;                                                                                            \
    }
    PLM_LANE_COMPARISON(<)
    PLM_LANE_COMPARISON(>)
#undef PLM_LANE_COMPARISON
    PLM_IN_LANES Lanes operator-() const {
        return -1.0 * *this;
    }
    PLM_IN_LANES Lanes &operator+=(const Lanes &y) {
        return *this = *this + y;
    }
    PLM_IN_LANES Lanes &operator-=(const Lanes &y) {
        return *this = *this - y;
    }

    PLM_IN_LANES friend Lanes absolute(const Lanes &x) {
        Lanes r;
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] < 0 ? -x.v[i] : x.v[i];
        return r;
    }
    PLM_IN_LANES friend Lanes smaller(const Lanes &x, const Lanes &y) {
        Lanes r;
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] < y.v[i] ? x.v[i] : y.v[i];
        return r;
    }
    PLM_IN_LANES friend Lanes larger(const Lanes &x, const Lanes &y) {
        Lanes r;
        for (int i = 0; i < n; ++i) r.v[i] = x.v[i] < y.v[i] ? y.v[i] : x.v[i];
        return r;
    }
};

} // namespace plm
