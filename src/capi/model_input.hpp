// What the files that take the model's input share.
#pragma once
#include "capi/arguments.hpp"
#include "capi/handles.hpp"
#include "capi/outcome.hpp"
#include <functional>

namespace plm::capi {

/// PLM_ERR_STATE once the model is built.
void require_open(const ModelHandle &m);

/// The model that was built, or whose loads were changed, is the model from now on; what it is warned of.
/// said: on the way.
Warnings take(ModelHandle &m, std::shared_ptr<const Model> core, const Warnings &said);

/// A change of loads, damping or moving walls, in the input before the build, in the model after it: it then
/// shares all that was factored with the one before, which what was made of that one keeps. change(input)
/// checks before it changes anything.
Outcome change_loads(ModelHandle &m, const std::function<void(ModelInput &)> &change);

/// Where PLM_MASS, PLM_STIFFNESS or PLM_DAMPING goes.
std::shared_ptr<const MatrixInput> &matrix_of(ModelInput &input, std::int32_t which);

/// A DOF number in the caller's base.
inline void require_dof(std::int64_t dof, std::int64_t base, std::int64_t n_dof, const char *name,
                        std::int64_t index) {
    if (dof < base || dof - base >= n_dof)
        bad_argument(name, index,
                     format("%s[%lld] = %lld is no DOF number; it must lie in %lld..%lld", name,
                            static_cast<long long>(index), static_cast<long long>(dof),
                            static_cast<long long>(base), static_cast<long long>(base + n_dof - 1)));
}

} // namespace plm::capi
