#pragma once
#include <plm/plm.hpp>

plm::Model one_mass(const plm::Context &context);
