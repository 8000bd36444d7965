// Phase-resonant response: the periodic solutions whose displacement stands in quadrature to the force,
// Re(F^H q) = 0 in the lowest harmonic h of the excitation (q: the displacement that does work against it),
// so that no drive point need be named. Followed over the force they are the backbone of a resonance
// (Peeters, Kerschen and Golinval 2011); where the force they need is not monotonic in amplitude, an isolated
// branch exists.
#pragma once
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"

namespace plm {

struct BackboneOptions {
    HbmOptions hbm;            // n_harmonics > 0; its force_scale is the force whose crossings are wanted
    double force_max = 0;      // the backbone is followed up to this force scale; 0: 8 force_scale
    bool exact = false;        // of exact motions: the model has P_0 = P
    bool only_special = false; // of the points, where it begins, crosses the force asked for, and folds
};

struct Backbone {
    std::shared_ptr<Branch> branch; // points by increasing arc length, each with its force scale and omega;
                                    // folds (PLM_BIFURCATION_FOLD) are the extrema of the force
    vector<std::size_t> crossings;  // points of `branch` at the force scale asked for
    std::int64_t n_passed = 0;      // points, kept or not
};

/// A resonance's peak over the stiffness of the contact.
struct StiffnessPath {
    std::shared_ptr<Branch> branch;
    vector<double> factor; // on the stiffness of every pair, of each point
};

/// Finds and follows phase-resonant solutions.
class PhaseResonance {
  public:
    PhaseResonance(std::shared_ptr<const ReducedModel> reduced, const BackboneOptions &options, Watch watch);

    /// Newton's method for (x, omega) at a given force scale. False: `point` is unchanged.
    bool correct(double force, BranchPoint &point) const;
    /// The backbones that begin at the resonances about rest inside the frequency range. None for a structure
    /// that touches without pre-load: the force changes nothing but the size there. Where the effort is
    /// spent, those found by then.
    std::vector<Backbone> backbones() const;
    /// The backbone through a phase-resonant point, to both sides.
    Backbone through(const BranchPoint &point) const;
    /// On from a phase-resonant point at the force asked for, to the side where the force grows, down to no
    /// force.
    Backbone onward(const BranchPoint &point) const;
    /// From a phase-resonant motion of harmonic balance at the force asked for, to `factor` times the
    /// stiffness.
    StiffnessPath over_stiffness(const BranchPoint &peak, double factor) const;
    /// The phase-resonant points of a response curve at its force, in the order of the curve.
    std::vector<BranchPoint> on_curve(const Branch &curve) const;

  private:
    struct Followed;
    std::shared_ptr<Branch> new_branch() const;
    Backbone follow(const BranchPoint &start, bool upward, double low) const;
    Backbone upward_from(const BranchPoint &start) const;

    std::shared_ptr<const ReducedModel> reduced_;
    BackboneOptions options_;
    Watch watch_;
};

} // namespace plm
