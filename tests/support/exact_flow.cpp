#include "exact_flow.hpp"
#include <algorithm>
#include <cmath>
#include <map>

namespace exact {
namespace {

using Vec = std::vector<double>;

struct Square { // row-major
    int n;
    Vec a;
    explicit Square(int n_) : n(n_), a(static_cast<std::size_t>(n_) * n_, 0.0) {}
    double &operator()(int i, int j) { return a[static_cast<std::size_t>(i) * n + j]; }
    double operator()(int i, int j) const { return a[static_cast<std::size_t>(i) * n + j]; }
};

Square identity(int n) {
    Square s(n);
    for (int i = 0; i < n; ++i) s(i, i) = 1;
    return s;
}

Square multiply(const Square &x, const Square &y) {
    Square r(x.n);
    for (int i = 0; i < x.n; ++i)
        for (int k = 0; k < x.n; ++k)
            for (int j = 0; j < x.n; ++j) r(i, j) += x(i, k) * y(k, j);
    return r;
}

Vec multiply(const Square &x, const Vec &v) {
    Vec r(v.size(), 0.0);
    for (int i = 0; i < x.n; ++i)
        for (int j = 0; j < x.n; ++j) r[i] += x(i, j) * v[j];
    return r;
}

// Scaling and squaring with a Taylor series: the scaled norm is below 1/4, so 18 terms reach rounding.
Square exponential(const Square &a, double t) {
    double norm = 0;
    for (int i = 0; i < a.n; ++i) {
        double row = 0;
        for (int j = 0; j < a.n; ++j) row += std::abs(a(i, j) * t);
        norm = std::max(norm, row);
    }
    int squarings = 0;
    while (norm > 0.25) norm /= 2, ++squarings;
    Square x = a;
    for (double &v : x.a) v *= t / std::ldexp(1.0, squarings);
    Square sum = identity(a.n), term = identity(a.n);
    for (int k = 1; k <= 18; ++k) {
        term = multiply(term, x);
        for (double &v : term.a) v /= k;
        for (std::size_t i = 0; i < sum.a.size(); ++i) sum.a[i] += term.a[i];
    }
    for (int k = 0; k < squarings; ++k) sum = multiply(sum, sum);
    return sum;
}

Vec solve(Square a, Vec b) { // Gauss with partial pivoting
    const int n = a.n;
    for (int k = 0; k < n; ++k) {
        int p = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(a(i, k)) > std::abs(a(p, k))) p = i;
        for (int j = 0; j < n; ++j) std::swap(a(k, j), a(p, j));
        std::swap(b[k], b[p]);
        for (int i = k + 1; i < n; ++i) {
            const double f = a(i, k) / a(k, k);
            for (int j = k; j < n; ++j) a(i, j) -= f * a(k, j);
            b[i] -= f * b[k];
        }
    }
    for (int i = n - 1; i >= 0; --i) {
        for (int j = i + 1; j < n; ++j) b[i] -= a(i, j) * b[j];
        b[i] /= a(i, i);
    }
    return b;
}

// State: q, q', cos wt, sin wt, 1.
class Flow {
  public:
    Flow(const Structure &s, double omega) : s_(s), omega_(omega), dim_(2 * s.n + 3) {}

    Vec initial(const Vec &start) const {
        Vec y(start);
        y.push_back(1), y.push_back(0), y.push_back(1);
        return y;
    }

    std::vector<bool> contact(const Vec &y) const {
        std::vector<bool> set(s_.z);
        for (int p = 0; p < s_.z; ++p) set[p] = penetration(y, p) > 0;
        return set;
    }

    double penetration(const Vec &y, int p) const {
        double u = -s_.gap[p];
        for (int j = 0; j < s_.n; ++j) u += s_.gap_rows[p * s_.n + j] * y[j];
        return u;
    }

    // Advances y by dt across any number of events; multiplies `tangent` (if any) by the exact transition.
    void advance(Vec &y, double dt, Square *tangent) {
        double left = dt;
        for (int events = 0; left > 0 && events < 1000; ++events) {
            std::vector<bool> set = contact_ahead(y);
            const Square &full = transition(set, dt);
            Square partial(1);
            const Square *step = &full;
            if (left != dt) {
                partial = exponential(generator(set), left);
                step = &partial;
            }
            Vec end = multiply(*step, y);
            if (consistent(end, set)) {
                y = end;
                if (tangent) *tangent = multiply(*step, *tangent);
                return;
            }
            double low = 0, high = left; // first inconsistency by bisection on exact flows
            const Square g = generator(set);
            for (int k = 0; k < 60 && high - low > 1e-15 * dt; ++k) {
                const double middle = 0.5 * (low + high);
                (consistent(multiply(exponential(g, middle), y), set) ? low : high) = middle;
            }
            const Square jump = exponential(g, high);
            y = multiply(jump, y);
            if (tangent) *tangent = multiply(jump, *tangent);
            left -= high;
        }
    }

    double omega() const { return omega_; }
    int dim() const { return dim_; }
    /// Bound of the frequencies with every pair closed, by rows (Gershgorin).
    double fastest() const {
        double largest = 0;
        for (int i = 0; i < s_.n; ++i) {
            double row = 0;
            for (int j = 0; j < s_.n; ++j) {
                row += std::abs(s_.stiffness[i * s_.n + j]);
                for (int p = 0; p < s_.z; ++p)
                    row += s_.contact_stiffness[p] *
                           std::abs(s_.gap_rows[p * s_.n + i] * s_.gap_rows[p * s_.n + j]);
            }
            largest = std::max(largest, row / s_.mass[i]);
        }
        return std::sqrt(largest);
    }

  private:
    // Contact set valid just after y: a pair at u = 0 takes the side it moves to.
    std::vector<bool> contact_ahead(const Vec &y) const {
        std::vector<bool> set(s_.z);
        for (int p = 0; p < s_.z; ++p) {
            const double u = penetration(y, p);
            double v = 0, size = std::abs(s_.gap[p]);
            for (int j = 0; j < s_.n; ++j) {
                v += s_.gap_rows[p * s_.n + j] * y[s_.n + j];
                size += std::abs(s_.gap_rows[p * s_.n + j] * y[j]);
            }
            set[p] = std::abs(u) < 1e-13 * size ? v > 0 : u > 0;
        }
        return set;
    }
    bool consistent(const Vec &y, const std::vector<bool> &set) const {
        for (int p = 0; p < s_.z; ++p)
            if ((penetration(y, p) > 0) != set[p]) return false;
        return true;
    }

    Square generator(const std::vector<bool> &set) const {
        const int n = s_.n;
        Square g(dim_);
        for (int i = 0; i < n; ++i) {
            g(i, n + i) = 1;
            for (int j = 0; j < n; ++j) {
                double k = s_.stiffness[i * n + j];
                for (int p = 0; p < s_.z; ++p)
                    if (set[p])
                        k += s_.contact_stiffness[p] * s_.gap_rows[p * n + i] * s_.gap_rows[p * n + j];
                g(n + i, j) = -k / s_.mass[i];
                g(n + i, n + j) = -s_.damping[i * n + j] / s_.mass[i];
            }
            g(n + i, 2 * n) = s_.force[i] / s_.mass[i];
            double constant = s_.preload.empty() ? 0.0 : s_.preload[i];
            for (int p = 0; p < s_.z; ++p)
                if (set[p]) constant += s_.contact_stiffness[p] * s_.gap_rows[p * n + i] * s_.gap[p];
            g(n + i, 2 * n + 2) = constant / s_.mass[i];
        }
        g(2 * n, 2 * n + 1) = -omega_;
        g(2 * n + 1, 2 * n) = omega_;
        return g;
    }

    const Square &transition(const std::vector<bool> &set, double dt) {
        auto found = cache_.find(set);
        if (found == cache_.end() || cached_dt_ != dt) {
            if (cached_dt_ != dt) cache_.clear();
            cached_dt_ = dt;
            found = cache_.emplace(set, exponential(generator(set), dt)).first;
        }
        return found->second;
    }

    const Structure &s_;
    double omega_;
    int dim_;
    std::map<std::vector<bool>, Square> cache_;
    double cached_dt_ = 0;
};

// n_steps of equal length, each in parts of a quarter of the shortest impact: none may begin and end between
// two looks at the pairs.
Vec one_period(Flow &flow, const Vec &start, int n_steps, Square *tangent, std::vector<Vec> *samples) {
    Vec y = flow.initial(start);
    const double step = 2 * M_PI / flow.omega() / n_steps;
    const int parts =
        static_cast<int>(std::min(1e3, std::max(1.0, std::ceil(step * flow.fastest() * 4 / M_PI))));
    for (int i = 0; i < n_steps; ++i) {
        if (samples) samples->push_back(Vec(y.begin(), y.begin() + static_cast<long>(start.size() / 2)));
        for (int k = 0; k < parts; ++k) flow.advance(y, step / parts, tangent);
    }
    y.resize(start.size());
    return y;
}

} // namespace

double Orbit::peak(int dof) const {
    double best = 0;
    const int n = static_cast<int>(samples.size());
    for (int i = 0; i < n; ++i) {
        const double a = samples[(i + n - 1) % n][dof], b = samples[i][dof], c = samples[(i + 1) % n][dof];
        double value = std::abs(b);
        const double bend = a - 2 * b + c;
        if ((b - a) * (c - b) <= 0 && bend != 0) value = std::abs(b - (c - a) * (c - a) / (8 * bend));
        best = std::max(best, value);
    }
    return best;
}

std::vector<double> period_map(const Structure &s, double omega, const std::vector<double> &start,
                               std::vector<double> *monodromy, int n_steps) {
    Flow flow(s, omega);
    Square tangent = identity(flow.dim());
    const Vec end = one_period(flow, start, n_steps, monodromy ? &tangent : nullptr, nullptr);
    if (monodromy) {
        monodromy->clear();
        for (int i = 0; i < 2 * s.n; ++i)
            for (int j = 0; j < 2 * s.n; ++j) monodromy->push_back(tangent(i, j));
    }
    return end;
}

namespace {

// Of the end from the start, displacements and velocities over omega; `size`: of the start.
double defect_of(const Vec &end, const Vec &start, int n, double omega, double &size) {
    double defect = 0;
    size = 0;
    for (int i = 0; i < 2 * n; ++i) {
        const double scale = i < n ? 1 : omega;
        defect = std::max(defect, std::abs(end[i] - start[i]) / scale);
        size = std::max(size, std::abs(start[i]) / scale);
    }
    return defect;
}

} // namespace

Orbit periodic_orbit(const Structure &s, double omega, std::vector<double> guess, int transient_periods,
                     int n_samples) {
    Flow flow(s, omega);
    const int d = 2 * s.n, steps = n_samples;
    if (guess.empty()) guess.assign(d, 0.0);
    for (int k = 0; k < transient_periods; ++k) guess = one_period(flow, guess, steps, nullptr, nullptr);
    Orbit orbit;
    double size = 0;
    for (int k = 0; k < 25; ++k) {
        Square tangent = identity(flow.dim());
        const Vec end = one_period(flow, guess, steps, &tangent, nullptr);
        Square a(d);
        Vec b(d);
        const double defect = defect_of(end, guess, s.n, omega, size);
        for (int i = 0; i < d; ++i) {
            b[i] = end[i] - guess[i];
            for (int j = 0; j < d; ++j) a(i, j) = (i == j ? 1.0 : 0.0) - tangent(i, j);
        }
        const Vec step = solve(a, b);
        const bool last =
            defect < 1e-10 * size; // before the last step; stiff damping leaves rounding of 1e-11
        // To the orbit nearby, not to any; at a fold the last step, of rounding alone, would lead anywhere.
        Vec next;
        bool closer = false;
        for (double factor = 1; factor > (last ? 0.9 : 0.05) && !closer; factor *= 0.5) {
            next = guess;
            for (int i = 0; i < d; ++i) next[i] += factor * step[i];
            double ignored;
            closer = defect_of(one_period(flow, next, steps, nullptr, nullptr), next, s.n, omega, ignored) <
                     defect;
        }
        if (closer || !last) guess = next;
        if (last) {
            orbit.converged = true;
            break;
        }
    }
    orbit.start = guess;
    one_period(flow, guess, steps, nullptr, &orbit.samples);
    return orbit;
}

} // namespace exact
