// How calls and curves end, and what a point of bifurcation is. The numbers are those of PLM_OK, PLM_ERR_...,
// PLM_REASON_... and PLM_BIFURCATION_... of plm.h, where each is explained; capi/status_codes.cpp holds the
// two together, and nothing below capi sees plm.h.
#pragma once
#include <cstdint>

namespace plm {

using Status = std::int32_t;

/// What a call returns.
namespace status {
enum : Status {
    ok = 0,
    not_converged = 1,
    truncated = 2,
    cancelled = 3,
    warning = 4,
    handle = -1,
    argument = -2,
    key = -3,
    state = -4,
    memory = -5,
    not_built = -6,
    matrix = -7,
    not_positive_definite = -8,
    singular = -9,
    eigensolver = -10,
    convergence = -11,
    callback = -12,
    internal = -13,
    busy = -14
};
}

/// Why, for a program that branches on it.
namespace reason {
enum : std::int32_t {
    none = 0,
    not_positive_definite = 1,
    singular = 2,
    range_end = 3,
    point_limit = 4,
    cancelled = 5,
    step_minimum = 6,
    contact_chatter = 7,
    singular_tangent = 8,
    start_failed = 9,
    no_equilibrium = 10,
    loop_closed = 11,
    basis_too_small = 12,
    turned_back = 13,
    no_peak = 14,
    harmonics_too_few = 15,
    outside_basis = 16,
    other_branch = 17,
    no_contraction = 18,
    not_finite = 19,
    unverified = 20,
    no_switching = 21,
    lost_mode = 22,
    model = 23,
    host_reduction = 24,
    unstable_peak = 25,
    crossed_over = 26,
    larger_motion = 27,
    tie = 28,
    rounded = 29,
    effort = 30,
    unfinished = 31,
    not_saved = 32
};
}

namespace bifurcation {
enum : std::int32_t { none = 0, fold = 1, branch_point = 2, period_doubling = 3, neimark_sacker = 4 };
}

} // namespace plm
