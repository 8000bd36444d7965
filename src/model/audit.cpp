#include "model/audit.hpp"
#include "linalg/eigs.hpp"
#include <algorithm>
#include <cmath>
#include <map>

namespace plm {
namespace {

using Int = long long; // for printf

class Audit {
  public:
    explicit Audit(const Model &model) : m_(model) {}

    std::vector<Finding> run() {
        mass();
        massless_dofs();
        rigid_modes();
        conditioning();
        frequencies();
        damping();
        loads();
        if (m_.n_pairs() == 0) {
            add(0, 0, "no contact pair: the model is linear");
            return findings_;
        }
        gaps();
        repeated_rows();
        row_balance();
        contact_stiffness();
        return findings_;
    }

  private:
    void add(int severity, double value, std::string text) {
        findings_.push_back({severity, value, std::move(text)});
    }

    // Translation of all nodes: DOFs first, first + step, ... move by one. Fixed DOFs carry no mass here.
    double mass_along(std::int64_t first, std::int64_t step) const {
        vector<double> all(m_.n_dof(), 0.0), r(m_.n_free()), mr(m_.n_free());
        for (std::int64_t i = first; i < m_.n_dof(); i += step) all[i] = 1;
        m_.restrict_to_free(all.data(), r.data());
        multiply(m_.mass(), r.data(), mr.data());
        return dot(m_.n_free(), r.data(), mr.data());
    }

    void mass() {
        if (m_.n_dof() % 3 != 0) {
            const double total = mass_along(0, 1);
            add(total > 0 ? 0 : 2, total, format("mass of the free DOFs moving together: %g", total));
            return;
        }
        double smallest = INFINITY, largest = 0;
        for (int d = 0; d < 3; ++d) {
            const double total = mass_along(d, 3);
            smallest = std::min(smallest, total), largest = std::max(largest, total);
            add(0, total,
                format("mass of the free DOFs in direction %c (three DOFs per node taken): %g", "xyz"[d],
                       total));
        }
        if (largest > 0 && smallest < 0.5 * largest)
            add(1, smallest / largest,
                "the mass differs between the directions by more than half: are there three "
                "DOFs per node, in the order x, y, z?");
    }

    void massless_dofs() {
        std::int64_t count = m_.n_free();
        for (std::int64_t j = 0; j < m_.mass().cols; ++j)
            for (std::int64_t p = m_.mass().ptr[j]; p < m_.mass().ptr[j + 1]; ++p)
                if (m_.mass().idx[p] == j && m_.mass().val[p] > 0) --count;
        if (count > 0)
            add(1, static_cast<double>(count),
                format("%lld free DOFs have no mass; they follow quasi-statically", Int(count)));
    }

    void rigid_modes() {
        const std::int64_t n = m_.rigid_modes().cols();
        if (n == 0)
            add(0, 0, "no rigid-body mode: the structure is held while its contacts are open");
        else
            add(n > 6 ? 1 : 0, static_cast<double>(n),
                format("%lld rigid-body modes while the contacts are open%s", Int(n),
                       n > 6 ? ": several loose bodies, or parts that are not connected" : ""));
    }

    void conditioning() {
        const double condition = m_.factor().reciprocal_condition();
        add(condition < 1e-12 ? 1 : 0, condition,
            format("reciprocal condition of the factored %s, estimated from its pivots: %.1e%s",
                   m_.shift() > 0 ? "K + sigma M" : "stiffness", condition,
                   condition < 1e-12 ? "; very stiff or very thin elements, or penalty terms?" : ""));
    }

    void frequencies() {
        const std::int64_t rigid = m_.rigid_modes().cols();
        if (rigid >= m_.n_free()) return;
        const EigenPairs pairs =
            lowest_eigenpairs(m_.stiffness(), m_.mass(), m_.factor(), -m_.shift(), rigid + 1);
        if (static_cast<std::int64_t>(pairs.values.size()) <= rigid) return;
        const double hz = std::sqrt(std::max(0.0, pairs.values[rigid])) / (2 * M_PI);
        const bool odd = !(hz >= 1e-3 && hz <= 1e7);
        add(odd ? 2 : 0, hz,
            format("lowest elastic frequency of the open structure: %.6g Hz%s", hz,
                   odd ? "; outside 1e-3..1e7 Hz: do the units of mass and stiffness belong "
                         "together (mm-N-t or m-N-kg)?"
                       : ""));
    }

    void damping() {
        const Damping &d = m_.damping();
        const bool modal =
            std::any_of(d.modal_ratio.begin(), d.modal_ratio.end(), [](double z) { return z > 0; });
        if (d.alpha == 0 && d.beta == 0 && d.structural == 0 && !modal && !d.has_matrix)
            add(1, 0, "no damping: the response at resonance is unbounded");
    }

    void loads() {
        double preload = m_.has_preload() ? norm2(m_.n_free(), m_.preload().data()) : 0;
        add(0, preload,
            m_.has_preload() ? format("static pre-load, norm %g", preload) : "no static pre-load");
        double dynamic = 0;
        for (const auto &[harmonic, load] : m_.excitation()) {
            if (harmonic == 0) continue;
            dynamic = std::hypot(dynamic, norm2(m_.n_free(), load.real.data()));
            dynamic = std::hypot(dynamic, norm2(m_.n_free(), load.imag.data()));
        }
        if (dynamic > 0)
            add(0, dynamic, format("harmonic excitation, norm %g", dynamic));
        else
            add(1, 0, "no harmonic excitation on the free DOFs: the response is zero");
    }

    void gaps() {
        const vector<double> &g = m_.initial_gap();
        const double low = *std::min_element(g.begin(), g.end()),
                     high = *std::max_element(g.begin(), g.end());
        const auto interfering = std::count_if(g.begin(), g.end(), [](double v) { return v < 0; });
        add(0, high, format("initial gaps from %g to %g over %lld pairs", low, high, Int(m_.n_pairs())));
        if (interfering > 0)
            add(1, static_cast<double>(interfering),
                format("%lld pairs start with interference (gap < 0), down to %g; if they should be open, "
                       "the sign of the gap or the normal is reversed",
                       Int(interfering), low));
    }

    // Rows as (DOF, coefficient) lists; equal ones share a key.
    void repeated_rows() {
        const SparseMatrix rows = transpose(m_.gap_matrix());
        std::map<std::vector<std::pair<std::int64_t, double>>, std::int64_t> first;
        std::int64_t repeated = 0, one = 0, other = 0;
        for (std::int64_t i = 0; i < rows.cols; ++i) {
            std::vector<std::pair<std::int64_t, double>> row;
            for (std::int64_t p = rows.ptr[i]; p < rows.ptr[i + 1]; ++p)
                row.emplace_back(rows.idx[p], rows.val[p]);
            const auto [place, fresh] = first.emplace(std::move(row), i);
            if (fresh) continue;
            if (repeated++ == 0) one = place->second, other = i;
        }
        if (repeated > 0)
            add(2, static_cast<double>(repeated),
                format("%lld gap rows repeat an earlier one (the first: pair %lld repeats pair %lld): the "
                       "contact stiffness counts twice there",
                       Int(repeated), Int(other), Int(one)));
    }

    // A pair of nodes moved together keeps its gap: the coefficients of a row cancel, unless a side is ground
    // or fixed.
    void row_balance() {
        const SparseMatrix rows = transpose(m_.gap_matrix());
        std::int64_t unbalanced = 0, scaled = 0;
        for (std::int64_t i = 0; i < rows.cols; ++i) {
            double sum = 0, positive = 0, negative = 0;
            for (std::int64_t p = rows.ptr[i]; p < rows.ptr[i + 1]; ++p) {
                sum += rows.val[p];
                (rows.val[p] > 0 ? positive : negative) += rows.val[p] * rows.val[p];
            }
            const double side = std::sqrt(std::max(positive, negative));
            const bool two_sided = positive > 0 && negative > 0 && rows.ptr[i + 1] - rows.ptr[i] == 2;
            unbalanced += two_sided && std::abs(sum) > 1e-6 * side;
            scaled += side > 1.5 || side < 0.3;
        }
        if (unbalanced > 0)
            add(1, static_cast<double>(unbalanced),
                format("%lld two-DOF gap rows do not sum to zero: moving both nodes together changes the gap",
                       Int(unbalanced)));
        if (scaled > 0)
            add(1, static_cast<double>(scaled),
                format("%lld gap rows are far from unit length: k_n and the gap are "
                       "then not per unit of distance",
                       Int(scaled)));
    }

    void contact_stiffness() {
        const vector<double> &k = m_.contact_stiffness();
        const auto [low, high] = std::minmax_element(k.begin(), k.end());
        const double local = m_.local_stiffness();
        if (!(local > 0)) {
            add(1, 0, "the bodies are rigid at the contact: no local stiffness to compare k_n with");
            return;
        }
        const double ratio = *high / local;
        const std::string fact =
            format("contact stiffness %g to %g, that is %.3g to %.3g of the local stiffness %g", *low, *high,
                   *low / local, ratio, local);
        if (ratio > 1000)
            add(1, ratio,
                fact + "; above 1000, curves of few harmonics grow small loops: 1 to 50 is a good choice");
        else if (*low / local < 0.1)
            add(1, *low / local,
                fact + "; below 0.1 the contact is soft and bodies interpenetrate: 1 to 50 is a good choice");
        else
            add(0, ratio, fact);
    }

    const Model &m_;
    std::vector<Finding> findings_;
};

} // namespace

std::vector<Finding> audit(const Model &model) {
    return Audit(model).run();
}

} // namespace plm
