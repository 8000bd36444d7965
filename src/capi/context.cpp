#include "capi/context.hpp"

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

} // namespace

HostSolver SolverBinding::for_core() {
    return {host_factor, host_solve, host_free_factor, this, inertia ? host_inertia : nullptr};
}

std::shared_ptr<SolverBinding> Context::bind_solver() {
    return solver.factor ? std::make_shared<SolverBinding>(solver) : nullptr;
}

void Context::HostMonitor::log(int level, const std::string &text) {
    if (!context.log) return;
    const HostCode host(context);
    context.log(context.handle, level, text.c_str(), context.log_user);
}

bool Context::HostMonitor::progress(const char *now, double done) {
    if (!context.progress) return false;
    if (stage != now) stage = now;
    fraction = done;
    const HostCode host(context);
    return context.progress(context.handle, stage.c_str(), fraction, context.progress_user) != 0;
}

} // namespace plm::capi
