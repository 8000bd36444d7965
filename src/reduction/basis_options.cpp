#include "reduction/basis_options.hpp"
#include "linalg/error.hpp"
#include "reduction/basis_kind.hpp"
#include <cmath>
#include <string>

namespace plm {
namespace {

void demand(bool condition, const char *key, const std::string &text) {
    if (!condition) throw Error(PLM_ERR_ARGUMENT, text).argument(key);
}

} // namespace

void check_pairs(const BasisOptions &o, std::int64_t n_pairs) {
    const BasisKind &kind = *o.kind;
    demand(
        n_pairs > 0 || !kind.needs_pairs, "kind",
        format(
            "a basis of kind %s is about contact, and the model has no contact pair; \"full\" does without",
            kind.name));
    if (kind.check) kind.check(o, n_pairs);
}

void check_options(const BasisOptions &o) {
    demand(o.n_harmonics >= 1, "n_harmonics",
           format("n_harmonics is %lld; at least 1 is needed", static_cast<long long>(o.n_harmonics)));
    demand(std::isfinite(o.frequency_min_hz) && o.frequency_min_hz >= 0, "frequency_min_hz",
           format("frequency_min_hz is %g; a frequency in Hz, or 0 for the sampler's window, is wanted",
                  o.frequency_min_hz));
    demand(std::isfinite(o.frequency_max_hz) && o.frequency_max_hz >= 0, "frequency_max_hz",
           format("frequency_max_hz is %g; a frequency in Hz, or 0 for the sampler's window, is wanted",
                  o.frequency_max_hz));
    demand(std::isfinite(o.below_factor) && o.below_factor > 0, "below_factor",
           format("below_factor is %g; it must be above 0", o.below_factor));
    demand(o.svd_tolerance >= 0 && o.svd_tolerance < 1, "svd_tolerance",
           format("svd_tolerance is %g; a share of the largest singular value in [0, 1) is wanted",
                  o.svd_tolerance));
    demand(o.pod_tolerance >= 0 && o.pod_tolerance < 1, "pod_tolerance",
           format("pod_tolerance is %g; a share of the responses in [0, 1) is wanted", o.pod_tolerance));
    demand(o.pod_size >= 0, "pod_size",
           format("pod_size is %lld; it must not be negative", static_cast<long long>(o.pod_size)));
    demand(
        std::isfinite(o.equivalent_amplitude) && o.equivalent_amplitude >= 0, "equivalent_amplitude",
        format("equivalent_amplitude is %g; a length, or 0 for the resonance under the excitation, is wanted",
               o.equivalent_amplitude));
    demand(o.n_discontinuities >= 0, "n_discontinuities",
           format("n_discontinuities is %lld; it must not be negative",
                  static_cast<long long>(o.n_discontinuities)));
    demand(std::isfinite(o.rest_factor) && o.rest_factor > 0, "rest_factor",
           format("rest_factor is %g; it must be above 0", o.rest_factor));
    demand(o.n_snapshots >= 2, "n_snapshots",
           format("n_snapshots is %lld; at least 2, one of each sign, are needed",
                  static_cast<long long>(o.n_snapshots)));
    demand(
        o.snapshot_tolerance >= 0 && o.snapshot_tolerance < 1, "snapshot_tolerance",
        format("snapshot_tolerance is %g; a share of the motion in [0, 1) is wanted", o.snapshot_tolerance));
    demand(o.n_pairs_carried >= 0, "n_pairs_carried",
           format("n_pairs_carried is %lld; a number of pairs, or 0 for all of them, is wanted",
                  static_cast<long long>(o.n_pairs_carried)));
    demand(o.n_fixed_modes >= 0, "n_fixed_modes",
           format("n_fixed_modes is %lld; it must not be negative", static_cast<long long>(o.n_fixed_modes)));
}

} // namespace plm
