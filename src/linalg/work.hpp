// Long arithmetic far below whoever knows what it is for: the host hears its last stage again, and may stop
// there.
#pragma once

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
/// much work in every run; throws PLM_CANCELLED when the host wants to stop. Never call it with a lock held.
void worked(double flops);

/// Work in one piece should be no longer than this.
constexpr double piece_of_work = 3e8; // flops

} // namespace plm
