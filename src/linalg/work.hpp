// Long arithmetic far below whoever knows what it is for: the host hears its last stage again and may stop
// there, and what a search may cost is counted there, so that it ends after as much work on any machine.
#pragma once
#include "linalg/error.hpp"

namespace plm {

/// Who is told of work that goes on.
class WorkListener {
  public:
    virtual ~WorkListener() = default;
    /// True: the host wants to stop.
    virtual bool goes_on() = 0;
};

/// Makes `listener` the one that worked() speaks to on this thread for the life of the scope. Null: nobody.
class WorkScope {
  public:
    explicit WorkScope(WorkListener *listener);
    ~WorkScope();
    WorkScope(const WorkScope &) = delete;
    WorkScope &operator=(const WorkScope &) = delete;

  private:
    WorkListener *previous_;
    double previous_flops_;
};

/// To be told of arithmetic that may add up to seconds. The listener hears of it every 0.1 s or so, after as
/// much work in every run; throws PLM_CANCELLED when the host wants to stop, and with PLM_REASON_EFFORT when
/// an Effort is spent. Never call it with a lock held.
void worked(double flops);

/// Of a flop, what one in a product or factorization of matrices takes: LAPACK's are about as much faster.
constexpr double in_products = 0.125;

/// Work in one piece should be no longer than this.
constexpr double piece_of_work = 3e8; // flops

/// What worked() has been told of on this thread, pieces of parallel_for() included: the same in every run.
std::int64_t work_done();

/// For the life of the scope, work on this thread ends after so many flops, or with the scope around it.
class Effort {
  public:
    explicit Effort(double flops);
    ~Effort();
    Effort(const Effort &) = delete;
    Effort &operator=(const Effort &) = delete;

  private:
    std::int64_t previous_;
};

/// What the Effort scopes around this leave; infinite outside of any.
double effort_left();

/// False: f() was given up when it had cost so many flops, or all that is left.
template <class F> bool within(double flops, const F &f) {
    const Effort effort(flops);
    try {
        f();
        return true;
    } catch (const Error &e) {
        if (e.reason() != reason::effort) throw;
        return false;
    }
}

/// Work that is not held to the Effort scopes around it, nor counted there: of a helper of another thread, or
/// of another call inside a callback.
class WorkCount {
  public:
    WorkCount();
    ~WorkCount();
    std::int64_t so_far() const;
    WorkCount(const WorkCount &) = delete;
    WorkCount &operator=(const WorkCount &) = delete;

  private:
    std::int64_t done_, limit_;
};
void add_work(std::int64_t flops);

} // namespace plm
