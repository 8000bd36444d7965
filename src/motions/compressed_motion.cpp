#include "motions/compressed_motion.hpp"
#include "linalg/lapack.hpp"
#include "reduction/compression.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t corrected_harmonics = 24; // those above hardly move
constexpr double negligible = 1e-6;              // stiffness, of omega^2

using complex = std::complex<double>;

Matrix mean_of(const BranchPoint &p) {
    Matrix column(static_cast<std::int64_t>(p.eta_0.size()), 1);
    std::copy(p.eta_0.begin(), p.eta_0.end(), column.data());
    return column;
}

vector<double> as_vector(const Matrix &column) {
    return vector<double>(column.data(), column.data() + column.rows());
}

BranchPoint with_coordinates(const BranchPoint &p, const Matrix &mean, Matrix eta) {
    BranchPoint out;
    out.omega = p.omega;
    out.force_scale = p.force_scale;
    out.period_multiple = p.period_multiple;
    out.eta_0 = as_vector(mean);
    out.n_harmonics = eta.cols() / 2;
    out.eta = std::move(eta);
    return out;
}

// The coordinates of a compressed model that come nearest to motions of the whole one, by their energy.
class NearestCoordinates {
  public:
    NearestCoordinates(const ReducedModel &model, double omega) : weighted_(model.from->coordinates) {
        const ReducedModel &whole = *model.from->model;
        const Matrix y = weighted_;
        for (std::int64_t j = 0; j < y.cols(); ++j)
            for (std::int64_t i = 0; i < y.rows(); ++i)
                weighted_(i, j) *= whole.lambda[i] + omega * omega * whole.mass(i);
        Matrix gram = product('T', 'N', y, weighted_);
        known_ = gram_.factor(gram);
    }
    bool known() const { return known_; }
    Matrix of(const Matrix &motions) const {
        Matrix c = product('T', 'N', weighted_, motions);
        gram_.solve(c.data(), c.cols(), c.rows());
        return c;
    }

  private:
    Matrix weighted_;
    DenseCholesky gram_;
    bool known_ = false;
};

// B^T diag(spring) B.
Matrix stiffness_of(const ReducedModel &m, const vector<double> &spring) {
    Matrix weighted = m.gap;
    for (std::int64_t j = 0; j < weighted.cols(); ++j)
        for (std::int64_t i = 0; i < weighted.rows(); ++i) weighted(i, j) *= spring[i];
    return product('T', 'N', m.gap, weighted);
}

// -Omega^2 M + i Omega C + K + S at one harmonic, column by column.
vector<complex> dynamic_stiffness(const ReducedModel &m, const Matrix &springs, double omega) {
    const std::int64_t r = m.size();
    vector<complex> a(static_cast<std::size_t>(r * r));
    for (std::int64_t j = 0; j < r; ++j)
        for (std::int64_t i = 0; i < r; ++i)
            a[i + j * r] = complex(springs(i, j), m.damping.empty() ? 0.0 : omega * m.damping(i, j));
    for (std::int64_t j = 0; j < r; ++j) {
        a[j + j * r] += m.lambda[j] - omega * omega * m.mass(j);
        if (m.damping.empty()) a[j + j * r] += complex(0, omega * m.damping_diagonal[j]);
    }
    return a;
}

// Of harmonic h, as Re(x exp(i h omega t)); h = 0: the mean.
vector<complex> motion_of(const BranchPoint &p, std::int64_t h) {
    vector<complex> x(p.eta_0.begin(), p.eta_0.end());
    for (std::int64_t j = 0; h > 0 && j < p.eta.rows(); ++j)
        x[j] = {p.eta(j, 2 * h - 2), -p.eta(j, 2 * h - 1)};
    return x;
}

// The loads less the contact's forces and those of inertia, damping and stiffness. contact: on the
// coordinates, r x (2H + 1).
vector<complex> missing_force(const ReducedModel &m, const BranchPoint &p, const Matrix &contact,
                              std::int64_t h) {
    const std::int64_t r = m.size();
    const double omega = static_cast<double>(h) * p.omega;
    const vector<complex> x = motion_of(p, h);
    vector<complex> f(r);
    for (std::int64_t i = 0; i < r; ++i)
        f[i] = h == 0 ? complex(m.preload_0[i] - contact(i, 0))
                      : complex(-contact(i, 2 * h - 1), contact(i, 2 * h));
    for (const auto &[part, load] : m.excitation)
        for (std::int64_t i = 0; part.harmonic == h && i < r; ++i)
            f[i] += p.force_scale * part.growth(p.omega) *
                    complex(load.real[i], load.imag.empty() ? 0 : load.imag[i]);
    for (std::int64_t j = 0; j < r; ++j) {
        f[j] -= (m.lambda[j] - omega * omega * m.mass(j)) * x[j];
        if (m.damping.empty()) f[j] -= complex(0, omega * m.damping_diagonal[j]) * x[j];
        for (std::int64_t i = 0; i < m.damping.rows(); ++i)
            f[i] -= complex(0, omega * m.damping(i, j)) * x[j];
    }
    return f;
}

} // namespace

BranchPoint uncompressed(const ReducedModel &m, const BranchPoint &p) {
    BranchPoint q = p;
    q.motion = nullptr;
    q.eta_0 = as_vector(uncompressed(m, mean_of(p)));
    q.eta = uncompressed(m, p.eta);
    return q;
}

bool compress(const ReducedModel &model, const BranchPoint &point, BranchPoint &compressed) {
    const NearestCoordinates nearest(model, point.omega);
    if (!nearest.known()) return false;
    compressed = with_coordinates(point, nearest.of(mean_of(point)), nearest.of(point.eta));
    return true;
}

vector<double> mean_springs(const ReducedModel &m, const BranchPoint &exact) {
    vector<double> spring = m.contact.stiffness;
    const vector<double> &share = exact.motion->closed_shares();
    for (std::size_t i = 0; i < spring.size(); ++i) spring[i] *= share[i];
    return spring;
}

BranchPoint corrected_on_whole(const ReducedModel &model, const BranchPoint &exact) {
    const ReducedModel &whole = *model.from->model;
    BranchPoint p = uncompressed(model, exact);
    const std::int64_t n = std::min(p.eta.cols() / 2, corrected_harmonics), r = whole.size();
    const Matrix forces = product('T', 'N', whole.gap, exact.motion->contact_forces(n)),
                 springs = stiffness_of(whole, mean_springs(model, exact));
    ComplexLu lu;
    for (std::int64_t h = 0; h <= n; ++h) {
        vector<complex> change = missing_force(whole, p, forces, h),
                        stiffness = dynamic_stiffness(whole, springs, static_cast<double>(h) * p.omega);
        if (h == 0) // where nothing but contact holds the structure
            for (std::int64_t j = 0; j < r; ++j) stiffness[j + j * r] += negligible * p.omega * p.omega;
        lu.factor(r, stiffness);
        lu.solve(change.data(), 1, r);
        for (std::int64_t j = 0; j < r; ++j)
            if (h == 0)
                p.eta_0[j] += change[j].real();
            else
                p.eta(j, 2 * h - 2) += change[j].real(), p.eta(j, 2 * h - 1) -= change[j].imag();
    }
    return p;
}

Matrix motions_of(const BranchPoint &point) {
    Matrix columns(static_cast<std::int64_t>(point.eta_0.size()), 1);
    std::copy(point.eta_0.begin(), point.eta_0.end(), columns.data());
    columns.append(point.eta);
    return columns;
}

std::shared_ptr<const ReducedModel> compressed_with(const ReducedModel &smaller, const BranchPoint &exact,
                                                    double highest, double left_out) {
    const ReducedModel &whole = *smaller.from->model;
    Matrix motions = motions_of(exact);
    const auto energy_of = [&](const double *q) {
        double energy = 0;
        for (std::int64_t j = 0; j < whole.size(); ++j)
            energy += (whole.lambda[j] + exact.omega * exact.omega * whole.mass(j)) * q[j] * q[j];
        return energy;
    };
    double all = 0;
    for (std::int64_t k = 0; k < motions.cols(); ++k) all += energy_of(motions.col(k));
    Matrix known = smaller.from->coordinates; // orthogonal by their energy: together as much as the motion
    for (std::int64_t k = 0; k < known.cols(); ++k) {
        const double factor = std::sqrt(all / static_cast<double>(known.cols()) / energy_of(known.col(k)));
        for (std::int64_t j = 0; j < known.rows(); ++j) known(j, k) *= factor;
    }
    motions.append(known);
    return compress_beside_modes(smaller.from->model, motions, {mean_springs(whole, exact)}, exact.omega,
                                 left_out, slow_modes * highest, whole.size());
}

} // namespace plm
