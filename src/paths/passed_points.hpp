// Where a path has been, in a few numbers a point. A path that comes by a point of its own in the same
// direction goes round a closed curve: one of its steps has crossed over to that, where two curves come
// nearer to each other than the step could see.
#pragma once
#include "paths/metric.hpp"
#include <array>
#include <vector>

namespace plm {

constexpr double same_solution = 1e-6; // distance of two solutions that were computed twice

class PassedPoints {
  public:
    /// n: unknowns.
    explicit PassedPoints(std::int64_t n);

    void add(const Metric &metric, const PathState &at, const PathState &tangent);
    /// The first of them that a step came by in the same direction, -1: none.
    std::int64_t on_step(const Metric &metric, const PathState &before, const PathState &after,
                         const PathState &tangent) const;
    /// All of them, six numbers each, to be handed to take() of others.
    vector<double> numbers() const;
    void take(const vector<double> &numbers);
    double parameter(std::int64_t k) const { return points_[static_cast<std::size_t>(k)].at[0]; }
    /// Whether a solution at the same parameter is that point.
    bool is(std::int64_t k, const Metric &metric, const PathState &solution) const;

  private:
    // The parameter, and the unknowns' products with two fixed vectors.
    using Shadow = std::array<double, 3>;
    struct Passed {
        Shadow at, tangent;
    };

    Shadow shadow(const Metric &metric, const PathState &at) const;
    Shadow lengths(const Metric &metric) const;

    vector<double> first_, second_;
    std::vector<Passed> points_;
};

} // namespace plm
