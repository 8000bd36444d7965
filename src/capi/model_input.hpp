// What the files that take the model's input share.
#pragma once
#include "capi/arguments.hpp"
#include "capi/handles.hpp"

namespace plm::capi {

/// PLM_ERR_STATE once the model is built.
void require_open(const ModelHandle &m);

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
