// What a host that reduced its structure itself adds to its small matrices: how the whole is recovered.
#pragma once
#include "capi/context.hpp"
#include "linalg/dense.hpp"

namespace plm::capi {

/// The host's way from the DOFs of its superelement to those of the structure it reduced; none: fn is null.
struct Recovery {
    std::int64_t n_full = 0;
    plm_recover_fn fn = nullptr;
    void *user = nullptr;
};

/// Columns at once: the host may use BLAS 3, and hears its progress callback between two blocks.
constexpr std::int64_t recovery_block = 32;

/// Motions of the superelement (n_dof x k) on all DOFs of the structure, n_full x k. Calls the host, in
/// blocks of columns. Throws PLM_ERR_STATE without a recovery, PLM_ERR_CALLBACK where it fails or returns
/// NaN.
Matrix recovered(const Recovery &recovery, Context &context, const Matrix &motions);

} // namespace plm::capi
