// Contact pairs on their way into the model's input.
#pragma once
#include "capi/model_input.hpp"

namespace plm::capi {

/// New rows of B, complete and checked before the model sees them.
struct NewPairs {
    vector<std::int64_t> row, dof;
    vector<double> coefficient, stiffness, gap;
};
/// All or nothing. Makes the rows those of the model.
void add_to(ModelInput &input, NewPairs &pairs);

/// In its range, or left to the library.
bool is_stiffness(double k_n);

} // namespace plm::capi
