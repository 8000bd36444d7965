// A neighbouring path that is known, such as the curve of another force level: what it tells of where a path
// goes on. The path is followed as any other; its steps may only be longer where they end as foreseen.
#pragma once
#include "paths/metric.hpp"
#include <functional>
#include <vector>

namespace plm {

class PathGuide {
  public:
    /// Of the points of the neighbouring path, in order: a point in the unknowns of now.
    using PointOf = std::function<PathState(std::size_t)>;
    PathGuide(std::size_t n_points, PointOf point_of) : n_(n_points), point_of_(std::move(point_of)) {}

    /// From a point of the path and the direction in which it goes on: a point close to the path, about
    /// across from one of the neighbouring path, as far as `longest` if there is one, and the direction
    /// there. False: nothing is known.
    bool foresee(const PathState &now, const PathState &tangent, const Metric &metric, double longest,
                 PathState &next, PathState &direction);

  private:
    /// From a point of the neighbouring path to the path.
    struct Offset {
        std::size_t at;
        PathState way;
    };
    const PathState &point(std::size_t i);
    PathState direction_at(std::size_t i, const Metric &metric);
    void place(const PathState &now, const Metric &metric);
    PathState offset_at(std::size_t i, const Metric &metric);

    std::size_t n_;
    PointOf point_of_;
    std::vector<PathState> points_; // of those asked for
    std::vector<Offset> known_;     // the last few, the last one where the path is
    std::size_t foreseen_ = 0, n_missed_ = 0;
};

} // namespace plm
