// Which form of the contact law (contact/law_form.hpp) the equations in the contact gaps have.
#pragma once
#include "contact/law_form.hpp"
#include "hbm/options.hpp"
#include "reduction/reduced_model.hpp"

namespace plm {

/// 1 / median static flexibility of the pairs in the open structure; 0 when rigid-body modes leave it without
/// one.
double local_stiffness(const ReducedModel &reduced);

LawForm make_formulation(const ReducedModel &reduced, const HbmOptions &options);

} // namespace plm
