#include "reduction/lelsm.hpp"
#include "reduction/basis_kind.hpp"
#include "sampling/dominant_mode.hpp"
#include "sampling/frequency_window.hpp"
#include "sampling/mode_match.hpp"
#include "space/linear_contact.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plm {
namespace {

constexpr double settled = 1e-9; // of an eigenvalue; rounding leaves about eps lambda_i / lambda_1
constexpr int most_steps = 80;

// The family of systems with springs s k_n, 0 <= s <= 1. Its sorted eigenvalues do not decrease with s.
class EquivalentFamily {
  public:
    EquivalentFamily(const Space &space, double upper)
        : space_(space), upper_(upper), open_(modes_at(0, upper)), sliding_(sliding_modes()) {}

    std::int64_t size() const { return static_cast<std::int64_t>(open_.values.size()); }
    double open(std::int64_t i) const { return open_.values[i]; }
    double sliding(std::int64_t i) const { return sliding_.values[i]; }

    // The coupling that gives mode i the eigenvalue `target`, and the mode.
    double solve(std::int64_t i, double target, double *mode) {
        if (target <= open(i) * (1 + settled)) {
            std::copy_n(open_.vectors.col(i), space_.size(), mode);
            return 0;
        }
        double low = 0, high = 1;
        for (const Point &p : known_) narrow(p, i, target, low, high);
        double s = start(i, target, low, high);
        for (int step = 0; step < most_steps; ++step) {
            const SpaceModes modes = modes_at(s, upper_);
            known_.push_back(point(s, modes));
            const Point &p = known_.back();
            const bool found = i < p.size() && std::abs(p.value[i] - target) <= settled * target;
            narrow(p, i, target, low, high);
            if (found || high - low <= 1e-15 * high) {
                if (i >= p.size()) break;
                std::copy_n(modes.vectors.col(i), space_.size(), mode);
                return s;
            }
            s = next(p, i, target, low, high);
        }
        throw Error(status::eigensolver, format("the equivalent stiffness of mode %lld was not found",
                                                static_cast<long long>(i) + 1));
    }

  private:
    struct Point {
        double coupling = 0;
        vector<double> value, slope; // eigenvalues below the limit and their derivatives by s
        std::int64_t size() const { return static_cast<std::int64_t>(value.size()); }
    };

    SpaceModes modes_at(double coupling, double upper) const {
        vector<double> spring(space_.model->contact_stiffness());
        for (double &k : spring) k *= coupling;
        return modes_with_springs(space_.lambda, space_.n_massless, space_.gap, spring, upper);
    }

    // As many as there are open ones.
    SpaceModes sliding_modes() const {
        double upper = 4 * upper_;
        for (int attempt = 0; attempt < 3; ++attempt, upper *= 4) {
            SpaceModes modes = modes_at(1, upper);
            if (static_cast<std::int64_t>(modes.values.size()) >= size()) return modes;
        }
        return modes_at(1, std::numeric_limits<double>::infinity());
    }

    // d lambda / ds = phi' G' k G phi
    Point point(double coupling, const SpaceModes &modes) const {
        Point p{coupling, modes.values, {}};
        const Matrix u = product('N', 'N', space_.gap, modes.vectors);
        for (std::int64_t j = 0; j < u.cols(); ++j) {
            double slope = 0;
            for (std::int64_t k = 0; k < u.rows(); ++k)
                slope += space_.model->contact_stiffness()[k] * u(k, j) * u(k, j);
            p.slope.push_back(slope);
        }
        return p;
    }

    static void narrow(const Point &p, std::int64_t i, double target, double &low, double &high) {
        const double value = i < p.size() ? p.value[i] : std::numeric_limits<double>::infinity();
        if (value >= target) high = std::min(high, p.coupling);
        if (value <= target) low = std::max(low, p.coupling);
    }

    double start(std::int64_t i, double target, double low, double high) const {
        const Point *best = nullptr; // nearest eigenvalue
        for (const Point &p : known_)
            if (i < p.size() && (!best || std::abs(p.value[i] - target) < std::abs(best->value[i] - target)))
                best = &p;
        if (!best) return 0.5 * high;
        if (std::abs(best->value[i] - target) <= settled * target)
            return best->coupling; // repeated modes: one system
        return next(*best, i, target, low, high);
    }

    // Springs in series with the structure saturate: lambda ~ lambda_open + A s / (s + c), fitted to value
    // and slope.
    double next(const Point &p, std::int64_t i, double target, double low, double high) const {
        const double inside = low > 0 ? std::sqrt(low * high) : 0.1 * high;
        if (i >= p.size()) return inside;
        const double risen = p.value[i] - open(i), s = p.coupling;
        if (!(risen > 0)) return inside;
        const double rho = s * p.slope[i] / risen; // c / (s + c)
        if (!(rho > 0 && rho < 1)) return inside;
        const double c = s * rho / (1 - rho), g = (target - open(i)) / risen * (1 - rho);
        const double wanted = c * g / (1 - g);
        return g < 1 && wanted > low && wanted < high ? wanted : inside;
    }

    const Space &space_;
    double upper_;
    SpaceModes open_, sliding_;
    std::vector<Point> known_;
};

} // namespace

EquivalentModes lelsm_modes(const Space &space, const SelectionRule &rule, Watch watch) {
    EquivalentFamily family(space, rule.highest_eigenvalue());
    EquivalentModes result;
    for (std::int64_t i = 0; i < family.size(); ++i) {
        watch.step("equivalent modes", static_cast<double>(i) / static_cast<double>(family.size()));
        const double hz = bilinear_frequency(to_hz(family.open(i)), to_hz(family.sliding(i)));
        if (!rule.keeps(hz)) continue;
        Matrix column(space.size(), 1);
        const double omega = 2 * M_PI * hz;
        result.coupling.push_back(family.solve(i, omega * omega, column.data()));
        result.frequency_hz.push_back(hz);
        result.columns.append(column);
    }
    if (result.columns.cols() == 0) throw no_mode_kept(rule, "no equivalent system");
    return result;
}

namespace {

CollectedModes collect_lelsm(const ColumnSources &from, Watch watch) {
    EquivalentModes modes = lelsm_modes(from.space, from.rule, watch);
    CollectedModes collected;
    collected.columns = std::move(modes.columns);
    collected.equivalent_share = std::move(modes.coupling);
    return collected;
}

constexpr BasisKind lelsm_kind() {
    BasisKind kind("lelsm", "modes of equivalent linear systems with the bilinear frequencies");
    kind.needs_pairs = true;
    kind.collect = collect_lelsm;
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::lelsm = lelsm_kind();

} // namespace plm
