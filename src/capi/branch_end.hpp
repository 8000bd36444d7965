// How a branch ended, as a status.
#pragma once
#include "plm/plm.h"
#include <cstdint>

namespace plm::capi {

plm_status end_status(std::int32_t reason);

} // namespace plm::capi
