#include "capi/handles.hpp"
#include "capi/keys.hpp"
#include <cmath>

namespace plm::capi {
namespace {

using B = BranchHandle;

/// One value per point of the branch.
template <class Out, class Get> Out per_point(const B &b, Get get) {
    Out out;
    for (const BranchPoint &p : built(b)->points()) out.push_back(get(p));
    return out;
}

} // namespace

const std::vector<Key> &hbm_keys() {
    using O = HbmOptions;
    static const std::vector<Key> keys = {
        int_option<&O::n_harmonics>(
            "n_harmonics", 0, 1000,
            "harmonics H of the solution, all of the excitation's; 0: as many as each "
            "point needs"),
        real_option<&O::accuracy>(
            "accuracy", 1e-12, 0.5,
            "relative error that results may have; a curve or peak that is estimated to "
            "miss it warns"),
        int_option<&O::max_harmonics>("max_harmonics", 1, 1000,
                                      "with n_harmonics = 0, or of the coefficients of an exact motion: the "
                                      "most allowed; fewer where hundreds of coordinates and pairs make a "
                                      "step with them take seconds, which the result says"),
        real_option<&O::harmonic_tolerance>(
            "harmonic_tolerance", 0, 1,
            "with n_harmonics = 0: allowed \"harmonic_error\" of a point, 0: half of \"accuracy\"; where "
            "it is not reached, the branch warns"),
        choice_option<&O::tail_correction>("tail_correction", "off,on",
                                           "add the next harmonics that follow from the exact contact force"),
        int_option<&O::period_multiple>("period_multiple", 1, 64,
                                        "excitation periods in a period of the response (sub-harmonics)"),
        choice_option<&O::motion>(
            "motion", "auto,exact,harmonics",
            "curves and their points: exact motions of the reduced model, or harmonic balance; auto: exact "
            "where that is cheaper and no option of harmonic balance is set, and where each point would take "
            "long, on the basis compressed to what its motions need within accuracy"),
        choice_option<&O::aft>(
            "aft", "event,sampled",
            "contact forces integrated between exact switching instants, or from time samples"),
        int_option<&O::time_samples>("time_samples", 8, 1 << 20,
                                     "samples per period of the sampled contact forces"),
        choice_option<&O::unknowns>("unknowns", "auto,modal,gaps",
                                    "nonlinear unknowns: reduced coordinates or contact gaps; auto: by cost"),
        choice_option<&O::formulation>("formulation", "auto,penalty,compliance",
                                       "contact law as a stiff spring, or with the force as unknown, which "
                                       "has the rigid limit; auto: by stiffness"),
        real_option<&O::frequency_min_hz>("frequency_min_hz", 0, huge,
                                          "lower end of a sweep (Hz); 0: the basis' window, an estimated end "
                                          "of which moves until the peak is "
                                          "inside"),
        real_option<&O::frequency_max_hz>("frequency_max_hz", 0, huge,
                                          "upper end of a sweep (Hz); 0: as frequency_min_hz"),
        choice_option<&O::upward>(
            "direction", "down,up",
            "a sweep starts at the upper (down) or lower (up) end; where the curve from "
            "there comes back or ends early, from the other one"),
        real_option<&O::force_scale>("force_scale", -huge, huge,
                                     "factor on the excitation, not on the pre-load"),
        real_option<&O::tolerance>(
            "tolerance", 1e-15, 1e-2,
            "last Newton correction relative to the solution; on a part of a large basis' "
            "coordinates at least 0.03 times \"accuracy\""),
        int_option<&O::max_iterations>("max_iterations", 1, 10000, "Newton iterations per point"),
        int_option<&O::max_points>("max_points", 1, 1e9, "points of a sweep"),
        real_option<&O::initial_step>("initial_step", 0, 1,
                                      "first arc-length step, 1 = the window; 0: automatic"),
        real_option<&O::min_step>("min_step", 1e-14, 1, "smallest arc-length step"),
        real_option<&O::max_step>("max_step", 1e-12, 10, "largest arc-length step"),
        choice_option<&O::stability>(
            "stability", "off,auto,floquet,hill",
            "Floquet multipliers of the exact motion beside every point, or of the point by Hill's method; "
            "auto: of the exact motion, up to 24 coordinates"),
        choice_option<&O::bifurcations>(
            "bifurcations", "off,on",
            "locate folds and branch points, with stability also period doublings and "
            "Neimark-Sacker points (the first complex pair of multipliers crosses the unit circle)"),
        result<HbmHandle>("n_found",
                          "curves found by the last search, or, of the solver that a response was computed "
                          "with in one call, beside the curve of that",
                          [](const HbmHandle &h) { return static_cast<std::int64_t>(h.found.size()); }),
        result<HbmHandle>(
            "larger_amplitude",
            "of a response computed in one call, or after a search for isolated branches beside a "
            "curve whose peak was found before: the highest stable motion known beside that "
            "curve at the same force, on the first of the curves found; 0: none is known",
            [](const HbmHandle &h) { return h.larger ? h.larger->amplitude : 0.0; }),
        result<HbmHandle>("larger_frequency_hz", "where that motion stands (Hz); 0: none is known",
                          [](const HbmHandle &h) { return h.larger ? h.larger->frequency_hz : 0.0; }),
        result<HbmHandle>("warning", "what the last call warned of; empty: nothing",
                          [](const HbmHandle &h) { return h.warnings.text(); }),
        result<HbmHandle>("warning_reason", "PLM_REASON_... of the first part of \"warning\"; 0: none",
                          [](const HbmHandle &h) {
                              return h.warnings.empty() ? std::int64_t(PLM_REASON_NONE)
                                                        : std::int64_t(h.warnings.list().front().reason);
                          }),
    };
    return keys;
}

const std::vector<Key> &branch_keys() {
    using Ints = vector<std::int64_t>;
    using Reals = vector<double>;
    static const std::vector<Key> keys = {
        result<B>("n_points", "points of the curve",
                  [](const B &b) { return static_cast<std::int64_t>(built(b)->points().size()); }),
        result<B>("n_harmonics", "harmonics H of the coefficients: the largest of all points",
                  [](const B &b) { return built(b)->n_harmonics(); }),
        result<B>("n_pairs", "contact pairs", [](const B &b) { return built(b)->reduced().n_whole_pairs(); }),
        result<B>("n_dof", "DOFs of the model",
                  [](const B &b) { return built(b)->reduced().model->n_dof(); }),
        result<B>("basis_size", "columns of the basis that it was computed on",
                  [](const B &b) { return built(b)->reduced().size(); }),
        result<B>("force_scale", "factor on the excitation",
                  [](const B &b) { return built(b)->force_scale(); }),
        result<B>(
            "frequency_hz", "frequency of every point (Hz)",
            [](const B &b) { return per_point<Reals>(b, [](auto &p) { return p.omega / (2 * M_PI); }); }),
        result<B>("arclength", "scaled arc length from the first point",
                  [](const B &b) { return per_point<Reals>(b, [](auto &p) { return p.arclength; }); }),
        result<B>("residual", "relative residual of every point",
                  [](const B &b) { return per_point<Reals>(b, [](auto &p) { return p.residual; }); }),
        result<B>("iterations", "Newton iterations of every point",
                  [](const B &b) { return per_point<Ints>(b, [](auto &p) { return p.iterations; }); }),
        result<B>("n_switching", "pairs that open and close in the period, of every point",
                  [](const B &b) { return per_point<Ints>(b, [](auto &p) { return p.n_switching; }); }),
        result<B>("point_harmonics", "harmonics every point was solved for",
                  [](const B &b) { return per_point<Ints>(b, [](auto &p) { return p.n_harmonics; }); }),
        result<B>("harmonic_tail",
                  "share of the next harmonics in the motion of the gaps, of every point; -1: unknown",
                  [](const B &b) { return per_point<Reals>(b, [](auto &p) { return p.harmonic_tail; }); }),
        result<B>(
            "harmonic_error",
            "what the next harmonics would change, of every point, by one step of Newton's method: the "
            "largest share of the whole motion, of the motion of a DOF in contact (or of 3 % of the largest "
            "such motion), or of the frequency; of an exact motion, what its coefficients leave out, as root "
            "mean squares over a period (its amplitudes are exact; a larger \"max_harmonics\" leaves out "
            "less); -1: unknown",
            [](const B &b) { return per_point<Reals>(b, [](auto &p) { return p.harmonic_error; }); }),
        result<B>("period_multiple",
                  "excitation periods in a period of the response; harmonics count from the latter",
                  [](const B &b) { return built(b)->period_multiple(); }),
        result<B>("point_force_scale", "factor on the excitation of every point",
                  [](const B &b) { return per_point<Reals>(b, [](auto &p) { return p.force_scale; }); }),
        result<B>("damping_ratio",
                  "share of critical damping, of every point of a nonlinear mode; other branches: no entry",
                  [](const B &b) {
                      return built(b)->is_mode ? per_point<Reals>(b, [](auto &p) { return p.damping_ratio; })
                                               : Reals();
                  }),
        result<B>("bifurcation", "PLM_BIFURCATION_... of every point",
                  [](const B &b) {
                      return per_point<Ints>(
                          b, [](auto &p) { return static_cast<std::int64_t>(p.bifurcation); });
                  }),
        result<B>("stable",
                  "1 stable, 0 unstable, -1 not computed, no exact motion beside it, or too close to call, "
                  "of every point",
                  [](const B &b) { return per_point<Ints>(b, [](auto &p) { return stability_of(p); }); }),
        result<B>("end_reason", "why the branch ended: PLM_REASON_...",
                  [](const B &b) { return static_cast<std::int64_t>(built(b)->end_reason); }),
        result<B>("end_text", "the same in words",
                  [](const B &b) { return end_text(built(b)->end_reason, built(b)->sampled); }),
        result<B>("newton_iterations", "Newton iterations of the whole run",
                  [](const B &b) { return built(b)->newton_work.iterations; }),
        result<B>("failed_steps", "continuation steps that were repeated",
                  [](const B &b) { return built(b)->failed_steps; }),
        result<B>("factorizations", "tangents factored",
                  [](const B &b) { return built(b)->newton_work.factorizations; }),
        result<B>("seconds", "time of the run (s)", [](const B &b) { return built(b)->seconds; }),
        result<B>("seconds_per_iteration",
                  "mean time of a Newton iteration, without stability and harmonics (s)",
                  [](const B &b) { return built(b)->seconds_per_iteration(); }),
        result<B>("unknowns", "nonlinear unknowns used: modal, gaps or both; state: exact motions",
                  [](const B &b) { return built(b)->unknowns_used; }),
        warning_text<B>([](const B &b) -> const Warnings & { return built(b)->warnings; }),
        warning_reasons<B>([](const B &b) -> const Warnings & { return built(b)->warnings; }),
    };
    return keys;
}

} // namespace plm::capi
