// What a search for eigenpairs is asked for and finds.
#pragma once
#include "linalg/dense.hpp"
#include <functional>

namespace plm {

struct EigenPairs {
    vector<double> values; // ascending
    Matrix vectors;        // M-orthonormal columns
};

/// library_code of the error (PLM_ERR_EIGENSOLVER) where some did not converge within the allowed restarts.
constexpr std::int64_t eigs_too_few = -1;

struct EigsOptions {
    double tolerance = 0; // relative accuracy of the Ritz values; 0 = machine precision
    std::int64_t max_restarts = 300;
    std::int64_t max_attempts = 3;   // each with twice the vectors, where the one before did not converge
    std::function<bool()> cancelled; // polled before each operation; true stops (PLM_CANCELLED)
};

} // namespace plm
