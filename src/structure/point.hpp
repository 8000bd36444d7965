// Points and vectors of space, for what is made of coordinates.
#pragma once
#include <array>
#include <cmath>

namespace plm {

using Point = std::array<double, 3>;

inline Point difference(const Point &a, const Point &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline double dot(const Point &a, const Point &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point &a, const Point &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Point &a) {
    return std::hypot(std::hypot(a[0], a[1]), a[2]);
}

} // namespace plm
