#include "reduction/pair_sampling.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double rank_tolerance = 1e-6;
constexpr double tie = 1e-8; // values this close are equal, as on symmetric meshes

// The pairs that are still there, ascending, and what to take out next.
class Candidates {
  public:
    explicit Candidates(std::int64_t n) {
        for (std::int64_t i = 0; i < n; ++i) left_.push_back(i);
    }
    /// Removes the one with the least value, the last one of equals; its index.
    template <class Value> std::int64_t remove_least(Value value) {
        double least = value(left_[0]);
        for (std::int64_t i : left_) least = std::min(least, value(i));
        std::size_t at = left_.size() - 1;
        while (value(left_[at]) > least + tie * std::abs(least)) --at;
        const std::int64_t removed = left_[at];
        left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
        return removed;
    }
    const vector<std::int64_t> &left() const { return left_; }
    std::int64_t size() const { return static_cast<std::int64_t>(left_.size()); }

  private:
    vector<std::int64_t> left_;
};

// B P in coordinates of equal energy.
Matrix energy_motions(const ReducedModel &m, double omega) {
    Matrix motions = m.gap;
    for (std::int64_t j = 0; j < motions.cols(); ++j)
        for (std::int64_t i = 0; i < motions.rows(); ++i)
            motions(i, j) /= std::sqrt(m.lambda[j] + m.mass(j) * omega * omega);
    return motions;
}

double distance(const Matrix &rows, std::int64_t i, std::int64_t j) {
    double sum = 0;
    for (std::int64_t k = 0; k < rows.cols(); ++k)
        sum += (rows(i, k) - rows(j, k)) * (rows(i, k) - rows(j, k));
    return sum;
}

std::int64_t nearest(const Matrix &rows, std::int64_t i, const vector<std::int64_t> &carried) {
    std::int64_t best = 0;
    double least = distance(rows, i, carried[0]);
    for (std::size_t c = 1; c < carried.size(); ++c) {
        const double d = distance(rows, i, carried[c]);
        if (d < least * (1 - tie)) least = d, best = static_cast<std::int64_t>(c);
    }
    return best;
}

// The structure as its pairs see it, rigid-body motion softly held.
vector<std::int64_t> master_pairs(const Space &space, double omega, std::int64_t n) {
    const double shift = space.lambda.empty() || space.lambda[0] > 0 ? 0 : 1e-2 * omega * omega;
    Matrix root = space.gap, flexible = space.gap;
    for (std::int64_t j = 0; j < root.cols(); ++j)
        for (std::int64_t i = 0; i < root.rows(); ++i) {
            root(i, j) /= std::sqrt(space.lambda[j] + space.mass(j) * shift);
            flexible(i, j) *= space.mass(j) / (space.lambda[j] + shift);
        }
    Matrix f = product('N', 'T', root, root);
    for (std::int64_t i = 0; i < f.rows(); ++i) f(i, i) += 1 / space.model->contact_stiffness()[i];
    return pairs_by_master_dof(f, product('N', 'T', flexible, flexible), n);
}

std::shared_ptr<const ReducedModel> carry(const ReducedModel &whole, const vector<std::int64_t> &carried,
                                          const Matrix &motions) {
    auto reduced = std::make_shared<ReducedModel>(whole);
    auto all = std::make_shared<AllPairs>();
    all->gap = whole.gap;
    all->gap_0 = whole.gap_0;
    all->contact = whole.contact;
    reduced->all_pairs = all;
    reduced->carried = carried;
    reduced->gap = select_rows(whole.gap, carried);
    reduced->gap_0 = select_rows(whole.gap_0, carried);
    reduced->contact = whole.contact.of_pairs(carried, vector<double>(carried.size(), 0.0));
    for (std::int64_t i = 0; i < whole.n_pairs(); ++i)
        reduced->contact.stiffness[nearest(motions, i, carried)] += whole.contact.stiffness[i];
    return reduced;
}

} // namespace

vector<std::int64_t> pairs_by_effective_independence(const Matrix &motions, std::int64_t n) {
    const Svd svd = thin_svd(motions);
    std::int64_t t = 0;
    while (t < std::min(n, static_cast<std::int64_t>(svd.values.size())) &&
           svd.values[t] > rank_tolerance * svd.values[0])
        ++t;
    const Matrix target = svd.u.columns(0, t).transposed(); // column i: t_i
    Matrix inverse(t, t);                                   // (T^T T)^-1 of what is left
    for (std::int64_t k = 0; k < t; ++k) inverse(k, k) = 1;
    vector<double> contribution(motions.rows());
    for (std::int64_t i = 0; i < motions.rows(); ++i) contribution[i] = dot(t, target.col(i), target.col(i));
    Candidates candidates(motions.rows());
    vector<double> a(t);
    while (candidates.size() > n) {
        const std::int64_t gone = candidates.remove_least([&](std::int64_t i) { return contribution[i]; });
        if (t == 0) continue; // no pair moves
        // Sherman & Morrison: the least contribution is at most t / (pairs left) < 1
        gemv('N', 1.0, inverse, target.col(gone), 0.0, a.data());
        const double pivot = std::max(1 - dot(t, a.data(), target.col(gone)), 1e-14);
        for (std::int64_t i : candidates.left()) {
            const double c = dot(t, a.data(), target.col(i));
            contribution[i] += c * c / pivot;
        }
        for (std::int64_t k = 0; k < t; ++k)
            for (std::int64_t l = 0; l < t; ++l) inverse(l, k) += a[l] * a[k] / pivot;
    }
    return candidates.left();
}

vector<std::int64_t> pairs_by_master_dof(const Matrix &flexibility, const Matrix &inertia, std::int64_t n) {
    const std::int64_t z = flexibility.rows();
    Matrix factor = flexibility, mass = inertia;
    DenseCholesky cholesky;
    if (!cholesky.factor(factor))
        throw Error(status::singular, "the contact flexibility is not positive definite: pairs repeat the "
                                      "same gap row; choose pair_rule \"effective_independence\"")
            .argument("pair_rule")
            .reason(reason::singular);
    Matrix stiffness(z, z);
    for (std::int64_t i = 0; i < z; ++i) stiffness(i, i) = 1;
    cholesky.solve(stiffness.data(), z, z);
    cholesky.solve(mass.data(), z, z);
    mass = mass.transposed();
    cholesky.solve(mass.data(), z, z);
    Candidates candidates(z);
    vector<double> t(z), moved(z);
    while (candidates.size() > n) {
        const std::int64_t gone =
            candidates.remove_least([&](std::int64_t i) { return -stiffness(i, i) / mass(i, i); });
        // Guyan: x_gone = -t x_left
        const double k = stiffness(gone, gone), m = mass(gone, gone);
        for (std::int64_t i : candidates.left()) t[i] = stiffness(i, gone) / k, moved[i] = mass(i, gone);
        for (std::int64_t j : candidates.left())
            for (std::int64_t i : candidates.left()) {
                stiffness(i, j) -= t[i] * k * t[j];
                mass(i, j) += t[i] * m * t[j] - t[i] * moved[j] - moved[i] * t[j];
            }
    }
    return candidates.left();
}

std::shared_ptr<const ReducedModel> sample_pairs(const std::shared_ptr<const ReducedModel> &reduced,
                                                 const Space &space, PairRule rule, std::int64_t n,
                                                 double omega) {
    if (n > reduced->n_pairs())
        throw Error(status::argument,
                    format("n_pairs_carried is %lld, but the model has %lld pairs; 0 "
                           "carries all of them",
                           static_cast<long long>(n), static_cast<long long>(reduced->n_pairs())))
            .argument("n_pairs_carried");
    if (n == reduced->n_pairs()) return reduced;
    const Matrix motions = energy_motions(*reduced, omega);
    return carry(*reduced,
                 rule == PairRule::mdof ? master_pairs(space, omega, n)
                                        : pairs_by_effective_independence(motions, n),
                 motions);
}

} // namespace plm
