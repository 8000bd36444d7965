// When a motion has become periodic: after a span of whole periods it is back where it was.
#pragma once
#include <cstdint>

namespace plm {

class Settling {
  public:
    /// tolerance: of change(); 0: never settled. A span is period_multiple periods long.
    Settling(double tolerance, std::int64_t period_multiple)
        : tolerance_(tolerance), period_multiple_(period_multiple) {}

    /// After each quarter of a period: distance of the present state from the one at the span's beginning.
    /// True at the end of a span, which is the beginning of the next one.
    bool quarter(double distance);

    /// Distance over the last whole span, relative to the size of the motion: half of its largest distance
    /// from the span's beginning at the other quarters. -1 before a span has ended.
    double change() const { return change_; }
    bool settled() const { return change_ >= 0 && change_ < tolerance_; }

  private:
    double tolerance_;
    std::int64_t period_multiple_, quarters_ = 0;
    double size_ = 0, change_ = -1;
};

} // namespace plm
