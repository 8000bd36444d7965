// What a transient has found; PLM_ERR_STATE with what to call when there is nothing yet.
#pragma once
#include "capi/handles.hpp"

namespace plm::capi {

const TransientRun &last_run(const TransientHandle &h);
const PeriodicMotion &periodic_motion(const TransientHandle &h);

} // namespace plm::capi
