#include "paths/passed_points.hpp"
#include "linalg/dense.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// A step that comes by a point passes it within so much of its length, which is what a chord may stand off
// where the path hardly bends, and in nearly the same direction. Where the path bends more, the next points
// of the closed curve will do.
constexpr double beside_the_step = 0.02, same_direction = 0.98;

using Vector = std::array<double, 3>;

Vector difference(const Vector &a, const Vector &b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double product(const Vector &a, const Vector &b, const Vector &unit) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += a[i] * b[i] / (unit[i] * unit[i]);
    return sum;
}

} // namespace

PassedPoints::PassedPoints(std::int64_t n) : first_(patternless_vector(n)), second_(first_) {
    std::reverse(second_.begin(), second_.end());
}

PassedPoints::Shadow PassedPoints::shadow(const Metric &metric, const PathState &at) const {
    return {at.parameter, metric.dot(first_, at.x), metric.dot(second_, at.x)};
}

PassedPoints::Shadow PassedPoints::lengths(const Metric &metric) const {
    return {metric.width, metric.scale * std::sqrt(metric.dot(first_, first_)),
            metric.scale * std::sqrt(metric.dot(second_, second_))};
}

void PassedPoints::add(const Metric &metric, const PathState &at, const PathState &tangent) {
    points_.push_back({shadow(metric, at), shadow(metric, tangent)});
}

vector<double> PassedPoints::numbers() const {
    vector<double> all;
    for (const Passed &p : points_)
        for (const Shadow &shadow : {p.at, p.tangent}) all.insert(all.end(), shadow.begin(), shadow.end());
    return all;
}

void PassedPoints::take(const vector<double> &numbers) {
    points_.clear();
    for (std::size_t i = 0; i + 6 <= numbers.size(); i += 6)
        points_.push_back(
            {{numbers[i], numbers[i + 1], numbers[i + 2]}, {numbers[i + 3], numbers[i + 4], numbers[i + 5]}});
}

std::int64_t PassedPoints::on_step(const Metric &metric, const PathState &before, const PathState &after,
                                   const PathState &tangent) const {
    const Shadow from = shadow(metric, before), chord = difference(shadow(metric, after), from),
                 here = shadow(metric, tangent), unit = lengths(metric);
    const double square = product(chord, chord, unit), length = product(here, here, unit);
    for (std::size_t k = 0; k < points_.size(); ++k) {
        const Shadow way = difference(points_[k].at, from), &there = points_[k].tangent;
        const double along = product(chord, way, unit);
        if (!(along > 0 && along <= square)) continue;
        const double beside = product(way, way, unit) - along * along / square;
        if (!(beside < beside_the_step * beside_the_step * square)) continue;
        const double cosine = product(here, there, unit) / std::sqrt(length * product(there, there, unit));
        if (cosine > same_direction) return static_cast<std::int64_t>(k);
    }
    return -1;
}

bool PassedPoints::is(std::int64_t k, const Metric &metric, const PathState &solution) const {
    const Shadow unit = lengths(metric),
                 apart = difference(shadow(metric, solution), points_[static_cast<std::size_t>(k)].at);
    return std::sqrt(product(apart, apart, unit)) < same_solution;
}

} // namespace plm
