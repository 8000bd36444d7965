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

// What the structure with springs in the place of its pairs answers at one frequency: (D + B^T S B)^-1 f with
// the dynamic stiffness D = -Omega^2 M + i Omega C + K, which is diagonal unless the damping couples the
// modes.
class HarmonicAnswer {
  public:
    HarmonicAnswer(const ReducedModel &m, const vector<double> &spring) : m_(m), spring_(spring) {
        if (!m.damping.empty()) stiffness_ = stiffness_of(m, spring);
    }

    void solve(double omega, double added, vector<complex> &f) {
        vector<complex> d(m_.size());
        for (std::int64_t j = 0; j < m_.size(); ++j)
            d[j] = complex(m_.lambda[j] - omega * omega * m_.mass(j) + added,
                           m_.damping.empty() ? omega * m_.damping_diagonal[j] : 0.0);
        m_.damping.empty() ? solve_by_forces(d, f) : solve_coupled(omega, d, f);
    }

  private:
    // By the forces p of the springs: (1 + S B D^-1 B^T) p = S B D^-1 f, f - B^T p = D x.
    void solve_by_forces(const vector<complex> &d, vector<complex> &f) {
        const std::int64_t r = m_.size(), z = m_.gap.rows();
        vector<double> real(r), imag(r);
        vector<complex> a(static_cast<std::size_t>(z * z)), p(z);
        for (std::int64_t j = 0; j < r; ++j) {
            const complex receptance = 1.0 / d[j];
            real[j] = receptance.real(), imag[j] = receptance.imag();
            for (std::int64_t k = 0; k < z; ++k) p[k] += receptance * f[j] * m_.gap(k, j);
        }
        const Matrix in_phase = gaps_by(real), lagging = gaps_by(imag);
        for (std::int64_t k = 0; k < z; ++k)
            for (std::int64_t i = 0; i < z; ++i)
                a[i + k * z] = spring_[i] * complex(in_phase(i, k), lagging(i, k)) + (i == k ? 1.0 : 0.0);
        for (std::int64_t i = 0; i < z; ++i) p[i] *= spring_[i];
        lu_.factor(z, a);
        lu_.solve(p.data(), 1, z);
        for (std::int64_t j = 0; j < r; ++j) {
            for (std::int64_t i = 0; i < z; ++i) f[j] -= m_.gap(i, j) * p[i];
            f[j] /= d[j];
        }
    }

    // B diag(weight) B^T.
    Matrix gaps_by(const vector<double> &weight) const {
        Matrix weighted = m_.gap;
        for (std::int64_t j = 0; j < weighted.cols(); ++j)
            for (std::int64_t i = 0; i < weighted.rows(); ++i) weighted(i, j) *= weight[j];
        return product('N', 'T', weighted, m_.gap);
    }

    void solve_coupled(double omega, const vector<complex> &d, vector<complex> &f) {
        const std::int64_t r = m_.size();
        vector<complex> a(static_cast<std::size_t>(r * r));
        for (std::int64_t j = 0; j < r; ++j) {
            for (std::int64_t i = 0; i < r; ++i)
                a[i + j * r] = complex(stiffness_(i, j), omega * m_.damping(i, j));
            a[j + j * r] += d[j];
        }
        lu_.factor(r, a);
        lu_.solve(f.data(), 1, r);
    }

    const ReducedModel &m_;
    const vector<double> &spring_;
    Matrix stiffness_;
    ComplexLu lu_;
};

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
    const Matrix forces = product('T', 'N', whole.gap, exact.motion->contact_forces(n));
    const vector<double> springs = mean_springs(model, exact);
    HarmonicAnswer answer(whole, springs);
    for (std::int64_t h = 0; h <= n; ++h) {
        vector<complex> change = missing_force(whole, p, forces, h);
        // the mean: where nothing but contact holds the structure
        answer.solve(static_cast<double>(h) * p.omega, h == 0 ? negligible * p.omega * p.omega : 0, change);
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
