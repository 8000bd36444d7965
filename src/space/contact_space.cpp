// The contact space: the unreduced structure as its contact sees it, to a stated tolerance. Exact open modes
// carry the resonances; attachment vectors (K + sigma M)^-1 B^T and their successors under (K + sigma M)^-1 M
// carry the rest. The error left is measured with the full matrices, and blocks are added until it is small
// enough.
#include "linalg/lapack.hpp"
#include "space/massless.hpp"
#include "space/space.hpp"
#include "structure/eigs.hpp"
#include "structure/solver/make_factor.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace plm {
namespace {

// Where no highest frequency is known yet: so far above the lowest that only what is nothing to double
// precision is left out, since a soft support may stand between them.
constexpr double far_above_the_first = 3e4;

constexpr std::int64_t cannot_tell = -1, hit_a_mode = -2; // no count: for good, or at this frequency

// Number of open modes below the cutoff by Sylvester's law of inertia, if there is one.
std::int64_t count_below(const Model &model, double cutoff) {
    if (!tells_inertia(model.host_solver())) return cannot_tell;
    const SparseMatrix shifted = add(1.0, model.stiffness(), -cutoff * cutoff, model.mass());
    try {
        return make_factor(shifted, FactorKind::indefinite, model.host_solver())->negative_eigenvalues();
    } catch (const Error &e) {
        if (e.status() != PLM_ERR_SINGULAR) throw;
        return hit_a_mode; // the caller moves the cutoff
    }
}

EigenPairs modes_with_growth(const Model &model, std::int64_t first_guess, double cutoff,
                             const EigsOptions &options) {
    std::int64_t wanted = std::min(first_guess, model.n_free());
    for (;;) {
        EigenPairs pairs = lowest_eigenpairs(model.stiffness(), model.mass(), model.factor(), -model.shift(),
                                             wanted, options);
        const std::int64_t found = static_cast<std::int64_t>(pairs.values.size());
        if (found < wanted || wanted == model.n_free() || pairs.values.back() >= cutoff * cutoff)
            return pairs;
        wanted = std::min(model.n_free(), wanted + wanted / 2 + 10);
    }
}

class ContactSpaceBuilder {
  public:
    ContactSpaceBuilder(std::shared_ptr<const Model> model, double highest, std::int64_t least_modes,
                        Watch watch, const Space *previous)
        : model_(std::move(model)), previous_(previous), space_(std::make_shared<Space>()), highest_(highest),
          least_modes_(least_modes), watch_(watch), sigma_(model_->shift()),
          shifted_(sigma_ > 0 ? add(1.0, model_->stiffness(), sigma_, model_->mass()) : SparseMatrix()) {
        space_->model = model_;
        space_->highest_frequency = highest;
        space_->is_contact_space = true;
    }

    std::shared_ptr<Space> build() {
        exact_modes();
        static_block();
        const SpaceOptions &options = model_->space_options();
        double error = highest_ > 0 ? receptance_error() : 0;
        std::int64_t blocks = 1;
        while (highest_ > 0 && error > options.tolerance && blocks < options.max_blocks) {
            watch_.step("contact space", 0.5 + 0.5 * static_cast<double>(blocks) / options.max_blocks);
            if (!next_block()) break;
            ++blocks;
            error = receptance_error();
        }
        if (error > options.tolerance)
            watch_.warn(
                PLM_REASON_BASIS_TOO_SMALL,
                format("the contact space reaches a receptance error of %.1e at %.6g Hz, not the %.1e asked "
                       "for; raise cutoff_factor or max_blocks of the model",
                       error, highest_ / (2 * M_PI), options.tolerance));
        space_->error_estimate = error;
        assemble(blocks);
        return space_;
    }

  private:
    const SparseMatrix &shifted() const { return sigma_ > 0 ? shifted_ : model_->stiffness(); }

    void exact_modes() {
        watch_.step("open modes", 0.0);
        EigsOptions options;
        options.cancelled = [this] { return watch_.cancelled("open modes", 0.3); };
        const double cutoff = highest_ * model_->space_options().cutoff_factor;
        double checked = cutoff;
        const std::int64_t count = verified_count(checked);
        std::int64_t guess = std::max<std::int64_t>(least_modes_, count >= 0 ? count : 20);
        guess = std::max(guess, model_->rigid_modes().cols() + 1);
        EigenPairs pairs = previous_modes(guess, cutoff);
        if (pairs.values.empty())
            pairs = modes_with_growth(*model_, guess, count >= 0 ? 0.0 : cutoff, options);
        if (count >= 0) {
            const auto below = [&] {
                return std::upper_bound(pairs.values.begin(), pairs.values.end(), checked * checked) -
                       pairs.values.begin();
            };
            for (int attempt = 0; attempt < 3 && below() < count; ++attempt)
                pairs = modes_with_growth(*model_, count + 10 * (attempt + 1), 0.0, options);
            if (below() != count)
                throw Error(
                    PLM_ERR_EIGENSOLVER,
                    format("%lld open modes were found below %.6g Hz where the Sturm sequence counts %lld",
                           static_cast<long long>(below()), checked / (2 * M_PI),
                           static_cast<long long>(count)));
            space_->counts_verified = true;
        }
        const std::int64_t n_rigid =
            std::min<std::int64_t>(model_->rigid_modes().cols(), pairs.values.size());
        std::fill(pairs.values.begin(), pairs.values.begin() + n_rigid, 0.0); // exactly
        const double flexible = flexible_eigenvalue(pairs.values);
        reach_ = highest_ > 0 ? highest_ : far_above_the_first * std::sqrt(flexible);
        leave_out_followers(pairs);
        modes_ = std::move(pairs);
        mass_modes_ = multiply(model_->mass(), modes_.vectors);
        next_lambda_ = modes_.values.empty() ? 0 : modes_.values.back();
    }

    // What the modes found have to agree with; `frequency` moves a little where it hits a mode.
    std::int64_t verified_count(double &frequency) const {
        if (!(frequency > 0) || !model_->space_options().verify_counts) return cannot_tell;
        std::int64_t count = hit_a_mode;
        for (int attempt = 0; attempt < 3 && count == hit_a_mode; ++attempt) {
            if (attempt > 0) frequency *= 1.003;
            watch_.step("count of open modes", 0.1); // a factorization, which hears nobody
            count = count_below(*model_, frequency);
        }
        if (count == hit_a_mode)
            watch_.warn(PLM_REASON_UNVERIFIED,
                        format("the number of open modes below %.6g Hz could not be verified: K - w^2 M is "
                               "singular there and just above; compare with another cutoff_factor",
                               frequency / (2 * M_PI)));
        else if (count == cannot_tell)
            watch_.log(1, unverified());
        return count;
    }

    static std::string unverified() {
        return "the number of open modes is not verified, since the host's solver does not tell the inertia: "
               "give "
               "the context the solver's inertia function, too";
    }

    // "Modes" of next to no mass: what they carry of the contact forces is among the attachment vectors.
    void leave_out_followers(EigenPairs &pairs) const {
        const double limit = reach_ * reach_ / negligible_inertia;
        std::int64_t kept = 0;
        for (double l : pairs.values) kept += l < limit;
        if (kept == pairs.vectors.cols()) return;
        pairs.values.resize(kept); // ascending
        pairs.vectors = pairs.vectors.columns(0, kept);
    }

    // The exact modes of the earlier space come first in it; empty when they do not reach far enough.
    EigenPairs previous_modes(std::int64_t wanted, double cutoff) const {
        EigenPairs pairs;
        if (!previous_ || previous_->n_exact_modes < wanted ||
            previous_->lambda[previous_->n_exact_modes - 1] < cutoff * cutoff)
            return pairs;
        pairs.values.assign(previous_->lambda.begin(), previous_->lambda.begin() + previous_->n_exact_modes);
        pairs.vectors = previous_->vectors.columns(0, previous_->n_exact_modes);
        return pairs;
    }

    double flexible_eigenvalue(const vector<double> &values) const {
        const std::size_t rigid = static_cast<std::size_t>(model_->rigid_modes().cols());
        return rigid < values.size() ? values[rigid] : 1.0;
    }

    // The part of X outside the exact modes; those keep both M- and K-orthogonality by being eigenvectors.
    void deflate(Matrix &x) const {
        if (modes_.vectors.cols() == 0) return;
        for (int pass = 0; pass < 2; ++pass) {
            const Matrix c = product('T', 'N', mass_modes_, x);
            gemm('N', 'N', -1.0, modes_.vectors, c, 1.0, x);
        }
    }

    Matrix load_responses() const {
        Matrix loads;
        const auto add_load = [&](const vector<double> &f) {
            if (std::all_of(f.begin(), f.end(), [](double v) { return v == 0; })) return;
            Matrix column(model_->n_free(), 1);
            std::copy(f.begin(), f.end(), column.data());
            loads.append(column);
        };
        add_load(model_->preload());
        for (const auto &entry : model_->excitation()) {
            add_load(entry.second.real);
            add_load(entry.second.imag);
        }
        if (!loads.empty()) model_->factor().solve(loads);
        return loads;
    }

    // Columns scaled to unit energy; those that the exact modes already contain are dropped.
    void static_block() {
        watch_.step("contact space", 0.4);
        Matrix x = model_->attachment();
        x.append(load_responses());
        if (x.empty()) return;
        vector<double> before = energies(x);
        deflate(x);
        const vector<double> after = energies(x);
        Matrix kept(x.rows(), 0);
        for (std::int64_t j = 0; j < x.cols(); ++j) {
            if (after[j] <= 1e-20 * before[j]) continue;
            Matrix column = x.columns(j, 1);
            const double scale = 1 / std::sqrt(after[j]);
            for (std::int64_t i = 0; i < x.rows(); ++i) column(i, 0) *= scale;
            kept.append(column);
        }
        add_orthonormal(kept, 1e-13);
    }

    vector<double> energies(const Matrix &x) const {
        const Matrix kx = multiply(shifted(), x);
        vector<double> e(x.cols());
        for (std::int64_t j = 0; j < x.cols(); ++j) e[j] = std::max(0.0, dot(x.rows(), x.col(j), kx.col(j)));
        return e;
    }

    // Appends to basis_ a K-orthonormal basis of the columns of x, leaving out what weighs less than `drop`
    // (squared).
    bool add_orthonormal(Matrix &x, double drop) {
        if (x.cols() == 0) return false;
        for (int pass = 0; pass < 2 && basis_.cols() > 0; ++pass)
            gemm('N', 'N', -1.0, basis_, product('T', 'N', stiff_basis_, x), 1.0, x);
        Matrix y = x;
        for (int pass = 0; pass < 2; ++pass) { // the second pass repairs what the first lost to rounding
            const SymmetricEigen gram = symmetric_eigen(product('T', 'N', y, multiply(shifted(), y)));
            const double largest = gram.values.back();
            const double least = pass == 0 ? std::max(drop, 1e-14 * largest) : 0.1;
            Matrix t(y.cols(), 0);
            for (std::int64_t j = 0; j < y.cols(); ++j) {
                if (gram.values[j] < least) continue;
                Matrix column = gram.vectors.columns(j, 1);
                for (std::int64_t i = 0; i < y.cols(); ++i) column(i, 0) /= std::sqrt(gram.values[j]);
                t.append(column);
            }
            if (t.cols() == 0) return false;
            y = product('N', 'N', y, t);
        }
        newest_ = y;
        basis_.append(y);
        stiff_basis_.append(multiply(shifted(), y));
        rayleigh_ritz();
        return true;
    }

    // Diagonalises M in the K-orthonormal basis: compliances mu = 1 / (lambda + sigma), descending.
    void rayleigh_ritz() {
        Matrix gram = product('T', 'N', basis_, multiply(model_->mass(), basis_));
        for (std::int64_t k = 0; k < gram.rows() * gram.cols(); ++k) gram.data()[k] *= -1; // slowest first
        ritz_ = symmetric_eigen(gram);
        for (double &mu : ritz_.values) mu = std::max(-mu, 0.0); // 0: no mass
    }

    // The next Krylov block from those directions that are slow enough to matter at the highest frequency.
    bool next_block() {
        const double reach = highest_ * highest_ + sigma_;
        const double least = 0.03 * std::sqrt(model_->space_options().tolerance);
        Matrix gram = product('T', 'N', newest_, multiply(model_->mass(), newest_));
        for (std::int64_t k = 0; k < gram.rows() * gram.cols(); ++k) gram.data()[k] *= -1; // slowest first
        const SymmetricEigen slow = symmetric_eigen(gram);
        std::int64_t count = 0;
        while (count < gram.cols() && -slow.values[count] * reach > least) ++count;
        if (count == 0) return false;
        Matrix x = product('N', 'N', newest_, slow.vectors.columns(0, count));
        x = multiply(model_->mass(), x);
        for (std::int64_t k = 0; k < x.rows() * x.cols(); ++k) x.data()[k] *= reach;
        model_->factor().solve(x);
        deflate(x);
        return add_orthonormal(x, least * least);
    }

    // Largest relative error of the receptances at the highest frequency over a few fixed combinations of the
    // contact rows and the loads: with r the full residual, the Galerkin receptance is off by r' (K - w^2
    // M)^-1 r.
    double receptance_error() const {
        if (basis_.cols() == 0) return 0;
        Matrix probes(model_->n_free(), 0);
        std::uint64_t state = 88172645463325252ull;
        for (int p = 0; p < 3 && model_->n_pairs() > 0; ++p) {
            vector<double> signs(model_->n_pairs());
            for (double &s : signs) {
                state ^= state << 13, state ^= state >> 7, state ^= state << 17;
                s = (state >> 40) & 1 ? 1.0 : -1.0;
            }
            Matrix column(model_->n_free(), 1);
            multiply_transposed(model_->gap_matrix(), signs.data(), column.data());
            probes.append(column);
        }
        double worst = 0;
        for (std::int64_t j = 0; j < probes.cols(); ++j)
            worst = std::max(worst, probe_error(probes.columns(j, 1)));
        for (const auto &entry : model_->excitation()) {
            Matrix column(model_->n_free(), 1);
            std::copy(entry.second.real.begin(), entry.second.real.end(), column.data());
            worst = std::max(worst, probe_error(column));
        }
        return worst;
    }

    double probe_error(Matrix b) const {
        Matrix whole = b;
        model_->factor().solve(whole);
        const double compliance = dot(b.rows(), b.data(), whole.data());
        if (!(compliance > 0)) return 0;
        // Only the part outside the exact modes can be wrong.
        gemm('N', 'N', -1.0, mass_modes_, product('T', 'N', modes_.vectors, b), 1.0, b);
        const double w2 = highest_ * highest_;
        Matrix z = product('T', 'N', ritz_.vectors, product('T', 'N', basis_, b));
        for (std::int64_t k = 0; k < z.rows(); ++k) z(k, 0) /= 1 - (w2 + sigma_) * ritz_.values[k];
        const Matrix x = product('N', 'N', basis_, product('N', 'N', ritz_.vectors, z));
        Matrix r = b;
        const Matrix kx = multiply(shifted(), x), mx = multiply(model_->mass(), x);
        for (std::int64_t i = 0; i < r.rows(); ++i) r(i, 0) -= kx(i, 0) - (w2 + sigma_) * mx(i, 0);
        Matrix e = r;
        model_->factor().solve(e);
        const double amplification = 1 / std::max(1e-3, 1 - (w2 + sigma_) * ritz_.values.front());
        return std::abs(dot(r.rows(), r.data(), e.data())) * amplification / compliance;
    }

    // Exact modes and attachment vectors by frequency, then what has no mass.
    void assemble(std::int64_t blocks) {
        const std::int64_t p = modes_.vectors.cols(), a = basis_.cols();
        Matrix vectors = modes_.vectors;
        vector<double> lambda(modes_.values);
        if (a > 0) {
            const RitzVectors attached = attachment_coordinates();
            space_->n_massless = attached.n_massless;
            lambda.insert(lambda.end(), attached.lambda.begin(), attached.lambda.end());
            Matrix attachment = product('N', 'N', basis_, attached.vectors);
            deflate(attachment); // scaling has magnified what rounding left of the exact modes
            vectors.append(attachment);
        }
        vector<std::int64_t> order(lambda.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end() - space_->n_massless,
                         [&](auto i, auto j) { return lambda[i] < lambda[j]; });
        space_->lambda.resize(lambda.size());
        space_->vectors.reset(model_->n_free(), static_cast<std::int64_t>(lambda.size()));
        for (std::size_t j = 0; j < order.size(); ++j) {
            space_->lambda[j] = lambda[order[j]];
            std::copy_n(vectors.col(order[j]), model_->n_free(), space_->vectors.col(j));
        }
        space_->n_exact_modes = p;
        describe(blocks);
        project_onto(*space_);
        watch_.log(1, "contact space: " + space_->description);
    }

    RitzVectors attachment_coordinates() const {
        const std::int64_t a = basis_.cols();
        vector<double> mu(ritz_.values.rbegin(), ritz_.values.rend());
        Matrix y(a, a);
        for (std::int64_t j = 0; j < a; ++j) std::copy_n(ritz_.vectors.col(a - 1 - j), a, y.col(j));
        return ritz_vectors(mu, y, sigma_, reach_);
    }

    void describe(std::int64_t blocks) {
        const std::int64_t a = basis_.cols();
        space_->description = format(
            "%lld open modes up to %.6g Hz and %lld contact attachment vectors in %lld block(s)%s; "
            "receptance "
            "error %.1e at %.6g Hz",
            static_cast<long long>(modes_.vectors.cols()), std::sqrt(next_lambda_) / (2 * M_PI),
            static_cast<long long>(a), static_cast<long long>(a > 0 ? blocks : 0),
            space_->n_massless > 0
                ? format(", %lld of them without inertia", static_cast<long long>(space_->n_massless)).c_str()
                : "",
            space_->error_estimate, highest_ / (2 * M_PI));
        if (highest_ > 0 && model_->space_options().verify_counts && !space_->counts_verified)
            space_->description += "; " + unverified();
    }

    std::shared_ptr<const Model> model_;
    const Space *previous_;
    std::shared_ptr<Space> space_;
    double highest_;
    std::int64_t least_modes_;
    Watch watch_;
    double sigma_;
    SparseMatrix shifted_; // K + sigma M when sigma > 0
    EigenPairs modes_;
    Matrix mass_modes_;                   // M Phi
    double next_lambda_ = 0, reach_ = 0;  // reach_: rad/s, of the highest frequency of interest
    Matrix basis_, stiff_basis_, newest_; // K-orthonormal attachment vectors Y, K Y, the last block
    SymmetricEigen ritz_;                 // of M in basis_: compliances and vectors
};

} // namespace

std::shared_ptr<const Space> make_contact_space(std::shared_ptr<const Model> model, double highest_frequency,
                                                std::int64_t least_modes, Watch watch,
                                                std::shared_ptr<const Space> previous) {
    const std::int64_t least = std::min(least_modes, model->n_free());
    if (previous && previous->highest_frequency >= highest_frequency && previous->n_exact_modes >= least)
        return previous;
    const auto begin = std::chrono::steady_clock::now();
    const std::shared_ptr<Space> space =
        ContactSpaceBuilder(std::move(model), highest_frequency, least_modes, watch, previous.get()).build();
    space->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() +
                     (previous ? previous->seconds : 0);
    return space;
}

} // namespace plm
