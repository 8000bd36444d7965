// How the core talks to its host: log lines, progress and cancellation. All of it optional.
#pragma once
#include "error.hpp"
#include "warnings.hpp"

namespace plm {

class Monitor {
  public:
    virtual ~Monitor() = default;
    /// level: 0 detail, 1 information, 2 warning
    virtual void log(int level, const std::string &text) = 0;
    /// True: the host wants to stop.
    virtual bool progress(const char *stage, double fraction) = 0;
};

/// A monitor pointer that may be null, with the usual thing to do at each step.
class Watch {
  public:
    explicit Watch(Monitor *monitor = nullptr) : monitor_(monitor) {}
    /// The same host; what is warned of is kept in `warnings`, too, which must outlive the watch.
    Watch keeping(Warnings &warnings) const {
        Watch watch(*this);
        watch.kept_ = &warnings;
        return watch;
    }
    /// The same host, asked whether to go on and told nothing: of steps whose results are not delivered.
    Watch quiet() const {
        Watch watch(monitor_);
        watch.quiet_ = true;
        return watch;
    }
    /// Something to look at with a result that is delivered: to the log and, where one is kept, to the list.
    void warn(std::int32_t reason, const std::string &text) const {
        log(2, text);
        if (kept_) kept_->add(reason, text);
    }
    void log(int level, const std::string &text) const {
        if (monitor_ && !quiet_) monitor_->log(level, text);
    }
    bool cancelled(const char *stage, double fraction) const {
        return monitor_ && monitor_->progress(stage, fraction);
    }
    /// Throws PLM_CANCELLED when the host wants to stop.
    void step(const char *stage, double fraction) const {
        if (cancelled(stage, fraction))
            throw Error(status::cancelled, "cancelled by the progress callback").reason(reason::cancelled);
    }

  private:
    Monitor *monitor_;
    Warnings *kept_ = nullptr;
    bool quiet_ = false;
};

} // namespace plm
