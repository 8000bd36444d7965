// How a branch ended, as a status and in words.
#pragma once
#include "plm/plm.h"
#include <string>

namespace plm::capi {

plm_status end_status(std::int32_t reason);
std::string end_text(std::int32_t reason);

} // namespace plm::capi
