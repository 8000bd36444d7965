// A row of the extreme table: one case, its truth, and what the library made of it.
#pragma once
#include "solver.hpp"
#include <functional>

namespace extreme {

/// What one run of a case gave, with the default or with the sampled contact forces.
struct Measured {
    double error = 1e300; // against the row's truth; what it is a share of stands in Row::truth
    std::int32_t reason = PLM_REASON_NONE;
    std::string outcome, unknowns; // unknowns of the curve: "state" where it is made of exact motions
    Work work;
    double time_limit = 0; // seconds that a sweep of `work` may take; 0: any
};

struct Row {
    std::string name, parameters;
    std::string truth;    // what the error is measured against
    double tolerance = 0; // why this one stands beside the row's definition
    bool quick = true;    // among the rows ctest runs
    std::function<Measured(bool sampled)> measure;
    bool has_sampled = true; // false: the contact forces play no part, or the case ends before them
    std::int32_t end =
        PLM_REASON_RANGE_END; // how it has to end; another one: no answer exists, and the error is 0
};

std::vector<Row> stiffness_rows(); // contact stiffness from soft to rigid
std::vector<Row> limit_rows();     // grazing, forces, damping, harmonics, always open or closed
std::vector<Row> structure_rows(); // many pairs, rigid-body modes, mass-less DOFs, units, close resonances
std::vector<Row> basis_rows();     // samples that nearly coincide
std::vector<Row> plate_rows();     // the number of harmonics on a surface
std::vector<Row> standard_rows();  // the literature's oscillator
std::vector<Row> no_answer_rows(); // the reason has to be right

/// A sweep's end in words.
Measured outcome_of(const Curve &curve);
/// Error of the peak amplitudes against exact periodic orbits started from the curve's own state: the largest
/// over the first s.n DOFs, as a share of the largest amplitude among them, and over n_points spread over the
/// curve, the highest one among them. 1e300 where no orbit is found.
struct OrbitErrors {
    double worst = 0; // of the orbits found
    int missing = 0;  // points from which none was found
};
OrbitErrors orbit_errors(const exact::Structure &s, const Curve &curve, int n_points, int samples);
double orbit_error(const exact::Structure &s, const Curve &curve, int n_points, int samples);
/// Largest relative error of the peak amplitude against the linear answer over all points.
double linear_error(const exact::Structure &s, const std::vector<bool> &closed, const Curve &curve, int dof,
                    const std::vector<double> *full_mass = nullptr);

} // namespace extreme
