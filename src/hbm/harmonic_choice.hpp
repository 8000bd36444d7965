// How many harmonics: to begin with, at one point, after a point; and what is said where they are too few.
#pragma once
#include "hbm/harmonic_tail.hpp"
#include "hbm/options.hpp"
#include "linalg/monitor.hpp"
#include "motions/branch.hpp"

namespace plm {

/// What a first curve is followed with: few_harmonics(), or as many as cost a second or two.
std::int64_t harmonics_of_look(const ReducedModel &reduced);

/// Where harmonics are chosen: with max_harmonics no more than those with which a curve takes minutes, since
/// a model of hundreds of coordinates and pairs takes one for a step with as many as there may be.
HbmOptions with_affordable_harmonics(const ReducedModel &reduced, HbmOptions options);

/// Options with the number of harmonics to begin with in place of 0. Throws when the harmonics of the options
/// (n_harmonics, or max_harmonics where they are chosen) do not reach all of the excitation's.
HbmOptions with_first_harmonics(const ReducedModel &reduced, const HbmOptions &options);

/// The number of harmonics that a point asks for, from what it has; `error`: harmonic_error(), `fewest`: no
/// less than this.
std::int64_t next_harmonics(const HbmOptions &limits, std::int64_t fewest, std::int64_t now,
                            const HarmonicContent &content, double error);

/// Harmonics of a point per period of the excitation: what HbmOptions::n_harmonics counts.
std::int64_t harmonics_of(const BranchPoint &point, std::int64_t period_multiple);

/// `options` with the period, the harmonics, the force and the form of the contact law by which a point of a
/// branch was solved, whatever the options say now.
HbmOptions options_at(const BranchPoint &point, std::int64_t period_multiple, const HbmOptions &options);

struct MeasuredHarmonics {
    HarmonicContent content;
    HarmonicChange change;
};
/// Sets point.harmonic_tail and harmonic_error of a solution, in the harmonics that it was solved with;
/// returns what the next ones are and what they would change.
MeasuredHarmonics measure_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                                    BranchPoint &point);

/// An error above which a point says nothing: it need not be near any solution.
constexpr double worthless_error = 0.1;
/// So at most of its points.
bool is_worthless(const Branch &curve);

/// The point with up to `wanted` harmonics, from few to many by warm starts at its frequency: a cold start
/// with many is slow, and finds less. True: all of them; otherwise as many as were reached.
bool climb_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                     std::int64_t wanted, BranchPoint &point, Watch watch);

/// Solves at the frequency of `point` with more harmonics until the next ones are negligible (or the allowed
/// number is reached): what one point needs. Where no number is enough, `point` keeps the one that is best;
/// its harmonic_error says by how much it misses.
void settle_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                      BranchPoint &point, Watch watch = Watch());

/// The branch says at how many of its points "harmonic_tolerance" was not reached, and by how much, where
/// harmonics were chosen. Not said again when it was said.
void warn_of_harmonics(const HbmOptions &options, Branch &branch);
/// The same for one point and the error of what was asked for there.
void warn_of_harmonics(const HbmOptions &options, double error, Branch &branch);
/// The same for a branch of one point, a result at one DOF with a number of harmonics that the host has
/// given.
void warn_of_given_harmonics(std::shared_ptr<const ReducedModel> reduced, const HbmOptions &options,
                             std::int64_t dof, Measure measure, std::int64_t harmonic, Branch &one);

/// The same for a backbone, all points of which have one number of harmonics.
void warn_of_backbone(const HbmOptions &options, Watch watch, Branch &backbone);

} // namespace plm
