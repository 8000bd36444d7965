// The core's codes are those of plm.h.
#include "linalg/status.hpp"
#include "motions/branch.hpp"
#include "plm/plm.h"
#include "space/model_input.hpp"
#include "structure/matrix_input.hpp"

namespace plm {

static_assert(status::ok == PLM_OK);
static_assert(status::not_converged == PLM_NOT_CONVERGED);
static_assert(status::truncated == PLM_TRUNCATED);
static_assert(status::cancelled == PLM_CANCELLED);
static_assert(status::warning == PLM_WARNING);
static_assert(part::full == PLM_FULL);
static_assert(part::lower == PLM_LOWER);
static_assert(part::upper == PLM_UPPER);
static_assert(storage::csc == PLM_CSC);
static_assert(storage::triplets == PLM_TRIPLETS);
static_assert(storage::csr == PLM_CSR);
static_assert(auto_stiffness == PLM_AUTO_STIFFNESS);
static_assert(keep_gap == PLM_KEEP_GAP);
static_assert(status::handle == PLM_ERR_HANDLE);
static_assert(status::argument == PLM_ERR_ARGUMENT);
static_assert(status::key == PLM_ERR_KEY);
static_assert(status::state == PLM_ERR_STATE);
static_assert(status::memory == PLM_ERR_MEMORY);
static_assert(status::not_built == PLM_ERR_NOT_BUILT);
static_assert(status::matrix == PLM_ERR_MATRIX);
static_assert(status::not_positive_definite == PLM_ERR_NOT_POSITIVE_DEFINITE);
static_assert(status::singular == PLM_ERR_SINGULAR);
static_assert(status::eigensolver == PLM_ERR_EIGENSOLVER);
static_assert(status::convergence == PLM_ERR_CONVERGENCE);
static_assert(status::callback == PLM_ERR_CALLBACK);
static_assert(status::internal == PLM_ERR_INTERNAL);
static_assert(status::busy == PLM_ERR_BUSY);
static_assert(reason::none == PLM_REASON_NONE);
static_assert(reason::not_positive_definite == PLM_REASON_NOT_POSITIVE_DEFINITE);
static_assert(reason::singular == PLM_REASON_SINGULAR);
static_assert(reason::range_end == PLM_REASON_RANGE_END);
static_assert(reason::point_limit == PLM_REASON_POINT_LIMIT);
static_assert(reason::cancelled == PLM_REASON_CANCELLED);
static_assert(reason::step_minimum == PLM_REASON_STEP_MINIMUM);
static_assert(reason::contact_chatter == PLM_REASON_CONTACT_CHATTER);
static_assert(reason::singular_tangent == PLM_REASON_SINGULAR_TANGENT);
static_assert(reason::start_failed == PLM_REASON_START_FAILED);
static_assert(reason::no_equilibrium == PLM_REASON_NO_EQUILIBRIUM);
static_assert(reason::loop_closed == PLM_REASON_LOOP_CLOSED);
static_assert(reason::basis_too_small == PLM_REASON_BASIS_TOO_SMALL);
static_assert(reason::turned_back == PLM_REASON_TURNED_BACK);
static_assert(reason::no_peak == PLM_REASON_NO_PEAK);
static_assert(reason::harmonics_too_few == PLM_REASON_HARMONICS_TOO_FEW);
static_assert(reason::outside_basis == PLM_REASON_OUTSIDE_BASIS);
static_assert(reason::other_branch == PLM_REASON_OTHER_BRANCH);
static_assert(reason::no_contraction == PLM_REASON_NO_CONTRACTION);
static_assert(reason::not_finite == PLM_REASON_NOT_FINITE);
static_assert(reason::unverified == PLM_REASON_UNVERIFIED);
static_assert(reason::no_switching == PLM_REASON_NO_SWITCHING);
static_assert(reason::lost_mode == PLM_REASON_LOST_MODE);
static_assert(reason::model == PLM_REASON_MODEL);
static_assert(reason::host_reduction == PLM_REASON_HOST_REDUCTION);
static_assert(reason::unstable_peak == PLM_REASON_UNSTABLE_PEAK);
static_assert(reason::crossed_over == PLM_REASON_CROSSED_OVER);
static_assert(reason::larger_motion == PLM_REASON_LARGER_MOTION);
static_assert(reason::tie == PLM_REASON_TIE);
static_assert(reason::rounded == PLM_REASON_ROUNDED);
static_assert(reason::effort == PLM_REASON_EFFORT);
static_assert(reason::unfinished == PLM_REASON_UNFINISHED);
static_assert(reason::not_saved == PLM_REASON_NOT_SAVED);
static_assert(bifurcation::none == PLM_BIFURCATION_NONE);
static_assert(bifurcation::fold == PLM_BIFURCATION_FOLD);
static_assert(bifurcation::branch_point == PLM_BIFURCATION_BRANCH_POINT);
static_assert(bifurcation::period_doubling == PLM_BIFURCATION_PERIOD_DOUBLING);
static_assert(bifurcation::neimark_sacker == PLM_BIFURCATION_NEIMARK_SACKER);
static_assert(int(Measure::peak) == PLM_PEAK && int(Measure::half_peak_to_peak) == PLM_HALF_PEAK_TO_PEAK &&
              int(Measure::rms) == PLM_RMS && int(Measure::harmonic) == PLM_HARMONIC);

} // namespace plm
