#include "structure.hpp"
#include "keys.hpp"
#include <algorithm>

namespace scenarios {
namespace {

class Square {
  public:
    explicit Square(std::int64_t n) : n_(n), entry_(static_cast<std::size_t>(n * n), 0.0) {}
    std::int64_t size() const { return n_; }
    double &operator()(std::int64_t i, std::int64_t j) {
        return entry_[static_cast<std::size_t>(i + j * n_)];
    }
    double operator()(std::int64_t i, std::int64_t j) const {
        return entry_[static_cast<std::size_t>(i + j * n_)];
    }

  private:
    std::int64_t n_;
    std::vector<double> entry_;
};

Square chain(std::int64_t n, double k, bool grounded) {
    Square a(n);
    if (grounded) a(0, 0) = k;
    for (std::int64_t i = 0; i + 1 < n; ++i) {
        a(i, i) += k, a(i + 1, i + 1) += k;
        a(i, i + 1) -= k, a(i + 1, i) -= k;
    }
    return a;
}

// scale times the sum of `rank` random dyads.
Square dyads(Random &random, std::int64_t n, std::int64_t rank, double scale) {
    Square a(n);
    std::vector<double> g(static_cast<std::size_t>(n));
    for (std::int64_t r = 0; r < rank; ++r) {
        for (double &x : g) x = random.both_signs();
        for (std::int64_t j = 0; j < n; ++j)
            for (std::int64_t i = 0; i < n; ++i)
                a(i, j) += scale * g[static_cast<std::size_t>(i)] * g[static_cast<std::size_t>(j)];
    }
    return a;
}

template <class Value> Square diagonal(std::int64_t n, Value value) {
    Square a(n);
    for (std::int64_t i = 0; i < n; ++i) a(i, i) = value();
    return a;
}

Square drawn_stiffness(Random &random, std::int64_t n, bool tame, double scale) {
    switch (tame ? random.integer(0, 2) : random.integer(0, 8)) {
    case 0:
    case 1:
        return chain(n, scale, true);
    case 2:
        return dyads(random, n, n + 3, scale);
    case 3:
        return chain(n, scale, false);
    case 4: // rigid modes, as many as it comes
        return dyads(random, n, random.integer(0, n), scale);
    case 5: { // not symmetric, or indefinite
        Square k = chain(n, scale, true);
        k(random.integer(0, n - 1), random.integer(0, n - 1)) += scale * random.both_signs();
        return k;
    }
    case 6: { // a DOF without stiffness
        Square k = chain(n, scale, true);
        const std::int64_t lost = random.integer(0, n - 1);
        for (std::int64_t i = 0; i < n; ++i) k(lost, i) = k(i, lost) = 0;
        return k;
    }
    case 7: // springs of very different stiffness
        return diagonal(n, [&] { return scale * random.decades(-12, 12); });
    default:
        return dyads(random, n, n, -scale);
    }
}

Square drawn_mass(Random &random, std::int64_t n, bool tame, double scale) {
    switch (tame ? 0 : random.integer(0, 6)) {
    case 0:
    case 1:
        return diagonal(n, [&] { return scale * (tame ? 1 : random.decades(-1, 1)); });
    case 2:
        return dyads(random, n, n + 2, scale);
    case 3: // half of the DOFs without mass
        return diagonal(n, [&] { return random.chance(0.5) ? scale : 0; });
    case 4:
        return dyads(random, n, random.integer(0, n), scale);
    case 5: // consistent, as finite elements have it
        return chain(n, scale * random.decades(-6, 0), true);
    default:
        return diagonal(n, [&] { return scale * random.decades(-12, 12); });
    }
}

bool kept(std::int32_t part, std::int64_t i, std::int64_t j) {
    return part == PLM_FULL || (part == PLM_LOWER ? i >= j : i <= j);
}

// One of the storage forms of plm.h, with the index base and the triangle drawn; now and then a wrong entry.
void set_matrix(Witness &w, Random &random, plm_model *model, std::int32_t which, const Square &m,
                Borrowed &arrays) {
    const std::int64_t n = m.size();
    const auto storage = static_cast<std::int32_t>(random.integer(PLM_CSC, PLM_CSR)),
               part = static_cast<std::int32_t>(random.integer(PLM_FULL, PLM_UPPER)),
               base = static_cast<std::int32_t>(random.chance(0.02) ? 7 : random.integer(0, 1)),
               ownership = random.chance(0.7) ? PLM_COPY : PLM_BORROW;
    arrays.i32.emplace_back(), arrays.i32.emplace_back(), arrays.values.emplace_back();
    std::vector<std::int32_t> &a = arrays.i32[arrays.i32.size() - 2], &b = arrays.i32.back();
    std::vector<double> &value = arrays.values.back();
    if (storage != PLM_TRIPLETS) a.push_back(base);
    for (std::int64_t line = 0; line < n; ++line) {
        for (std::int64_t at = 0; at < n; ++at) {
            const std::int64_t i = storage == PLM_CSC ? at : line, j = storage == PLM_CSC ? line : at;
            if (m(i, j) == 0 || !kept(part, i, j)) continue;
            if (storage == PLM_TRIPLETS) a.push_back(static_cast<std::int32_t>(line) + base);
            b.push_back(static_cast<std::int32_t>(at) + base);
            value.push_back(m(i, j));
        }
        if (storage != PLM_TRIPLETS) a.push_back(static_cast<std::int32_t>(value.size()) + base);
    }
    const auto somewhere = [&](auto &v) -> auto & {
        return v[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(v.size()) - 1))];
    };
    if (!value.empty() && random.chance(0.02)) somewhere(value) = wild(random);
    if (!b.empty() && random.chance(0.02)) somewhere(b) = static_cast<std::int32_t>(random.integer(-3, 40));
    if (a.size() > 1 && random.chance(0.01)) somewhere(a) = static_cast<std::int32_t>(random.integer(-5, 50));
    const auto nnz = static_cast<std::int64_t>(value.size());
    if (random.chance(0.5)) {
        CALL(w, plm_model_set_matrix_i32(model, which, storage, part, base, ownership, nnz, a.data(),
                                         b.data(), value.data()));
        return;
    }
    arrays.i64.emplace_back(a.begin(), a.end()), arrays.i64.emplace_back(b.begin(), b.end());
    CALL(w, plm_model_set_matrix_i64(model, which, storage, part, base, ownership, nnz,
                                     arrays.i64[arrays.i64.size() - 2].data(), arrays.i64.back().data(),
                                     value.data()));
}

void add_gap_row(Witness &w, Random &random, plm_model *model, std::int64_t n, bool tame, double k,
                 double g) {
    std::int64_t dof[3], row[2] = {0, random.integer(1, std::min<std::int64_t>(3, n))};
    double coefficient[3];
    const std::int64_t first = random.integer(0, n - 1);
    for (std::int64_t i = 0; i < row[1]; ++i) {
        dof[i] = (first + i * std::max<std::int64_t>(1, n / 3)) % n;
        coefficient[i] = random.chance(0.1) ? 0 : (i ? -1 : 1) * (tame ? 1 : random.between(0, 3));
    }
    CALL(w, plm_model_add_gap_rows_i64(model, 0, 1, row, dof, coefficient, &k, &g));
}

void add_nodes(Witness &w, Random &random, plm_model *model, std::int64_t n, bool tame, double k, double g) {
    std::int32_t a[3], b[3];
    double normal[3] = {1, 0, 0}, length = 0;
    if (!tame)
        for (double &x : normal) x = random.both_signs();
    for (double x : normal) length = std::hypot(length, x);
    for (double &x : normal) x /= length;
    const auto dof = [&] {
        return static_cast<std::int32_t>(random.chance(0.3) ? -1 : random.integer(0, n - 1));
    };
    for (int i = 0; i < 3; ++i) a[i] = dof(), b[i] = dof();
    if (tame) a[0] = static_cast<std::int32_t>(random.integer(0, n - 1));
    if (random.chance(0.5))
        CALL(w,
             plm_model_add_node_pairs_i32(model, 0, 1, a, b, normal, &k, random.chance(0.2) ? nullptr : &g));
    else
        CALL(w, plm_model_add_ground_contacts_i32(model, 0, 1, a, normal, &k, &g));
}

void add_contact(Witness &w, Random &random, plm_model *model, std::int64_t n, bool tame, double stiffness) {
    const std::int64_t pairs = random.chance(0.1) ? 0 : random.integer(1, tame ? 4 : 20);
    for (std::int64_t p = 0; p < pairs; ++p) {
        const double k = random.chance(0.1) ? PLM_AUTO_STIFFNESS
                         : tame             ? stiffness * random.between(0, 3)
                                            : stiffness * random.decades(-5, 5),
                     sign = random.chance(0.2) ? -1 : 1,
                     g = random.chance(0.3) ? 0 : sign * random.decades(-6, tame ? -5 : 0);
        if (random.chance(0.4))
            add_gap_row(w, random, model, n, tame, k, g);
        else
            add_nodes(w, random, model, n, tame, k, g);
    }
}

void add_damping(Witness &w, Random &random, plm_model *model, std::int64_t n, bool tame, double stiffness,
                 Borrowed &arrays) {
    if (random.chance(0.1))
        set_matrix(w, random, model, PLM_DAMPING, chain(n, 1e-4 * stiffness * random.real(), true), arrays);
    if (random.chance(0.9))
        CALL(w, plm_model_set_rayleigh_damping(model, tame ? 0.5 : random.decades(-3, 3),
                                               tame ? 1e-4 : random.decades(-8, -2)));
    const double ratio[2] = {random.between(0, 0.2), 0.01};
    if (random.chance(0.15)) CALL(w, plm_model_set_modal_damping(model, random.integer(0, 2), ratio));
    if (random.chance(0.1)) CALL(w, plm_model_set_structural_damping(model, random.between(0, 0.1)));
}

void add_loads(Witness &w, Random &random, plm_model *model, std::int64_t n, bool tame, double size) {
    std::vector<double> f(static_cast<std::size_t>(n));
    if (random.chance(0.95)) {
        for (double &x : f)
            x = random.chance(0.4) ? size * random.both_signs() * (tame ? 1 : random.decades(-3, 3)) : 0;
        const std::int64_t harmonic = random.chance(0.9) ? 1 : random.integer(0, 6);
        CALL(w, plm_model_set_excitation(model, static_cast<std::int32_t>(harmonic), n, f.data(),
                                         random.chance(0.1) ? f.data() : nullptr));
    }
    if (!random.chance(0.4)) return;
    for (double &x : f) x = size * random.both_signs();
    CALL(w, plm_model_set_preload(model, n, f.data()));
}

} // namespace

void draw_structure(Witness &w, Random &random, plm_model *model, std::int64_t n, bool tame,
                    Borrowed &arrays) {
    const bool absurd = !tame && random.chance(0.15); // where squares overflow or vanish
    const double stiffness = tame     ? 1e4
                             : absurd ? random.decades(-305, 305)
                                      : random.decades(-7, 7),
                 mass = absurd ? random.decades(-305, 305) : 1,
                 force = absurd ? random.decades(-305, 305) : 1;
    set_matrix(w, random, model, PLM_STIFFNESS, drawn_stiffness(random, n, tame, stiffness), arrays);
    set_matrix(w, random, model, PLM_MASS, drawn_mass(random, n, tame, mass), arrays);
    add_damping(w, random, model, n, tame, stiffness, arrays);
    const auto fixed = static_cast<std::int32_t>(random.integer(0, n - 1));
    if (random.chance(0.3)) CALL(w, plm_model_fix_dofs_i32(model, 0, 1, &fixed));
    add_contact(w, random, model, n, tame, stiffness);
    add_loads(w, random, model, n, tame, force);
    draw_options(w, random, model_access, model, 0.1);
}

} // namespace scenarios
