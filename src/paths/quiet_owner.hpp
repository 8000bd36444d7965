// Of a path that is a means only: nothing is kept.
#pragma once
#include "linalg/monitor.hpp"
#include "paths/path.hpp"

namespace plm {

class QuietOwner final : public PathOwner {
  public:
    explicit QuietOwner(Watch watch) : watch_(watch) {}
    void record(const PathPoint &) override {}
    bool cancelled(double fraction) override {
        watch_.step("start", fraction);
        return false;
    }
    bool rescue(double, vector<double> &) override { return false; }

  private:
    Watch watch_;
};

} // namespace plm
