// The contact space: the unreduced structure as its contact sees it, to a stated tolerance. Exact open modes
// carry the resonances; attachment vectors (K + sigma M)^-1 B^T and their successors under (K + sigma M)^-1 M
// carry the rest. The error left is measured with the full matrices, and blocks are added until it is small
// enough.
#include "linalg/lapack.hpp"
#include "space/massless.hpp"
#include "space/space.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

namespace plm {
namespace {

// Where no highest frequency is known yet: so far above the lowest that only what is nothing to double
// precision is left out, since a soft support may stand between them.
constexpr double far_above_the_first = 3e4;

StructureModes modes_with_growth(const Model &model, std::int64_t first_guess, double cutoff,
                                 const std::function<bool()> &cancelled) {
    std::int64_t wanted = std::min(first_guess, model.n_free());
    for (;;) {
        StructureModes pairs = model.lowest_modes(wanted, cancelled);
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
          least_modes_(least_modes), watch_(watch), sigma_(model_->shift()) {
        space_->model = model_;
        space_->highest_frequency = highest;
        space_->is_contact_space = true;
    }

    std::shared_ptr<Space> build() {
        exact_modes();
        static_block();
        const SpaceOptions &options = model_->space_options();
        if (highest_ > 0) choose_probes();
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
    void exact_modes() {
        watch_.step("open modes", 0.0);
        const auto cancelled = [this] { return watch_.cancelled("open modes", 0.3); };
        const double cutoff = highest_ * model_->space_options().cutoff_factor;
        double checked = cutoff;
        const std::int64_t count = verified_count(checked);
        std::int64_t guess = std::max<std::int64_t>(least_modes_, count >= 0 ? count : 20);
        guess = std::max(guess, model_->n_rigid() + 1);
        StructureModes pairs = previous_modes(guess, cutoff);
        if (pairs.values.empty())
            pairs = modes_with_growth(*model_, guess, count >= 0 ? 0.0 : cutoff, cancelled);
        if (count >= 0) {
            const auto below = [&] {
                return std::upper_bound(pairs.values.begin(), pairs.values.end(), checked * checked) -
                       pairs.values.begin();
            };
            for (int attempt = 0; attempt < 3 && below() < count; ++attempt)
                pairs = modes_with_growth(*model_, count + 10 * (attempt + 1), 0.0, cancelled);
            if (below() != count)
                throw Error(
                    PLM_ERR_EIGENSOLVER,
                    format("%lld open modes were found below %.6g Hz where the Sturm sequence counts %lld",
                           static_cast<long long>(below()), checked / (2 * M_PI),
                           static_cast<long long>(count)));
            space_->counts_verified = true;
        }
        const std::int64_t n_rigid = std::min<std::int64_t>(model_->n_rigid(), pairs.values.size());
        std::fill(pairs.values.begin(), pairs.values.begin() + n_rigid, 0.0); // exactly
        const double flexible = flexible_eigenvalue(pairs.values);
        reach_ = highest_ > 0 ? highest_ : far_above_the_first * std::sqrt(flexible);
        leave_out_followers(pairs);
        modes_ = std::move(pairs);
        mass_modes_ = model_->mass_times(modes_.vectors);
        next_lambda_ = modes_.values.empty() ? 0 : modes_.values.back();
    }

    // What the modes found have to agree with; `frequency` moves a little where it hits a mode.
    std::int64_t verified_count(double &frequency) const {
        if (!(frequency > 0) || !model_->space_options().verify_counts) return cannot_tell_count;
        const std::int64_t count = model_->count_modes_near(frequency, watch_);
        if (count == cannot_tell_count) watch_.log(1, unverified());
        return count;
    }

    static std::string unverified() {
        return "the number of open modes is not verified, since the host's solver does not tell the inertia: "
               "give the context the solver's inertia function, too";
    }

    // "Modes" of next to no mass: what they carry of the contact forces is among the attachment vectors.
    void leave_out_followers(StructureModes &pairs) const {
        const double limit = reach_ * reach_ / negligible_inertia;
        std::int64_t kept = 0;
        for (double l : pairs.values) kept += l < limit;
        if (kept == pairs.vectors.cols()) return;
        pairs.values.resize(kept); // ascending
        pairs.vectors = pairs.vectors.columns(0, kept);
    }

    // The exact modes of the earlier space come first in it; empty when they do not reach far enough.
    StructureModes previous_modes(std::int64_t wanted, double cutoff) const {
        StructureModes pairs;
        if (!previous_ || previous_->n_exact_modes < wanted ||
            previous_->lambda[previous_->n_exact_modes - 1] < cutoff * cutoff)
            return pairs;
        pairs.values.assign(previous_->lambda.begin(), previous_->lambda.begin() + previous_->n_exact_modes);
        pairs.vectors = previous_->vectors.columns(0, previous_->n_exact_modes);
        return pairs;
    }

    double flexible_eigenvalue(const vector<double> &values) const {
        const std::size_t rigid = static_cast<std::size_t>(model_->n_rigid());
        return rigid < values.size() ? values[rigid] : 1.0;
    }

    // The part of X outside the exact modes; those keep both M- and K-orthogonality by being eigenvectors.
    void deflate(Field &x) const {
        if (modes_.vectors.cols() == 0) return;
        for (int pass = 0; pass < 2; ++pass) add_combination(-1.0, modes_.vectors, gram(mass_modes_, x), x);
    }

    // Columns scaled to unit energy; those that the exact modes already contain are dropped.
    void static_block() {
        watch_.step("contact space", 0.4);
        const auto [x, before] = static_responses();
        if (x.empty()) return;
        Matrix energy = gram(x, model_->shifted_times(x));
        vector<double> scale(x.cols());
        for (std::int64_t j = 0; j < x.cols(); ++j)
            scale[j] = energy(j, j) <= 1e-20 * before[j] ? 0 : 1 / std::sqrt(energy(j, j));
        for (std::int64_t j = 0; j < x.cols(); ++j)
            for (std::int64_t i = 0; i < x.cols(); ++i) energy(i, j) *= scale[i] * scale[j];
        Matrix t = unit_energy(energy, 1e-13);
        for (std::int64_t j = 0; j < t.cols(); ++j)
            for (std::int64_t i = 0; i < t.rows(); ++i) t(i, j) *= scale[i];
        append(combine(x, t));
    }

    // What contact forces and loads do statically, less the exact modes, and their energies before that.
    std::pair<Field, vector<double>> static_responses() const {
        const Field loads = load_columns(model_->preload(), model_->excitation(), model_->n_free());
        Field x = loads;
        if (!x.empty()) model_->solve(x);
        vector<double> of_loads = column_products(x, loads);
        vector<double> energies = column_products(model_->attachment(), model_->gap_rows().columns());
        energies.insert(energies.end(), of_loads.begin(), of_loads.end());
        Field all = model_->attachment();
        all.append(x);
        deflate(all);
        return {std::move(all), std::move(energies)};
    }

    // The combinations of unit energy that are orthogonal to one another, by the energies of what they
    // combine; those of less energy than `least` are left out.
    static Matrix unit_energy(const Matrix &energies, double least) {
        const SymmetricEigen e = symmetric_eigen(energies);
        least = std::max(least, 1e-14 * e.values.back());
        const std::int64_t n = energies.cols();
        const std::int64_t first =
            std::lower_bound(e.values.begin(), e.values.end(), least) - e.values.begin(); // ascending
        Matrix t = e.vectors.columns(first, n - first);
        for (std::int64_t j = 0; j < t.cols(); ++j)
            for (std::int64_t i = 0; i < n; ++i) t(i, j) /= std::sqrt(e.values[first + j]);
        return t;
    }

    // A block that is K-orthonormal but for rounding, which is repaired here. False where nothing is left.
    bool append(Field y) {
        if (y.cols() == 0) return false;
        Field stiff = model_->shifted_times(y);
        const Matrix t = unit_energy(gram(y, stiff), 0.1);
        if (t.cols() == 0) return false;
        y = combine(y, t);
        stiff = combine(stiff, t); // t hardly differs from a rotation: no digits are lost
        newest_momenta_ = model_->mass_times(y);
        append_inertia(y);
        basis_.append(y);
        stiff_basis_.append(stiff);
        rayleigh_ritz();
        return true;
    }

    // The rows and columns of the newest block y in Y^T M Y.
    void append_inertia(const Field &y) {
        const std::int64_t a = basis_.cols(), b = y.cols();
        const Matrix own = gram(y, newest_momenta_);
        const Matrix before = a > 0 ? gram(basis_, newest_momenta_) : Matrix(0, b);
        Matrix whole(a + b, a + b);
        for (std::int64_t j = 0; j < a; ++j) std::copy_n(inertia_.col(j), a, whole.col(j));
        for (std::int64_t j = 0; j < b; ++j) {
            std::copy_n(own.col(j), b, whole.col(a + j) + a);
            for (std::int64_t i = 0; i < a; ++i) whole(i, a + j) = whole(a + j, i) = before(i, j);
        }
        inertia_ = std::move(whole);
    }

    // The slowest come first.
    static SymmetricEigen by_inertia(Matrix inertia) {
        for (std::int64_t k = 0; k < inertia.rows() * inertia.cols(); ++k) inertia.data()[k] *= -1;
        SymmetricEigen e = symmetric_eigen(inertia);
        for (double &mu : e.values) mu = std::max(-mu, 0.0); // 0: no mass
        return e;
    }

    // Diagonalises M in the K-orthonormal basis: compliances mu = 1 / (lambda + sigma), descending.
    void rayleigh_ritz() { ritz_ = by_inertia(inertia_); }

    // The next Krylov block from those directions that are slow enough to matter at the highest frequency.
    bool next_block() {
        const double reach = highest_ * highest_ + sigma_;
        const double least = 0.03 * std::sqrt(model_->space_options().tolerance);
        const std::int64_t newest = newest_momenta_.cols();
        const SymmetricEigen slow = by_inertia(newest_inertia());
        std::int64_t count = 0;
        while (count < newest && slow.values[count] * reach > least) ++count;
        if (count == 0) return false;
        Field x = combine(newest_momenta_, slow.vectors.columns(0, count));
        x.scale(vector<double>(count, reach));
        model_->solve(x);
        deflate(x);
        for (int pass = 0; pass < 2; ++pass) add_combination(-1.0, basis_, gram(stiff_basis_, x), x);
        return append(combine(x, unit_energy(gram(x, model_->shifted_times(x)), least * least)));
    }

    Matrix newest_inertia() const {
        const std::int64_t b = newest_momenta_.cols(), a = inertia_.cols() - b;
        Matrix own(b, b);
        for (std::int64_t j = 0; j < b; ++j) std::copy_n(inertia_.col(a + j) + a, b, own.col(j));
        return own;
    }

    // A few fixed combinations of the contact rows, and the loads.
    void choose_probes() {
        std::uint64_t state = 88172645463325252ull;
        Matrix signs(model_->gap_rows().n_rows(), model_->n_pairs() > 0 ? 3 : 0);
        for (std::int64_t k = 0; k < signs.rows() * signs.cols(); ++k) {
            state ^= state << 13, state ^= state >> 7, state ^= state << 17;
            signs.data()[k] = (state >> 40) & 1 ? 1.0 : -1.0;
        }
        probes_ = model_->gap_rows().forces(signs);
        for (const auto &entry : model_->excitation()) probes_.append(entry.second.real);
        Field whole = probes_;
        if (!whole.empty()) model_->solve(whole);
        probe_compliance_ = column_products(probes_, whole);
        // Only the part outside the exact modes can be wrong.
        add_combination(-1.0, mass_modes_, gram(modes_.vectors, probes_), probes_);
    }

    // Largest relative error of the probes' receptances at the highest frequency: with r the full residual,
    // the Galerkin receptance is off by r' (K - w^2 M)^-1 r.
    double receptance_error() const {
        if (basis_.cols() == 0 || probes_.empty()) return 0;
        const double square = highest_ * highest_ + sigma_;
        Matrix z = product('T', 'N', ritz_.vectors, gram(basis_, probes_));
        for (std::int64_t j = 0; j < z.cols(); ++j)
            for (std::int64_t k = 0; k < z.rows(); ++k) z(k, j) /= 1 - square * ritz_.values[k];
        const Field x = combine(basis_, product('N', 'N', ritz_.vectors, z));
        Field r = probes_;
        add(-1.0, model_->shifted_times(x), r);
        add(square, model_->mass_times(x), r);
        Field e = r;
        model_->solve(e);
        const vector<double> missing = column_products(r, e);
        const double amplification = 1 / std::max(1e-3, 1 - square * ritz_.values.front());
        double worst = 0;
        for (std::size_t p = 0; p < missing.size(); ++p)
            if (probe_compliance_[p] > 0)
                worst = std::max(worst, std::abs(missing[p]) * amplification / probe_compliance_[p]);
        return worst;
    }

    // Exact modes and attachment vectors by frequency, then what has no mass.
    void assemble(std::int64_t blocks) {
        const std::int64_t p = modes_.vectors.cols(), a = basis_.cols();
        Field vectors = modes_.vectors;
        vector<double> lambda(modes_.values);
        if (a > 0) {
            const RitzVectors attached = attachment_coordinates();
            space_->n_massless = attached.n_massless;
            lambda.insert(lambda.end(), attached.lambda.begin(), attached.lambda.end());
            Field attachment = combine(basis_, attached.vectors);
            deflate(attachment); // scaling has magnified what rounding left of the exact modes
            vectors.append(attachment);
        }
        vector<std::int64_t> order(lambda.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end() - space_->n_massless,
                         [&](auto i, auto j) { return lambda[i] < lambda[j]; });
        for (std::int64_t j : order) space_->lambda.push_back(lambda[j]);
        space_->vectors = vectors.columns(order);
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
    StructureModes modes_;
    Field mass_modes_;                   // M Phi
    double next_lambda_ = 0, reach_ = 0; // reach_: rad/s, of the highest frequency of interest
    Field basis_, stiff_basis_;          // K-orthonormal attachment vectors Y, K Y
    Field newest_momenta_;               // M times the last block of them
    Matrix inertia_;                     // Y^T M Y
    SymmetricEigen ritz_;                // of M in basis_: compliances and vectors
    Field probes_;                       // loads by which the error is measured, outside the exact modes
    vector<double> probe_compliance_;    // of the whole loads
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
