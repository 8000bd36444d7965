#include "paths/path_guide.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr std::size_t most_offsets = 3; // a parabola
// A path that has ended elsewhere than foreseen so often in a row is none that the neighbour knows of.
constexpr std::size_t most_missed = 3;
constexpr double farthest = 0.5; // from the neighbour, as lengths along a path count
// Cosines: of the neighbour's directions where a step begins and ends (0.55 rad, short of a corner), and of
// the way there with the path's own direction.
constexpr double turned = 0.85, forward = 0.5;

} // namespace

const PathState &PathGuide::point(std::size_t i) {
    if (points_.empty()) points_.resize(n_);
    if (points_[i].x.empty()) points_[i] = point_of_(i);
    return points_[i];
}

PathState PathGuide::direction_at(std::size_t i, const Metric &metric) {
    PathState d = difference(point(std::min(i + 1, n_ - 1)), point(i > 0 ? i - 1 : 0));
    const double length = metric.length(d);
    if (length > 0) scale_by(1 / length, d);
    return d;
}

void PathGuide::place(const PathState &now, const Metric &metric) {
    std::size_t at = known_.empty() ? 0 : known_.back().at;
    double distance = metric.distance(now, point(at));
    for (std::size_t i = at + 1; i < n_; ++i) {
        const double next = metric.distance(now, point(i));
        if (next > distance) break;
        at = i, distance = next;
    }
    PathState way = difference(now, point(at));
    const PathState along = direction_at(at, metric);
    add(-metric.product(way, along), along, way);
    if (!known_.empty() && known_.back().at == at) known_.pop_back();
    known_.push_back({at, std::move(way)});
    if (known_.size() > most_offsets) known_.erase(known_.begin());
}

// By the polynomial through the last ones.
PathState PathGuide::offset_at(std::size_t i, const Metric &metric) {
    double s[most_offsets + 1] = {};
    const std::size_t n = known_.size();
    for (std::size_t k = n; k-- > 0;) {
        const std::size_t to = k + 1 < n ? known_[k + 1].at : i;
        s[k] = k + 1 < n ? s[k + 1] : 0;
        for (std::size_t j = known_[k].at; j < to; ++j) s[k] -= metric.distance(point(j), point(j + 1));
    }
    PathState sum = known_.back().way;
    scale_by(0, sum);
    for (std::size_t k = 0; k < n; ++k) {
        double weight = 1;
        for (std::size_t j = 0; j < n; ++j)
            if (j != k) weight *= s[j] / (s[j] - s[k]);
        add(weight, known_[k].way, sum);
    }
    return sum;
}

bool PathGuide::foresee(const PathState &now, const PathState &tangent, const Metric &metric, double longest,
                        PathState &next, PathState &direction) {
    if (n_ < 2 || n_missed_ >= most_missed) return false;
    if (!points_.empty() && !known_.empty() && known_.back().way.x.size() != now.x.size()) {
        points_.clear(); // other unknowns
        known_.clear();
    }
    if (point(0).x.size() != now.x.size()) return false;
    place(now, metric);
    const std::size_t at = known_.back().at;
    n_missed_ = foreseen_ > at ? n_missed_ + 1 : 0;
    foreseen_ = 0;
    if (metric.length(known_.back().way) > farthest) return false;
    const PathState here = direction_at(at, metric);
    for (std::size_t i = at + 1; i + 1 < n_; ++i) {
        PathState there = offset_at(i, metric);
        const PathState along = direction_at(i, metric);
        add(-metric.product(there, along), along, there);
        add(1, point(i), there);
        const PathState way = difference(there, now);
        if (metric.length(way) > longest || metric.cosine(along, here) < turned) break;
        if (metric.cosine(way, tangent) < forward) continue;
        next = std::move(there);
        direction = along;
        foreseen_ = i;
    }
    return foreseen_ > 0;
}

} // namespace plm
