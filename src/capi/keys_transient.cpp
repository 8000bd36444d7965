#include "capi/keys.hpp"
#include "capi/transient_results.hpp"

namespace plm::capi {
namespace {

using H = TransientHandle;

std::int64_t stability(const H &h) {
    const PeriodicMotion &motion = periodic_motion(h);
    if (motion.multipliers.empty()) return -1;
    return std::abs(motion.multipliers.front()) < 1;
}

void add_options(std::vector<Key> &keys) {
    using O = TransientOptions;
    keys.insert(
        keys.end(),
        {
            real_option<&O::frequency_hz>("frequency_hz", 0, huge,
                                          "frequency of the excitation (Hz); 0: not set yet"),
            real_option<&O::force_scale>("force_scale", -huge, huge,
                                         "factor on the excitation, not on the pre-load"),
            int_option<&O::periods>("periods", 1, 1e9, "periods of the excitation in a run"),
            real_option<&O::settled>("settled", 0, 1,
                                     "a run ends when \"change\" is below; 0: after \"periods\" only"),
            int_option<&O::period_multiple>(
                "period_multiple", 1, 1000,
                "excitation periods in a period of the motion looked for; start_at takes the branch's"),
            int_option<&O::steps_per_period>(
                "steps_per_period", 4, 1e6,
                "instants recorded in a period of the excitation; for a full model also the time steps"),
            real_option<&O::hht_alpha>("hht_alpha", 0, 1.0 / 3,
                                       "full model: numerical damping (Hilber, Hughes, Taylor); 0: none"),
            real_option<&O::tolerance>("tolerance", 1e-15, 1e-2,
                                       "find_periodic: \"periodicity_defect\" to be reached"),
            int_option<&O::max_iterations>("max_iterations", 0, 10000, "find_periodic: Newton iterations"),
            choice_option<&O::march_when_stuck>("march_when_stuck", "off,on",
                                                "find_periodic: march some periods, towards a stable motion, "
                                                "where Newton's method gets stuck"),
        });
}

void add_run_results(std::vector<Key> &keys) {
    keys.insert(
        keys.end(),
        {
            result<H>("motion", "reduced: by the exact flow; full: by Newmark's method",
                      [](const H &h) { return std::string(h.basis ? "reduced" : "full"); }),
            result<H>("present_time", "time of the present state since it was set (s)",
                      [](const H &h) { return h.core ? h.core->time() : 0.0; }),
            result<H>("n_observed", "DOFs recorded by the last run",
                      [](const H &h) { return static_cast<std::int64_t>(last_run(h).observed.size()); }),
            result<H>("observed", "their numbers, from 0", [](const H &h) { return last_run(h).observed; }),
            result<H>("time", "instants of the histories of the last run (s)",
                      [](const H &h) { return last_run(h).time; }),
            result<H>("periods_done", "whole periods of the excitation marched by the last run",
                      [](const H &h) { return last_run(h).periods; }),
            result<H>(
                "change",
                "change of the state over the last \"period_multiple\" periods, relative to the size of "
                "the motion; -1: not known",
                [](const H &h) { return last_run(h).change; }),
            result<H>("is_settled", "1 when \"settled\" ended the last run",
                      [](const H &h) { return std::int64_t(last_run(h).settled); }),
            result<H>("n_events", "pairs that opened or closed in the last run, all together",
                      [](const H &h) { return last_run(h).n_events; }),
            result<H>("contact_iterations", "full model: iterations on the contact forces in the last run",
                      [](const H &h) { return last_run(h).contact_iterations; }),
            result<H>("seconds", "time of computation of the last run (s)",
                      [](const H &h) { return last_run(h).seconds; }),
        });
}

void add_periodic_results(std::vector<Key> &keys) {
    keys.insert(
        keys.end(),
        {
            result<H>("iterations", "Newton iterations of the last find_periodic",
                      [](const H &h) { return periodic_motion(h).iterations; }),
            result<H>("is_periodic", "1 when the last find_periodic converged",
                      [](const H &h) { return std::int64_t(periodic_motion(h).converged); }),
            result<H>(
                "periodicity_defect",
                "|state after a period - state| over the size of the motion, of the state find_periodic left",
                [](const H &h) { return periodic_motion(h).defect; }),
            result<H>("stable", "1 stable, 0 unstable, of the motion find_periodic found; -1: nothing moves",
                      stability),
            result<H>("periodic_seconds", "time of computation of the last find_periodic (s)",
                      [](const H &h) { return periodic_motion(h).seconds; }),
        });
}

} // namespace

const std::vector<Key> &transient_keys() {
    static const std::vector<Key> keys = [] {
        std::vector<Key> all;
        add_options(all);
        add_run_results(all);
        add_periodic_results(all);
        return all;
    }();
    return keys;
}

} // namespace plm::capi
