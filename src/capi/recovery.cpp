#include "capi/recovery.hpp"
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>

namespace plm::capi {

namespace {

void require_recovered(plm_status status, const double *values, std::int64_t n) {
    if (status != 0)
        throw Error(PLM_ERR_CALLBACK, format("the host's recovery failed with code %d", status))
            .argument("fn")
            .library_code(status);
    for (std::int64_t i = 0; i < n; ++i)
        if (!std::isfinite(values[i]))
            throw Error(PLM_ERR_CALLBACK, "the host's recovery returned NaN or Inf").argument("fn").index(i);
}

} // namespace

Matrix recovered(const Recovery &recovery, Context &context, const Matrix &motions) {
    if (!recovery.fn)
        throw Error(PLM_ERR_STATE, "the model has no recovery; hand the host's over before the build")
            .argument("model");
    Matrix full(recovery.n_full, motions.cols());
    for (std::int64_t first = 0; first < motions.cols(); first += recovery_block) {
        const std::int64_t some = std::min(recovery_block, motions.cols() - first);
        context.watch().step("recovery", static_cast<double>(first) / static_cast<double>(motions.cols()));
        std::int32_t status;
        {
            const HostCode host(context);
            status = recovery.fn(context.handle, motions.rows(), some, motions.col(first), recovery.n_full,
                                 full.col(first), recovery.user);
        }
        require_recovered(status, full.col(first), recovery.n_full * some);
    }
    return full;
}

} // namespace plm::capi
