#include "structure/solver/factor.hpp"
#include "linalg/error.hpp"
#include <cmath>

namespace plm {

void throw_not_positive_definite(std::int64_t column) {
    throw Error(PLM_ERR_NOT_POSITIVE_DEFINITE,
                format("matrix is not positive definite: factorization stops at row %lld",
                       static_cast<long long>(column)))
        .reason(PLM_REASON_NOT_POSITIVE_DEFINITE)
        .index(column);
}

void throw_singular(std::int64_t column) {
    throw Error(PLM_ERR_SINGULAR,
                format("matrix is singular: no usable pivot at row %lld", static_cast<long long>(column)))
        .reason(PLM_REASON_SINGULAR)
        .index(column);
}

FactorPrecision fitting_precision(const FactorEstimate &e, const Solver &solver) {
    const bool limited = solver.memory_limit > 0;
    const auto fits = [&](double bytes) { return !limited || bytes <= solver.memory_limit; };
    if (solver.precision != FactorPrecision::single && fits(e.peak_full)) return FactorPrecision::full;
    if (solver.precision != FactorPrecision::full && fits(e.peak_single)) return FactorPrecision::single;
    constexpr double mebibyte = 1 << 20;
    const std::string single = std::isfinite(e.peak_single)
                                   ? format(", %.0f MiB in single", std::ceil(e.peak_single / mebibyte))
                                   : std::string();
    throw Error(PLM_ERR_MEMORY,
                format("the factorization needs %.0f MiB in double precision%s, where memory_limit leaves %.0f MiB; "
                       "raise it, or reduce the structure",
                       std::ceil(e.peak_full / mebibyte), single.c_str(), solver.memory_limit / mebibyte))
        .argument("memory_limit");
}

} // namespace plm
