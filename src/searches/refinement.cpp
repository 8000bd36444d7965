#include "searches/refinement.hpp"
#include "linalg/work.hpp"
#include "motions/curve_verdicts.hpp"
#include "motions/error_budget.hpp"
#include "motions/motion_measures.hpp"
#include "motions/responses.hpp"
#include "reduction/basis_kind.hpp"
#include "searches/basis_error.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::int64_t points_looked_at =
    16;                                // points of a curve whose error is estimated, besides its highest
constexpr std::int64_t corrected = 60; // points whose corrected motions make the next basis
// Rounds in a row that bring nothing: an estimate that does not converge, or none that is clearly smaller.
// What is left then is not in the motions, as where the estimate itself is no nearer.
constexpr std::int64_t most_in_vain = 2;
constexpr double clearly_smaller = 0.7;

class Refiner {
  public:
    Refiner(std::shared_ptr<const Basis> start, const RefinementOptions &options, Watch watch)
        : start_(std::move(start)), options_(options), watch_(watch), full_(unreduced_basis(start_, watch)),
          pod_tolerance_(ErrorBudget(options.tolerance).refined_basis()) {}

    /// What there is when the effort is spent is the answer.
    Refinement run(std::shared_ptr<const Branch> known) {
        Refinement best;
        within(effort_left(), [&] { refine(std::move(known), best); });
        return best;
    }

  private:
    void refine(std::shared_ptr<const Branch> known, Refinement &best) {
        std::shared_ptr<const Basis> basis = start_;
        std::int64_t in_vain = 0;
        double least = INFINITY;
        for (std::int64_t round = 1;; ++round) {
            const auto branch = round == 1 && known ? std::move(known) : sweep(*basis);
            const double error = largest_error(*branch);
            watch_.log(1, format("refinement %lld: %lld columns, estimated error %.2e",
                                 static_cast<long long>(round),
                                 static_cast<long long>(basis->reduced()->size()), error));
            const bool compressed = basis->options().kind->is_compressed();
            in_vain = error < clearly_smaller * least ? 0 : in_vain + 1;
            least = std::min(least, error);
            // the first basis is never the answer: the point is to have a small one
            if (compressed && (!best.basis || error < best.error))
                best = {basis, branch, error, round, false};
            if (compressed && error <= options_.tolerance) {
                best.met = true;
                check_host_reduction(*start_->model(), options_.tolerance, error,
                                     watch_.keeping(best.warnings));
                return;
            }
            best.rounds = round;
            if (round >= options_.max_rounds || in_vain >= most_in_vain) return;
            if (compressed) pod_tolerance_ *= ErrorBudget::next_try;
            basis = compress(*branch);
        }
    }

    std::shared_ptr<const Branch> sweep(const Basis &basis) const {
        auto branch = Hbm(basis.reduced(), start_->sweep_range(), options_.hbm, watch_).sweep();
        require_unstopped(*branch);
        return branch;
    }

    double largest_error(const Branch &branch) const {
        const Output &output = options_.output;
        const std::int64_t top = branch.highest_point(output.dof, output.measure, output.harmonic);
        const double peak = std::abs(branch.amplitude(top, output.dof, output.measure, output.harmonic));
        if (!(peak > 0))
            throw Error(status::argument, "the DOF does not move on the curve; name one that does")
                .argument("dof");
        vector<std::int64_t> at = spread_over(branch, points_looked_at);
        at.push_back(top);
        const ErrorEstimator estimator(full_->reduced(), branch, options_.hbm);
        double worst = 0;
        for (std::int64_t i : at) {
            watch_.step("refinement", 0.5);
            worst = std::max(worst, basis_error(estimator, branch, i, output, peak));
            if (!std::isfinite(worst)) return worst;
        }
        return worst;
    }

    std::shared_ptr<const Basis> compress(const Branch &branch) const {
        const ErrorEstimator estimator(full_->reduced(), branch, options_.hbm);
        const auto motions =
            std::make_shared<Branch>(full_->reduced(), options_.hbm.force_scale, branch.period_multiple());
        for (std::int64_t i : spread_over(branch, corrected)) {
            watch_.step("refinement", 0.7);
            motions->append(estimator.corrected(i));
        }
        const Responses responses = responses_of({motions});
        BasisOptions o = start_->options();
        o.kind = &basis_kinds::pod;
        o.pod_size = 0;
        o.n_pairs_carried = 0; // what node sampling leaves out is part of the error to be met
        o.pod_tolerance = pod_tolerance_;
        return std::make_shared<const Basis>(start_->model(), start_->sampler(), full_, o, watch_,
                                             &responses);
    }

    std::shared_ptr<const Basis> start_;
    RefinementOptions options_;
    Watch watch_;
    std::shared_ptr<const Basis> full_;
    double pod_tolerance_;
};

} // namespace

Refinement refine(std::shared_ptr<const Basis> start, const RefinementOptions &options, Watch watch,
                  std::shared_ptr<const Branch> known) {
    return Refiner(std::move(start), options, watch).run(std::move(known));
}

} // namespace plm
