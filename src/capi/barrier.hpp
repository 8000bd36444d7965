// The exception barrier through which every exported body goes. It also looks up the handle, holds the host's
// floating-point environment, refuses re-entry, and sets the context's allocator.
#pragma once
#include "capi/context.hpp"
#include "linalg/work.hpp"

namespace plm::capi {

/// Host programs trap floating-point exceptions, round or flush as they like; numerics here run in the
/// default environment, and the host gets its own back with the flags it had.
class HeldFloatingPoint {
  public:
    HeldFloatingPoint() {
        std::feholdexcept(&host_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~HeldFloatingPoint() { std::fesetenv(&host_); }
    HeldFloatingPoint(const HeldFloatingPoint &) = delete;
    std::fenv_t *host() { return &host_; }

  private:
    std::fenv_t host_;
};

/// Marks the context as running; false when a call is under way already (from a callback, or from another
/// thread).
class RunningCall {
  public:
    RunningCall(Context &context, std::fenv_t *host)
        : context_(context), mine_(!context.running.exchange(true)) {
        if (mine_) context_.host_environment = host;
    }
    ~RunningCall() {
        if (!mine_) return;
        context_.host_environment = nullptr;
        context_.running = false;
    }
    RunningCall(const RunningCall &) = delete;
    explicit operator bool() const { return mine_; }

  private:
    Context &context_;
    bool mine_;
};

/// Status for the exception being handled; details go to `context` unless it is null. Call from a catch block
/// only.
plm_status record_failure(const char *function, Context *context) noexcept;

/// An exported function on a handle of class H: body(H &) returns the status.
template <class H, class Body>
plm_status call(const char *function, typename H::Opaque *handle, Body body) noexcept {
    HeldFloatingPoint held;
    try {
        const std::shared_ptr<H> object = find<H>(handle);
        if (!object) return PLM_ERR_HANDLE;
        Context &context = object->context();
        RunningCall running(context, held.host());
        if (!running) return PLM_ERR_STATE; // without touching the call that runs
        const AllocatorScope scope(&context.allocator);
        const WorkScope work(context.listener());
        try {
            return body(*object);
        } catch (...) {
            return record_failure(function, &context);
        }
    } catch (...) {
        return record_failure(function, nullptr);
    }
}

/// An exported function that needs no context.
template <class Body> plm_status call_free(Body body) noexcept {
    HeldFloatingPoint held;
    try {
        return body();
    } catch (...) {
        return record_failure("", nullptr);
    }
}

/// plm_X_destroy.
template <class H> plm_status destroy(typename H::Opaque **handle) noexcept {
    if (!handle || !*handle) return PLM_OK;
    HeldFloatingPoint held;
    try {
        std::shared_ptr<H> object = find<H>(*handle);
        if (!object) return PLM_ERR_HANDLE;
        const std::shared_ptr<Context> keep = object->owner; // outlives the object's members
        RunningCall running(*keep, held.host());
        if (!running) return PLM_ERR_STATE;
        registry::remove(*handle, H::the_kind);
        *handle = nullptr;
        object.reset();
        return PLM_OK;
    } catch (...) {
        return record_failure("", nullptr);
    }
}

/// A second handle among the arguments; it must belong to the same context. index: of an array's element.
template <class H>
std::shared_ptr<H> same_context(const Object &one, const typename H::Opaque *handle, const char *name,
                                std::int64_t index = -1) {
    std::shared_ptr<H> other = find<H>(handle);
    if (!other)
        throw Error(PLM_ERR_HANDLE,
                    std::string(name) + " is no live handle; was it destroyed, or never made?")
            .argument(name)
            .index(index);
    if (other->owner != one.owner)
        throw Error(PLM_ERR_HANDLE, std::string(name) + " belongs to another context; make both in one")
            .argument(name)
            .index(index);
    return other;
}

} // namespace plm::capi
