// Mass and stiffness handed over the one in place of the other. Both over all DOFs, before supports.
#pragma once
#include "structure/translations.hpp"

namespace plm {

/// The translations in which K looks like a mass.
vector<Translation> without_negative_entries(const SparseMatrix &k);
/// PLM_ERR_MATRIX where M looks like a stiffness in one of them.
void refuse_exchanged(const vector<Translation> &mass_like, const SparseMatrix &m);

} // namespace plm
