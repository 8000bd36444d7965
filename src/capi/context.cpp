#include "capi/context.hpp"
#include <algorithm>
#include <cstring>
#include <limits>

namespace plm::capi {
namespace {

// How the core's plain callbacks reach the host's.
int host_factor(std::int64_t n, const std::int64_t *ptr, const std::int64_t *row, const double *val,
                int positive_definite, void **handle, void *user) {
    const SolverBinding &s = *static_cast<SolverBinding *>(user);
    const HostCode host(*s.context);
    return s.factor(s.context->handle, n, ptr, row, val, positive_definite, handle, s.user);
}
int host_solve(void *handle, std::int64_t nrhs, double *x, std::int64_t ldx, void *user) {
    const SolverBinding &s = *static_cast<SolverBinding *>(user);
    const HostCode host(*s.context);
    return s.solve(s.context->handle, handle, nrhs, x, ldx, s.user);
}
void host_free_factor(void *handle, void *user) {
    const SolverBinding &s = *static_cast<SolverBinding *>(user);
    const HostCode host(*s.context);
    s.release(s.context->handle, handle, s.user);
}
int host_inertia(void *handle, std::int64_t *negative, void *user) {
    const SolverBinding &s = *static_cast<SolverBinding *>(user);
    const HostCode host(*s.context);
    return s.inertia(s.context->handle, handle, negative, s.user);
}

// Calls of which one stage tells how far they are.
struct OwnStage {
    const char *function, *stage;
};
constexpr OwnStage own_stages[] = {{"plm_hbm_sweep", "sweep"},
                                   {"plm_hbm_track_fold", "folds"},
                                   {"plm_hbm_find_nonlinear_mode", "nonlinear mode"},
                                   {"plm_hbm_find_by_marching", "search by marching"},
                                   {"plm_transient_run", "time integration"},
                                   {"plm_transient_run", "exact flow"},
                                   {"plm_study_run", "study"}};

} // namespace

HostSolver SolverBinding::for_core() {
    return {host_factor, host_solve, host_free_factor, this, inertia ? host_inertia : nullptr};
}

double Context::effort_beside(double setup) const {
    constexpr double of_a_second = 6e9; // flops as worked() is told of them
    return effort > 0 ? std::max(effort * of_a_second, setup) : std::numeric_limits<double>::infinity();
}

std::shared_ptr<SolverBinding> Context::bind_solver() {
    return solver.factor ? std::make_shared<SolverBinding>(solver) : nullptr;
}

void Context::HostMonitor::log(int level, const std::string &text) {
    if (!context.log) return;
    const HostCode host(context);
    context.log(context.handle, level, text.c_str(), context.log_user);
}

// Fractions of the call's own stage are those of the call, whatever else is done on the way. Other calls have
// many stages, and nobody knows how many: each gets half of what is left.
void Context::HostMonitor::take(double done) {
    bool has_own = false, is_own = false;
    for (const OwnStage &own : own_stages) {
        if (std::strcmp(own.function, function) != 0) continue;
        has_own = true;
        is_own = is_own || stage == own.stage;
    }
    if (has_own && !is_own) return;
    if (done < heard) base = told;
    heard = done;
    told = std::max(told, has_own ? done : base + 0.5 * (1 - base) * done);
}

bool Context::HostMonitor::progress(const char *now, double done) {
    if (!context.progress) return false;
    if (stage != now) stage = now;
    take(std::clamp(done, 0.0, 1.0));
    return goes_on();
}

bool Context::HostMonitor::goes_on() {
    const HostCode host(context);
    return context.progress(context.handle, stage.c_str(), told, context.progress_user) != 0;
}

} // namespace plm::capi
