// The context: callbacks, allocator, solver of the host, and the last error.
#pragma once
#include "capi/registry.hpp"
#include "linalg/memory.hpp"
#include "linalg/monitor.hpp"
#include "linalg/work.hpp"
#include "structure/solver/factor.hpp"
#include <atomic>
#include <cfenv>
#include <thread>

namespace plm::capi {

struct ErrorDetails {
    plm_status status = PLM_OK;
    std::int32_t reason = PLM_REASON_NONE;
    std::int64_t index = -1, library_code = 0;
    std::string function, argument, text;
};

/// The host's sparse solver as it was when a model was built; the model keeps it.
struct SolverBinding {
    Context *context = nullptr;
    plm_factor_fn factor = nullptr;
    plm_solve_fn solve = nullptr;
    plm_free_factor_fn release = nullptr;
    void *user = nullptr;
    plm_inertia_fn inertia = nullptr; // may be null with the others set
    HostSolver for_core();
};

struct Context final : Object {
    using Opaque = plm_context;
    static constexpr Kind the_kind = Kind::context;
    Context() : Object(Kind::context, nullptr), monitor(*this) {}
    Context &context() { return *this; }

    /// The callbacks' way into the core; silent when the host has set none.
    Watch watch() { return Watch(log || progress ? &monitor : nullptr); }
    /// For a WorkScope around a call.
    WorkListener *listener() { return progress ? &monitor : nullptr; }
    /// What a search may cost, flops, where its basis cost so many.
    double effort_beside(double setup) const;
    /// A call begins: its progress starts anew.
    void begin(const char *function) { monitor.begin(function); }
    /// Null when the host brings no solver.
    std::shared_ptr<SolverBinding> bind_solver();

    plm_context *handle = nullptr; // what callbacks receive
    plm_allocate_fn allocate = nullptr;
    plm_release_fn release = nullptr;
    void *allocate_user = nullptr;
    Allocator allocator; // of the core; null functions: malloc

    plm_log_fn log = nullptr;
    plm_progress_fn progress = nullptr;
    void *log_user = nullptr, *progress_user = nullptr;
    SolverBinding solver;
    std::int64_t threads = 1; // that a call may use
    double effort = 10;       // of a search, seconds of one core; 0: no limit

    ErrorDetails error;                      // of the last call that did not return PLM_OK
    std::atomic<bool> running{false};        // a call is under way
    std::atomic<std::thread::id> runner{};   // in this thread
    std::fenv_t *host_environment = nullptr; // during a call: the host's floating-point environment

  private:
    /// A call has stages, each with fractions of its own from 0 on; what the host is told never runs
    /// backwards.
    struct HostMonitor final : Monitor, WorkListener {
        explicit HostMonitor(Context &c) : context(c) {}
        void begin(const char *name) { function = name, told = base = heard = 0; }
        void log(int level, const std::string &text) override;
        bool progress(const char *stage, double fraction) override;
        bool goes_on() override;
        void take(double fraction);
        Context &context;
        const char *function = "";
        std::string stage = "working"; // what was heard last
        double heard = 0, base = 0, told = 0;
    } monitor;
};

/// For the life of the scope the host's floating-point environment is back, because host code runs.
class HostCode {
  public:
    explicit HostCode(const Context &context) : environment_(context.host_environment) {
        if (environment_) std::fesetenv(environment_);
    }
    ~HostCode() {
        if (!environment_) return;
        std::fegetenv(environment_); // flags that the callback raised are the host's
        std::fesetenv(FE_DFL_ENV);
    }
    HostCode(const HostCode &) = delete;

  private:
    std::fenv_t *environment_;
};

} // namespace plm::capi
