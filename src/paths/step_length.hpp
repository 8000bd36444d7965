// The length of the next step of a path.
#pragma once
#include "paths/newton.hpp"

namespace plm {

/// Against the last one, by how it turned (angle between neighbouring tangents) and was corrected.
double step_growth(double angle, const NewtonOutcome &out);
/// How far it may go for the owner's test functions, those behind fold and branch point. moved: what led from
/// the old ones to those of now.
double way_to_change(const vector<double> &old_tests, const vector<double> &tests, double moved,
                     double max_step);

} // namespace plm
