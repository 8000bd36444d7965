// Response curves at several levels of the excitation, in one call.
#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "capi/branch_end.hpp"
#include "capi/hbm_input.hpp"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace plm::capi {
namespace {

/// What went wrong at one level, for whoever reads of all of them.
std::string at_level(double force_scale, const std::string &text) {
    return format("at force_scale %g: %s", force_scale, text.c_str());
}

class LevelSweep {
  public:
    LevelSweep(HbmHandle &h, std::int64_t n, const double *force_scale)
        : h_(h), n_(n), force_scale_(force_scale), curves_(static_cast<std::size_t>(n)) {}

    // The largest motion has the most of the basis: what its curve was followed on serves the others.
    void run() {
        std::vector<std::size_t> order(curves_.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return std::abs(force_scale_[a]) > std::abs(force_scale_[b]);
        });
        for (std::size_t i : order) {
            try {
                take(i, within_effort(h_.owner->effort_beside(h_.basis->work), [&] { return curve(i); }));
            } catch (const Error &e) { // there may be curves at other levels
                if (e.status() != PLM_ERR_CONVERGENCE && e.status() != PLM_CANCELLED) throw;
                if (n_ == 1 || (e.status() == PLM_CANCELLED && !has_curve())) throw;
                end(e.status() == PLM_CANCELLED ? PLM_CANCELLED : PLM_NOT_CONVERGED, e.reason(),
                    at_level(force_scale_[i], e.what()));
            }
            if (ended_.status == PLM_CANCELLED) break;
        }
    }

    Outcome finish(std::int64_t *count) {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        h_.found.clear();
        h_.larger.reset(); // it was the first of those before
        for (const BranchPtr &curve : curves_)
            if (curve) h_.found.push_back({curve, unknown, unknown});
        *count = static_cast<std::int64_t>(h_.found.size());
        const Outcome warned = deliver(h_, std::move(warnings_));
        return ended_.status == PLM_OK ? warned : ended_;
    }

  private:
    bool has_curve() const {
        return std::any_of(curves_.begin(), curves_.end(), [](const BranchPtr &c) { return c != nullptr; });
    }

    BranchPtr curve(std::size_t i) {
        HbmOptions options = h_.hbm_options;
        options.force_scale = force_scale_[i];
        return Hbm(built(*h_.basis), options, h_.owner->watch()).sweep(nullptr, &level_before_);
    }

    void take(std::size_t i, BranchPtr found) {
        for (const Warning &w : found->warnings.list())
            warnings_.add(w.reason, at_level(force_scale_[i], w.text));
        if (const plm_status status = end_status(found->end_reason); status != PLM_OK)
            end(status, found->end_reason, at_level(force_scale_[i], end_text(found->end_reason)));
        curves_[i] = std::move(found);
    }

    // Of several, a stop by the host counts most, then the first.
    void end(plm_status status, std::int32_t reason, const std::string &text) {
        if (ended_.status == PLM_OK || status == PLM_CANCELLED)
            ended_.status = status, ended_.reason = reason;
        ended_.text += (ended_.text.empty() ? "" : "; ") + text;
    }

    HbmHandle &h_;
    std::int64_t n_;
    const double *force_scale_;
    std::vector<BranchPtr> curves_;
    LevelBefore level_before_;
    Warnings warnings_;
    Outcome ended_ = PLM_OK;
};

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_hbm_sweep_levels(plm_hbm *hbm, std::int64_t n, const double *force_scale,
                                std::int64_t *count) {
    return call<HbmHandle>("plm_hbm_sweep_levels", hbm, [&](HbmHandle &h) {
        require_current(*h.basis);
        require_range(n, 1, 1 << 20, "n");
        require_finite_array(force_scale, n, "force_scale");
        require_pointer(count, "count");
        LevelSweep sweep(h, n, force_scale);
        sweep.run();
        return sweep.finish(count);
    });
}
