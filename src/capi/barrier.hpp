// The exception barrier through which every exported body goes. It also looks up the handle, holds the host's
// floating-point environment and the cancellation of its thread, refuses re-entry, and sets the context's
// allocator and threads.
#pragma once
#include "capi/context.hpp"
#include "capi/outcome.hpp"
#include "linalg/blas_host.hpp"
#include "linalg/parallel.hpp"
#include "linalg/work.hpp"
#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#endif

namespace plm::capi {

/// pthread_cancel() would unwind the thread from inside a call, out of a callback of the host's for one: past
/// the barrier that is the end of the process. It waits until the call is over.
class HeldCancellation {
#if defined(__unix__) || defined(__APPLE__)
  public:
    HeldCancellation() {
        pthread_setcancelstate(PTHREAD_CANCEL_DISABLE, &host_);
    }
    ~HeldCancellation() {
        pthread_setcancelstate(host_, nullptr);
    }
    HeldCancellation(const HeldCancellation &) = delete;
    /// What waits takes place here, where nothing has begun; the frames above are the host's.
    static void take_place() {
        pthread_testcancel();
    }

  private:
    int host_ = PTHREAD_CANCEL_ENABLE;
#else
  public:
    static void take_place() {}
#endif
};

/// What a call holds of the host's thread. Host programs trap floating-point exceptions, round or flush as
/// they like; numerics here run in the default environment, and the host gets its own back with the flags it
/// had.
class HeldThread {
  public:
    HeldThread() {
        std::feholdexcept(&host_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~HeldThread() { std::fesetenv(&host_); }
    HeldThread(const HeldThread &) = delete;
    std::fenv_t *host() { return &host_; }

  private:
    HeldCancellation cancellation_;
    std::fenv_t host_;
};

/// Marks the context as running; false when a call is under way already, which is then not touched.
class RunningCall {
  public:
    RunningCall(Context &context, std::fenv_t *host)
        : context_(context), mine_(!context.running.exchange(true)) {
        if (!mine_) return;
        context_.runner = std::this_thread::get_id();
        context_.host_environment = host;
    }
    ~RunningCall() {
        if (!mine_) return;
        context_.host_environment = nullptr;
        context_.runner = std::thread::id();
        context_.running = false;
    }
    RunningCall(const RunningCall &) = delete;
    explicit operator bool() const { return mine_; }
    /// Why not: this thread is inside a callback of the call under way, or that call is another thread's.
    plm_status refusal() const {
        return context_.runner.load() == std::this_thread::get_id() ? PLM_ERR_STATE : PLM_ERR_BUSY;
    }

  private:
    Context &context_;
    bool mine_;
};

/// Status for the exception being handled; details go to `context` unless it is null. Call from a catch block
/// only.
plm_status record_failure(const char *function, Context *context) noexcept;
/// The status of a call that is done; what it has to say goes to the context.
plm_status finished(const char *function, Context &context, const Outcome &outcome) noexcept;

/// An exported function on a handle of class H: body(H &) returns the status, or an Outcome. Nothing is
/// thrown; but a host that cancels its thread meanwhile has it unwound here by the next call.
template <class H, class Body> plm_status call(const char *function, typename H::Opaque *handle, Body body) {
    HeldCancellation::take_place();
    HeldThread held;
    try {
        const std::shared_ptr<H> object = find<H>(handle);
        if (!object) return PLM_ERR_HANDLE;
        Context &context = object->context();
        RunningCall running(context, held.host());
        if (!running) return running.refusal();
        context.begin(function);
        const AllocatorScope scope(&context.allocator);
        const WorkScope work(context.listener());
        const ThreadsScope threads(context.threads);
        const WorkCount own; // inside a callback, the effort of the call around it is not this one's
        try {
            const BlasBuffer buffer;
            return finished(function, context, body(*object));
        } catch (...) {
            return record_failure(function, &context);
        }
    } catch (...) {
        return record_failure(function, nullptr);
    }
}

/// An exported function that needs no context.
template <class Body> plm_status call_free(Body body) noexcept {
    HeldThread held;
    try {
        return body();
    } catch (...) {
        return record_failure("", nullptr);
    }
}

/// A handle whose object is gone already, with its context or by a copy of the handle: there is nothing to
/// do, in whatever order a host destroys things. Anything else never was a handle of this kind.
template <class H> plm_status forget(typename H::Opaque **handle) {
    if (!registry::is_gone(*handle, H::the_kind)) return PLM_ERR_HANDLE;
    *handle = nullptr;
    return PLM_OK;
}

/// plm_X_destroy.
template <class H> plm_status destroy(typename H::Opaque **handle) noexcept {
    if (!handle || !*handle) return PLM_OK;
    HeldThread held;
    try {
        std::shared_ptr<H> object = find<H>(*handle);
        if (!object) return forget<H>(handle);
        const std::shared_ptr<Context> keep = object->owner; // outlives the object's members
        RunningCall running(*keep, held.host());
        if (!running) return running.refusal();
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
