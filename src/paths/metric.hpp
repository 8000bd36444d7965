// Lengths and angles along a path of solutions (x, p).
#pragma once
#include "linalg/memory.hpp"
#include "paths/residual.hpp"

namespace plm {

/// A point of a path, or a direction.
struct PathState {
    vector<double> x = {};
    double parameter = 0;
};

PathState difference(const PathState &a, const PathState &b);
/// a + factor b
void add(double factor, const PathState &b, PathState &a);
void scale_by(double factor, PathState &a);

/// A length of 1 is `scale` of the unknowns, counted by Residual::weights(), or `width` of the parameter.
struct Metric {
    double scale = 1, width = 1;
    const vector<double> *weights = nullptr;
    /// Of unknowns alone, without the scale.
    double dot(const vector<double> &a, const vector<double> &b) const;
    double product(const PathState &a, const PathState &b) const;
    double length(const PathState &a) const;
    double distance(const PathState &a, const PathState &b) const;
    /// Of two directions.
    double cosine(const PathState &a, const PathState &b) const;
};

/// The direction (t, 1) of the path through the point linearized last.
PathState tangent_at(Residual &system);
/// Near the null vector of that tangent where there is one, by inverse iteration; of Euclidean length 1, or
/// not finite.
vector<double> null_direction(Residual &system);
/// The shortest way from there, where the residual's Newton step is -change, to where the path comes nearest:
/// (-change, 0) and so much of the tangent that it stands across it.
PathState step_across(const Metric &metric, const PathState &tangent, const vector<double> &change);

/// The size of a solution: of the unknowns behind static_size(), or of all where those vanish.
double size_of(const Residual &system, const vector<double> &x);

} // namespace plm
