// What the functions of an hbm share: the solver behind it, its branches in and out.
#pragma once
#include "capi/barrier.hpp"
#include "capi/handles.hpp"
#include "capi/outcome.hpp"

namespace plm::capi {

using BranchPtr = std::shared_ptr<const Branch>;

/// A search within so many flops: the reason of one that has no result by then is PLM_REASON_EFFORT.
template <class Search> auto within_effort(double flops, const Search &search) {
    const Effort effort(flops);
    try {
        return search();
    } catch (const Error &e) {
        if (e.reason() != PLM_REASON_EFFORT) throw;
        throw Error(PLM_ERR_CONVERGENCE, e.what()).reason(e.reason());
    }
}

/// A call of an hbm that searches.
template <class Body> plm_status search_call(const char *function, plm_hbm *hbm, const Body &body) {
    return call<HbmHandle>(function, hbm, [&](HbmHandle &h) {
        require_current(*h.basis);
        return within_effort(h.owner->effort_beside(h.basis->work), [&] { return body(h); });
    });
}

/// A solver with the options as they are now.
Hbm solver(const HbmHandle &h);
/// Of a sweep with these options, saved as the handle says; before: the branch that it goes on with, or null.
CurveRecorder curve_recorder(const HbmHandle &h, BranchPtr before);
plm_branch *publish_branch(const HbmHandle &h, BranchPtr core);
/// The result of a call goes to its caller: how it ended, or PLM_WARNING when there is something to look at,
/// which `h` keeps as that of its last call.
Outcome deliver(HbmHandle &h, BranchPtr core, plm_branch **branch);
/// The same for a call without a branch, or with one beside its status.
Outcome deliver(HbmHandle &h, Warnings warnings);
/// A branch among the arguments: of the same reduced model, since its coordinates mean nothing in another.
std::shared_ptr<BranchHandle> own_branch(const HbmHandle &h, const plm_branch *branch, const char *name);

} // namespace plm::capi
