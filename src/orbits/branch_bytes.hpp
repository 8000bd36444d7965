// A branch as bytes: its points, how it ended and, where it was followed on a compressed model, that model.
#pragma once
#include "linalg/bytes.hpp"
#include "motions/branch.hpp"

namespace plm {

void write_branch(ByteWriter &bytes, const Branch &branch);
/// On the model of the basis that it was computed on: PLM_ERR_ARGUMENT for another one, told by a
/// fingerprint of the reduced equations.
std::shared_ptr<Branch> read_branch(ByteReader &bytes, const std::shared_ptr<const ReducedModel> &basis);

} // namespace plm
