#include "motions/curve_recorder.hpp"
#include "linalg/work.hpp"
#include "motions/branch.hpp"
#include <algorithm>

namespace plm {

bool can_go_on(std::int32_t end_reason) {
    return end_reason == reason::cancelled || end_reason == reason::effort ||
           end_reason == reason::point_limit || end_reason == reason::unfinished;
}

CurveRecorder::CurveRecorder(std::shared_ptr<const Branch> before, std::string options, std::int64_t every,
                             Save save)
    : before_(std::move(before)), every_(every), save_(std::move(save)) {
    record_.options = std::move(options);
    if (before_ && !before_->record) before_ = nullptr;
}

bool CurveRecorder::begin(std::int64_t max_points, Branch &branch) {
    const std::size_t index = record_.curves.size();
    const double allowed = effort_left();
    began_ = work_done();
    attempt_ = n_saved_ = 0;
    resumed_ = nullptr;
    record_.curves.emplace_back();
    record_.curves.back().allowed = allowed;
    if (!before_ || index >= before_->record->curves.size()) return false;
    const FollowedCurve &known = before_->record->curves[index];
    const Branch &curve = known.curve ? *known.curve : *before_;
    if (is_over(known, curve, max_points)) {
        branch = curve;
        branch.warnings = known.warnings;
        branch.record = nullptr;
        record_.curves.back() = known;
        record_.curves.back().curve = std::make_shared<const Branch>(branch);
        // where the effort ended with it, what comes next finds that out
        within(INFINITY, [&] { add_work(known.work); });
        return true;
    }
    if (known.progress.n_points > 0) go_on(known, curve, branch);
    before_ = nullptr; // what came after it was another curve's sequel
    return false;
}

// Whether it would end as it did.
bool CurveRecorder::is_over(const FollowedCurve &known, const Branch &curve, std::int64_t max_points) const {
    switch (curve.end_reason) {
    case reason::cancelled:
    case reason::unfinished:
        return false;
    case reason::point_limit:
        return static_cast<std::int64_t>(curve.points().size()) >= max_points;
    case reason::effort:
        return record_.curves.back().allowed <= known.allowed;
    default:
        return true;
    }
}

void CurveRecorder::go_on(const FollowedCurve &known, const Branch &curve, Branch &branch) {
    known_ = known.progress;
    resumed_ = &known_;
    attempt_ = known_.attempt;
    record_.curves.back().progress = known_;
    branch = curve;
    branch.record = nullptr;
    branch.beside = nullptr;
    branch.truncate(known_.n_points);
    branch.end_reason = reason::none;
    branch.newton_work = known_.newton_work;
    branch.failed_steps = known_.failed_steps;
    branch.warnings = known.warnings;
    add_work(known_.work);
}

void CurveRecorder::begin_again(std::int64_t attempt) {
    attempt_ = attempt;
    n_saved_ = 0;
    resumed_ = nullptr;
    record_.curves.back().progress = {};
    record_.curves.back().progress.attempt = attempt;
}

void CurveRecorder::pass(const Branch &branch) {
    const auto n = static_cast<std::int64_t>(branch.points().size());
    n_saved_ = std::min(n_saved_, n); // points may have been taken back
    if (!save_ || n - n_saved_ < every_) return;
    Branch now = branch;
    now.end_reason = reason::unfinished;
    record_.curves.back().warnings = branch.warnings;
    record_.curves.back().work = work_done() - began_;
    now.record = std::make_shared<const SweepRecord>(record_);
    save(now);
    n_saved_ = n;
}

void CurveRecorder::stand(CurveProgress at, const Branch &branch) {
    at.work = work_done() - began_;
    at.attempt = attempt_;
    record_.curves.back().progress = std::move(at);
    pass(branch);
}

void CurveRecorder::end(const Branch &branch) {
    FollowedCurve &followed = record_.curves.back();
    followed.curve = std::make_shared<const Branch>(branch);
    followed.warnings = branch.warnings;
    followed.work = work_done() - began_;
}

void CurveRecorder::finish(Branch &curve) {
    if (can_go_on(curve.end_reason) && !record_.curves.empty()) {
        // the last one is hardly ever anything but the answer itself
        std::shared_ptr<const Branch> &last = record_.curves.back().curve;
        if (last && last->reduced_model() == curve.reduced_model() && last->end_reason == curve.end_reason &&
            last->points().size() == curve.points().size() &&
            last->points().back().arclength == curve.points().back().arclength)
            last = nullptr;
        curve.record = std::make_shared<const SweepRecord>(std::move(record_));
    }
    if (!save_) return;
    save(curve);
    if (!failure_.empty()) curve.warnings.add(reason::not_saved, failure_);
}

// A disk that is full is no reason to lose a curve.
void CurveRecorder::save(const Branch &branch) {
    try {
        save_(branch);
        failure_.clear();
    } catch (const Error &e) {
        if (e.status() == status::memory) throw;
        failure_ = std::string("the curve was not saved: ") + e.what();
    }
}

} // namespace plm
