// What functions and keys of a study share.
#pragma once
#include "capi/handles.hpp"

namespace plm::capi {

/// PLM_ERR_STATE when the study has not run.
const StudyResult &last_run(const StudyHandle &h);

} // namespace plm::capi
