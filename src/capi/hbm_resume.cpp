// Sweeps that are saved while they are followed, and go on later.
#include "capi/arguments.hpp"
#include "capi/bytes.hpp"
#include "capi/hbm_input.hpp"
#include "capi/keys.hpp"
#include "linalg/whole_file.hpp"

namespace plm::capi {
namespace {

/// Of a sweep: all but how many points it may have.
std::string options_text(const HbmHandle &h) {
    HbmOptions options = h.hbm_options;
    options.max_points = HbmOptions().max_points;
    return changed_options(Kind::hbm, &options);
}

void require_can_go_on(const HbmHandle &h, const Branch &branch) {
    if (!can_go_on(branch.end_reason))
        bad_argument(
            "branch", -1,
            format("there is nothing to go on with: the curve %s", end_text(branch.end_reason).c_str()));
    if (!branch.record)
        bad_argument("branch", -1,
                     "only a curve that was swept at one level, or resumed, can go on; sweep anew");
    const std::string now = options_text(h), before = branch.record->options;
    if (now != before)
        bad_argument(
            "hbm", -1,
            format("the curve was swept with other options: %s; those of this hbm are: %s. Set the same "
                   "ones (\"max_points\" may differ)",
                   before.empty() ? "the defaults" : before.c_str(),
                   now.empty() ? "the defaults" : now.c_str()));
    const auto n = static_cast<std::int64_t>(branch.points().size());
    if (branch.end_reason == PLM_REASON_POINT_LIMIT && h.hbm_options.max_points <= n)
        bad_argument(
            "hbm", -1,
            format("the curve ended with %lld points, all that \"max_points\" allows; raise that to go on",
                   static_cast<long long>(n)));
}

} // namespace

CurveRecorder curve_recorder(const HbmHandle &h, BranchPtr before) {
    CurveRecorder::Save save;
    if (h.save_every > 0)
        save = [path = h.save_path](const Branch &branch) { write_whole_file(path, branch_bytes(branch)); };
    return CurveRecorder(std::move(before), options_text(h), h.save_every, std::move(save));
}

} // namespace plm::capi

using namespace plm::capi;

plm_status plm_hbm_save_every(plm_hbm *hbm, std::int64_t n_points, const char *path) {
    return call<HbmHandle>("plm_hbm_save_every", hbm, [&](HbmHandle &h) {
        require_range(n_points, 0, INT64_MAX, "n_points");
        if (n_points > 0) {
            require_pointer(path, "path");
            plm::require_writable(path);
        }
        h.save_path = n_points > 0 ? path : "";
        h.save_every = n_points;
        return PLM_OK;
    });
}

plm_status plm_hbm_resume(plm_hbm *hbm, plm_branch *branch, plm_branch **resumed) {
    return search_call("plm_hbm_resume", hbm, [&](HbmHandle &h) {
        require_pointer(resumed, "resumed");
        const BranchPtr before = own_branch(h, branch, "branch")->core;
        require_can_go_on(h, *before);
        plm::CurveRecorder recorder = curve_recorder(h, before);
        return deliver(h, solver(h).sweep(recorder), resumed);
    });
}
