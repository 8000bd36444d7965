// The contact space: the unreduced structure as its contact sees it, to a stated tolerance. Exact open modes
// carry the resonances; attachment vectors (K + sigma M)^-1 B^T, and of the slow ones their successors under
// (K + sigma M)^-1 M, carry the rest. The error left is measured with the full matrices, and vectors are
// added until it is small enough.
#include "space/attachment_basis.hpp"
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

// What is asked of each direction (AttachmentBasis::refine) at first, in tolerances: the error of all of them
// together is some ten to a hundred times smaller than what is asked of one, and told by measuring alone.
constexpr double asked_at_first = 1e3;
constexpr double below_tolerance = 0.7; // where it is to get to
constexpr double most_at_once = 0.1;    // from one measurement to the next

class ContactSpaceBuilder {
  public:
    ContactSpaceBuilder(std::shared_ptr<const Model> model, double highest, std::int64_t least_modes,
                        Watch watch, const Space *previous, const SpaceLimits &limits)
        : model_(std::move(model)), previous_(previous), space_(std::make_shared<Space>()), highest_(highest),
          least_modes_(least_modes), limits_(limits), watch_(watch), sigma_(model_->shift()) {
        space_->model = model_;
        space_->highest_frequency = highest;
        space_->is_contact_space = true;
    }

    std::shared_ptr<Space> build() {
        exact_modes();
        watch_.step("contact space", 0.4);
        AttachmentBasis attached(model_, responses_, highest_ > 0 ? highest_ * highest_ + sigma_ : 0);
        if (highest_ > 0) add_damping(attached);
        if (highest_ > 0) refine(attached);
        assemble(attached);
        return space_;
    }

  private:
    struct ReceptanceError {
        double contact = 0, loads = 0; // of contact forces, and of the excitation
        double worst() const { return std::max(contact, loads); }
    };

    // Dampers and damped layers pull the modes out of shape: by what the structure answers to their forces,
    // C times the modes, then C and M times these answers. Of proportional damping that is nothing. The share
    // of a mode's energy in an answer is what its frequency and damping are wrong by without it.
    void add_damping(AttachmentBasis &attached) const {
        if (!model_->damping().has_matrix) return;
        const SpaceOptions &options = model_->space_options();
        const vector<double> &values = responses_->modes->values;
        const double square = highest_ * highest_ + sigma_;
        const auto n = std::upper_bound(values.begin(), values.end(), square) - values.begin();
        for (std::int64_t first = 0; first < n; first += solved_at_once) {
            const std::int64_t some = std::min<std::int64_t>(solved_at_once, n - first);
            const Field modes = responses_->modes->vectors.columns(first, some);
            Field moves = attached.add_responses(model_->damping_times(modes), options.tolerance);
            for (std::int64_t block = 1; block < options.max_blocks && moves.cols() > 0; ++block) {
                watch_.step("contact space", 0.45);
                Field forces = model_->damping_times(moves), inertia = model_->mass_times(moves);
                forces.scale(vector<double>(forces.cols(), std::sqrt(square)));
                inertia.scale(vector<double>(inertia.cols(), square));
                forces.append(inertia);
                moves = attached.add_responses(std::move(forces), options.tolerance);
            }
        }
    }

    void refine(AttachmentBasis &attached) {
        const SpaceOptions &options = model_->space_options();
        choose_probes();
        ReceptanceError found = receptance_error(attached);
        AskedError asked{asked_at_first * options.tolerance, asked_at_first * options.tolerance};
        while (found.worst() > options.tolerance && std::min(asked.contact, asked.loads) > 1e-16) {
            if (attached.refine(asked, options.max_blocks, watch_)) found = receptance_error(attached);
            const AskedError left = attached.left_after(asked, options.max_blocks);
            ask_more(attached, found.contact, left.contact, &AskedError::contact, asked);
            ask_more(attached, found.loads, left.loads, &AskedError::loads, asked);
        }
        const double error = found.worst();
        if (error > options.tolerance)
            watch_.warn(
                reason::basis_too_small,
                format("the contact space reaches a receptance error of %.1e at %.6g Hz, not the %.1e asked "
                       "for; raise cutoff_factor or max_blocks of the model",
                       error, highest_ / (2 * M_PI), options.tolerance));
        space_->error_estimate = error;
    }

    // The error falls about as what all directions together leave out: a measurement is not for free, nor are
    // vectors in vain.
    void ask_more(const AttachmentBasis &attached, double error, double left, double AskedError::*part,
                  AskedError &asked) const {
        const SpaceOptions &options = model_->space_options();
        if (!(error > options.tolerance)) return;
        const double wanted = below_tolerance * options.tolerance / error * left,
                     least = most_at_once * (asked.*part);
        do asked.*part = std::max(least, 0.5 * (asked.*part));
        while (asked.*part > least && attached.left_after(asked, options.max_blocks).*part > wanted);
    }

    void exact_modes() {
        watch_.step("open modes", 0.0);
        responses_ = previous_ ? previous_->responses : model_->responses(watch_);
        std::shared_ptr<const ExactModes> modes = responses_->modes;
        const bool far_enough = highest_ > 0 && modes->count() > 0 && modes->count() >= least_modes_ &&
                                modes->values.back() >= cutoff() * cutoff();
        if (far_enough) forget_search(*modes); // the count takes the most memory of all
        double checked = cutoff();
        const std::int64_t count = limited_count(checked);
        std::int64_t guess = std::max<std::int64_t>(least_modes_, count >= 0 ? count : 20);
        guess = std::max(guess, model_->n_rigid() + 1);
        const bool reach_far =
            modes->count() >= guess && modes->count() > 0 && modes->values.back() >= cutoff() * cutoff();
        if (!reach_far && !modes->are_all) modes = more_modes(*modes, guess, count);
        if (count >= 0)
            modes = complete(std::move(modes), checked, count);
        else if (modes->may_miss_copies && !modes->are_all && !limits_.provisional)
            modes = model_->looked_over(*modes, watch_);
        if (highest_ > 0) forget_search(*modes); // hardly ever more are asked for
        if (modes != responses_->modes)
            responses_ = std::make_shared<const StaticResponses>(
                outside_more_modes(*model_, *responses_, std::move(modes), watch_));
        space_->responses = responses_;
        leave_out_followers();
    }

    double cutoff() const { return highest_ * model_->space_options().cutoff_factor; }

    static void forget_search(const ExactModes &modes) {
        if (modes.rest) *modes.rest = SearchRest();
    }

    // count: of modes below the cutoff, or negative.
    std::shared_ptr<const ExactModes> more_modes(const ExactModes &known, std::int64_t wanted,
                                                 std::int64_t count) const {
        const bool counted = count >= 0;
        ModeSearch search;
        search.known = &known;
        search.look_for_missed = !counted;
        return model_->exact_modes_up_to(wanted, counted ? 0.0 : cutoff(), watch_, search);
    }

    // As many modes below the frequency as are counted there, give or take those at it; where some were
    // missed, from a new search.
    std::shared_ptr<const ExactModes> complete(std::shared_ptr<const ExactModes> modes, double frequency,
                                               std::int64_t count) const {
        const auto below = [&](double share) {
            return std::upper_bound(modes->values.begin(), modes->values.end(),
                                    share * frequency * frequency) -
                   modes->values.begin();
        };
        for (int attempt = 0; attempt < 3 && below(1 + count_rounding) < count; ++attempt)
            modes = model_->exact_modes_up_to(count + 10 * (attempt + 1), 0.0, watch_);
        if (count < below(1 - count_rounding) || count > below(1 + count_rounding))
            throw Error(
                status::eigensolver,
                format("%lld open modes were found below %.6g Hz where the Sturm sequence counts %lld",
                       static_cast<long long>(below(1)), frequency / (2 * M_PI),
                       static_cast<long long>(count)));
        space_->counts_verified = true;
        return modes;
    }

    // Of a space that may reach less far; modes of a solid are some square of the frequency.
    std::int64_t limited_count(double &frequency) {
        std::int64_t count = verified_count(frequency);
        while (count > limits_.most_modes && highest_ > limits_.least_frequency) {
            const double share = 0.95 * std::sqrt(static_cast<double>(limits_.most_modes) / count);
            highest_ = std::max(limits_.least_frequency, share * highest_);
            space_->highest_frequency = highest_;
            frequency = cutoff();
            count = verified_count(frequency);
        }
        return count;
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
    void leave_out_followers() {
        const vector<double> &values = responses_->modes->values;
        const double flexible = flexible_eigenvalue(values);
        reach_ = highest_ > 0 ? highest_ : far_above_the_first * std::sqrt(flexible);
        const double limit = reach_ * reach_ / negligible_inertia;
        const std::int64_t kept = std::lower_bound(values.begin(), values.end(), limit) - values.begin();
        if (kept < responses_->modes->count())
            responses_ =
                std::make_shared<const StaticResponses>(outside_first_modes(*model_, *responses_, kept));
    }

    double flexible_eigenvalue(const vector<double> &values) const {
        const std::size_t rigid = static_cast<std::size_t>(model_->n_rigid());
        return rigid < values.size() ? values[rigid] : 1.0;
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
        n_contact_probes_ = signs.cols();
        for (const auto &entry : model_->excitation()) probes_.append(entry.second.real);
        if (probes_.empty()) return;
        const ExactModes &modes = *responses_->modes;
        const Matrix modal = gram(modes.vectors, probes_);
        modes.take_from_forces(probes_); // only the part outside the exact modes can be wrong
        probe_response_ = probes_;
        respond_outside(*model_, modes, probe_response_);
        probe_compliance_ = column_products(probes_, probe_response_);
        for (std::int64_t j = 0; j < modal.cols(); ++j)
            for (std::int64_t k = 0; k < modal.rows(); ++k)
                probe_compliance_[j] += modal(k, j) * modal(k, j) / (modes.values[k] + sigma_);
    }

    // Largest relative errors of the probes' receptances at the highest frequency: with r the full residual
    // of the Galerkin answer x, it is off by r' (K - w^2 M)^-1 r, and by x' r as far as the small matrices
    // are.
    ReceptanceError receptance_error(const AttachmentBasis &attached) const {
        if (attached.size() == 0 || probes_.empty()) return {};
        const double square = highest_ * highest_ + sigma_;
        const SymmetricEigen &ritz = attached.ritz();
        Matrix z = product('T', 'N', ritz.vectors, attached.products(probes_, probe_response_));
        for (std::int64_t j = 0; j < z.cols(); ++j)
            for (std::int64_t k = 0; k < z.rows(); ++k) z(k, j) /= 1 - square * ritz.values[k];
        const Field x = attached.combine(product('N', 'N', ritz.vectors, z));
        Field r = probes_;
        add(-1.0, model_->shifted_times(x), r);
        add(square, model_->mass_times(x), r);
        Field e = r;
        model_->solve(e);
        const vector<double> missing = column_products(r, e), inconsistent = column_products(x, r);
        const double amplification = 1 / std::max(1e-3, 1 - square * ritz.values.front());
        ReceptanceError worst;
        for (std::size_t p = 0; p < missing.size(); ++p) {
            double &of = static_cast<std::int64_t>(p) < n_contact_probes_ ? worst.contact : worst.loads;
            if (probe_compliance_[p] > 0)
                of = std::max(of, (std::abs(missing[p]) * amplification + std::abs(inconsistent[p])) /
                                      probe_compliance_[p]);
        }
        return worst;
    }

    // Exact modes and attachment vectors by frequency, then what has no mass.
    void assemble(AttachmentBasis &attached) {
        const ExactModes &modes = *responses_->modes;
        const RitzVectors ritz = coordinates(attached);
        space_->n_exact_modes = modes.count();
        space_->n_massless = ritz.n_massless;
        vector<double> lambda(modes.values);
        lambda.insert(lambda.end(), ritz.lambda.begin(), ritz.lambda.end());
        vector<std::int64_t> order(lambda.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end() - space_->n_massless,
                         [&](auto i, auto j) { return lambda[i] < lambda[j]; });
        for (std::int64_t j : order) space_->lambda.push_back(lambda[j]);
        put_vectors(attached, ritz.vectors, order);
        describe(attached);
        project_onto(*space_);
        watch_.log(1, "contact space: " + space_->description);
    }

    RitzVectors coordinates(const AttachmentBasis &attached) const {
        const std::int64_t a = attached.size();
        const SymmetricEigen &ritz = attached.ritz();
        vector<double> mu(ritz.values.rbegin(), ritz.values.rend());
        Matrix y(a, a);
        for (std::int64_t j = 0; j < a; ++j) std::copy_n(ritz.vectors.col(a - 1 - j), a, y.col(j));
        return ritz_vectors(mu, y, sigma_, reach_);
    }

    // y: of the attachment vectors; order: of them after the modes.
    void put_vectors(AttachmentBasis &attached, const Matrix &y, const vector<std::int64_t> &order) {
        const std::int64_t m = static_cast<std::int64_t>(order.size()), p = responses_->modes->count();
        Matrix of_modes(p, m), of_attached(y.rows(), m);
        for (std::int64_t j = 0; j < m; ++j)
            if (order[j] < p)
                of_modes(order[j], j) = 1;
            else
                std::copy_n(y.col(order[j] - p), y.rows(), of_attached.col(j));
        space_->gap = gaps(of_modes, product('N', 'N', attached.works(), of_attached));
        Matrix of_responses = product('N', 'N', attached.of_responses(), of_attached),
               of_further = product('N', 'N', attached.of_further(), of_attached);
        space_->vectors =
            SpaceVectors({model_, responses_->modes, std::move(of_modes), std::move(of_responses),
                          std::make_shared<const Field>(attached.take_further()), std::move(of_further)});
    }

    // B V: works: of contact forces, and then loads, on the attachment vectors.
    Matrix gaps(const Matrix &of_modes, const Matrix &works) const {
        Matrix gap = product('N', 'N', model_->gap_rows().of(responses_->modes->vectors), of_modes);
        for (std::int64_t j = 0; j < gap.cols(); ++j)
            for (std::int64_t i = 0; i < gap.rows(); ++i) gap(i, j) += works(i, j);
        return gap;
    }

    void describe(const AttachmentBasis &attached) {
        const ExactModes &modes = *responses_->modes;
        const double last = modes.values.empty() ? 0 : modes.values.back();
        space_->description = format(
            "%lld open modes up to %.6g Hz and %lld contact attachment vectors in %lld block(s)%s; "
            "receptance "
            "error %.1e at %.6g Hz",
            static_cast<long long>(modes.count()), std::sqrt(last) / (2 * M_PI),
            static_cast<long long>(attached.size()), static_cast<long long>(attached.n_blocks()),
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
    SpaceLimits limits_;
    Watch watch_;
    double sigma_;
    std::shared_ptr<const StaticResponses> responses_; // outside the exact modes of the space
    double reach_ = 0;                                 // rad/s, of the highest frequency of interest
    std::int64_t n_contact_probes_ = 0;                // the first ones
    Field probes_, probe_response_;   // loads by which the error is measured, outside the exact modes
    vector<double> probe_compliance_; // of the whole loads
};

} // namespace

std::shared_ptr<const Space> make_contact_space(std::shared_ptr<const Model> model, double highest_frequency,
                                                std::int64_t least_modes, Watch watch,
                                                std::shared_ptr<const Space> previous,
                                                const SpaceLimits &limits) {
    const std::int64_t least = std::min(least_modes, model->n_free());
    if (previous && previous->highest_frequency >= highest_frequency && previous->n_exact_modes >= least &&
        (limits.provisional || previous->counts_verified || !previous->responses->modes->may_miss_copies))
        return previous;
    const auto begin = std::chrono::steady_clock::now();
    const std::shared_ptr<Space> space =
        ContactSpaceBuilder(std::move(model), highest_frequency, least_modes, watch, previous.get(), limits)
            .build();
    space->seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() +
                     (previous ? previous->seconds : 0);
    return space;
}

} // namespace plm
