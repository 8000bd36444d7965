// plm_context_...
#include "capi/arguments.hpp"
#include "capi/barrier.hpp"
#include "linalg/blas_host.hpp"

namespace plm::capi {
namespace {

// How the core's allocator reaches the host's.
void *host_allocate(std::size_t bytes, void *user) {
    const Context &c = *static_cast<Context *>(user);
    return c.allocate(static_cast<std::int64_t>(bytes), c.allocate_user);
}
void host_release(void *block, void *user) {
    const Context &c = *static_cast<Context *>(user);
    c.release(block, c.allocate_user);
}

plm_status create(std::int32_t api_version, plm_allocate_fn allocate, plm_release_fn release, void *user,
                  plm_context **ctx) {
    if (!ctx || api_version != PLM_API_VERSION) return PLM_ERR_ARGUMENT;
    return call_free([&]() -> plm_status {
        const BlasBuffer buffer;
        if (blas_takes_other_integers()) return PLM_ERR_NOT_BUILT; // there is no context yet to hold a text
        keep_own_blas_to_one_thread();
        auto context = std::make_shared<Context>();
        if (allocate) {
            context->allocate = allocate, context->release = release, context->allocate_user = user;
            context->allocator = {host_allocate, host_release, context.get()};
        }
        context->handle = publish(context);
        *ctx = context->handle;
        return PLM_OK;
    });
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_context_create(std::int32_t api_version, plm_context **ctx) {
    return create(api_version, nullptr, nullptr, nullptr, ctx);
}

plm_status plm_context_create_with_allocator(std::int32_t api_version, plm_allocate_fn allocate,
                                             plm_release_fn release, void *user, plm_context **ctx) {
    if (!allocate || !release) return PLM_ERR_ARGUMENT;
    return create(api_version, allocate, release, user, ctx);
}

plm_status plm_context_destroy(plm_context **ctx) {
    if (!ctx || !*ctx) return PLM_OK;
    HeldThread held;
    try {
        const std::shared_ptr<Context> context = find<Context>(*ctx);
        if (!context) return forget<Context>(ctx);
        RunningCall running(*context, held.host());
        if (!running) return running.refusal();
        for (std::shared_ptr<Object> &child : registry::remove_children(context.get())) child.reset();
        registry::remove(*ctx, Kind::context);
        *ctx = nullptr;
        return PLM_OK;
    } catch (...) {
        return record_failure("plm_context_destroy", nullptr);
    }
}

plm_status plm_context_set_threads(plm_context *ctx, std::int32_t n) {
    return call<Context>("plm_context_set_threads", ctx, [&](Context &c) {
        require_range(n, 1, 1024, "n");
        c.threads = n;
        return PLM_OK;
    });
}

plm_status plm_context_set_effort(plm_context *ctx, double seconds) {
    return call<Context>("plm_context_set_effort", ctx, [&](Context &c) {
        require_finite(seconds, "seconds");
        if (seconds < 0)
            bad_argument("seconds", -1, plm::format("seconds is %g; it must be >= 0, 0: no limit", seconds));
        c.effort = seconds;
        return PLM_OK;
    });
}

plm_status plm_context_set_log(plm_context *ctx, plm_log_fn fn, void *user) {
    return call<Context>("plm_context_set_log", ctx, [&](Context &c) {
        c.log = fn, c.log_user = user;
        return PLM_OK;
    });
}

plm_status plm_context_set_progress(plm_context *ctx, plm_progress_fn fn, void *user) {
    return call<Context>("plm_context_set_progress", ctx, [&](Context &c) {
        c.progress = fn, c.progress_user = user;
        return PLM_OK;
    });
}

plm_status plm_context_set_solver(plm_context *ctx, plm_factor_fn factor, plm_solve_fn solve,
                                  plm_free_factor_fn release, void *user) {
    return call<Context>("plm_context_set_solver", ctx, [&](Context &c) {
        const bool all = factor && solve && release, none = !factor && !solve && !release;
        if (!all && !none)
            bad_argument(!factor  ? "factor"
                         : !solve ? "solve"
                                  : "release",
                         -1, "factor, solve and release go together: pass all three or three NULLs");
        c.solver = {&c, factor, solve, release, user};
        return PLM_OK;
    });
}

plm_status plm_context_set_inertia(plm_context *ctx, plm_inertia_fn inertia) {
    return call<Context>("plm_context_set_inertia", ctx, [&](Context &c) {
        if (inertia && !c.solver.factor)
            throw plm::Error(PLM_ERR_STATE,
                             "the context has no solver of the host whose factorizations could be "
                             "counted in; set one first")
                .argument("inertia");
        c.solver.inertia = inertia;
        return PLM_OK;
    });
}

plm_status plm_context_get_error_text(plm_context *ctx, std::int64_t capacity, char *buffer,
                                      std::int64_t *needed) {
    return call<Context>("plm_context_get_error_text", ctx,
                         [&](Context &c) { return put_text(c.error.text, capacity, buffer, needed); });
}

plm_status plm_context_get_error_function(plm_context *ctx, std::int64_t capacity, char *buffer,
                                          std::int64_t *needed) {
    return call<Context>("plm_context_get_error_function", ctx,
                         [&](Context &c) { return put_text(c.error.function, capacity, buffer, needed); });
}

plm_status plm_context_get_error_argument(plm_context *ctx, std::int64_t capacity, char *buffer,
                                          std::int64_t *needed) {
    return call<Context>("plm_context_get_error_argument", ctx,
                         [&](Context &c) { return put_text(c.error.argument, capacity, buffer, needed); });
}

plm_status plm_context_get_error_info(plm_context *ctx, plm_status *status, std::int32_t *reason,
                                      std::int64_t *index, std::int64_t *library_code) {
    return call<Context>("plm_context_get_error_info", ctx, [&](Context &c) {
        if (status) *status = c.error.status;
        if (reason) *reason = c.error.reason;
        if (index) *index = c.error.index;
        if (library_code) *library_code = c.error.library_code;
        return PLM_OK;
    });
}
