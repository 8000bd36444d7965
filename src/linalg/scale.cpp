#include "linalg/scale.hpp"
#include "linalg/error.hpp"

namespace plm {

void require_finite_result(const double *values, std::int64_t n, const char *what) {
    for (std::int64_t i = 0; i < n; ++i)
        if (!std::isfinite(values[i]))
            throw Error(status::convergence,
                        format("%s: number %lld of %lld is not finite; %s", what, static_cast<long long>(i),
                               static_cast<long long>(n), sizes_apart))
                .reason(reason::not_finite)
                .index(i);
}

} // namespace plm
