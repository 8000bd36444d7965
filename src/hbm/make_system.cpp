#include "hbm/make_system.hpp"
#include "hbm/formulation.hpp"
#include "hbm/wrapped_system.hpp"
#include <algorithm>
#include <cmath>

namespace plm {

std::unique_ptr<ContactForce> make_contact_force(const HbmOptions &options, std::int64_t n_pairs) {
    return options.aft == AftKind::event
               ? make_event_force(options.n_harmonics, n_pairs)
               : make_sampled_force(options.n_harmonics, options.time_samples, n_pairs);
}

double harmonic_step_flops(const ReducedModel &reduced, std::int64_t n_harmonics) {
    const double n = static_cast<double>(std::min(reduced.size(), reduced.n_pairs()) * (2 * n_harmonics + 1));
    return 2.0 / 3 * n * n * n;
}

bool prefers_modal(const ReducedModel &reduced, const HbmOptions &options) {
    const NonlinearUnknowns unknowns = options.unknowns;
    if (unknowns != NonlinearUnknowns::automatic || reduced.n_pairs() == 0)
        return unknowns == NonlinearUnknowns::modal || reduced.n_pairs() == 0;
    // The dense factorization dominates both; its order is r (2H + 1) or, at the most, Z (2H + 1).
    if (make_formulation(reduced, options).compliant) return false;
    return reduced.size() <= reduced.n_pairs();
}

namespace {

// The same structure on a period `multiple` times as long: harmonic h of the excitation is its harmonic
// multiple x h.
class SubharmonicSystem final : public WrappedSystem {
  public:
    SubharmonicSystem(std::unique_ptr<HbmSystem> inner, std::int64_t multiple)
        : WrappedSystem(*inner), owned_(std::move(inner)), multiple_(static_cast<double>(multiple)) {}
    void residual(const double *x, double omega, double *r) override {
        inner_.residual(x, omega / multiple_, r);
    }
    void parameter_derivative(double *r) override {
        inner_.parameter_derivative(r);
        for (std::int64_t i = 0; i < size(); ++i) r[i] /= multiple_;
    }
    void parameter_derivative_of_structure(double *r) override {
        inner_.parameter_derivative_of_structure(r);
        for (std::int64_t i = 0; i < size(); ++i) r[i] /= multiple_;
    }
    void linear_response(const vector<double> &coupling, double omega, double *x) override {
        inner_.linear_response(coupling, omega / multiple_, x);
    }
    void to_point(const double *x, double omega, BranchPoint &point) override {
        inner_.to_point(x, omega / multiple_, point);
        point.omega = omega;
        point.period_multiple = static_cast<std::int64_t>(multiple_);
    }
    void from_point(const BranchPoint &point, double *x) override {
        BranchPoint longer = point;
        longer.omega /= multiple_;
        inner_.from_point(longer, x);
    }

  private:
    std::unique_ptr<HbmSystem> owned_;
    double multiple_;
};

std::shared_ptr<const ReducedModel> on_longer_period(const ReducedModel &reduced, std::int64_t multiple) {
    auto longer = std::make_shared<ReducedModel>(reduced);
    // its frequency is that of the longer period
    const auto scale = [multiple](const LoadPart &part, vector<double> &real, vector<double> &imag) {
        for (vector<double> *values : {&real, &imag})
            for (double &f : *values) f *= part.growth(static_cast<double>(multiple));
    };
    longer->excitation.clear();
    for (const auto &[part, load] : reduced.excitation) {
        HarmonicLoad &longer_load =
            longer->excitation[{part.harmonic * static_cast<int>(multiple), part.power}] = load;
        scale(part, longer_load.real, longer_load.imag);
    }
    longer->contact.motion.clear();
    for (const auto &[part, gaps] : reduced.contact.motion) {
        GapHarmonic &longer_gaps =
            longer->contact.motion[{part.harmonic * static_cast<int>(multiple), part.power}] = gaps;
        scale(part, longer_gaps.real, longer_gaps.imag);
    }
    return longer;
}

} // namespace

std::unique_ptr<HbmSystem> make_system(std::shared_ptr<const ReducedModel> reduced,
                                       const HbmOptions &options) {
    const bool modal = prefers_modal(*reduced, options);
    HbmOptions inner = options;
    const std::int64_t multiple = options.period_multiple;
    if (multiple > 1) {
        inner.n_harmonics *= multiple;
        inner.time_samples *= multiple;
        reduced = on_longer_period(*reduced, multiple);
    }
    auto system =
        modal ? make_modal_system(std::move(reduced), inner) : make_gap_system(std::move(reduced), inner);
    if (multiple == 1) return system;
    return std::make_unique<SubharmonicSystem>(std::move(system), multiple);
}

} // namespace plm
