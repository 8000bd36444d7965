#include "orbits/settling.hpp"
#include <algorithm>

namespace plm {

bool Settling::quarter(double distance) {
    if (++quarters_ % (4 * period_multiple_) != 0) {
        size_ = std::max(size_, 0.5 * distance);
        return false;
    }
    change_ = size_ > 0 ? distance / size_ : distance;
    size_ = 0;
    return true;
}

} // namespace plm
