// What a search for eigenpairs is asked for and finds.
#pragma once
#include "structure/field.hpp"
#include <functional>

namespace plm {

/// What a search leaves beside its pairs X, for one that goes on to more of them: further Ritz vectors V and
/// the next block W, M-orthonormal, with A^-1 M [X V] = [X V] diag(theta) + W B. Empty where there is none.
struct SearchRest {
    Field v, w;
    Matrix b;
    vector<double> theta; // of X and V: 1 / (lambda - shift)
};

constexpr std::int64_t most_rest = 128; // columns of V

struct EigenPairs {
    vector<double> values; // ascending
    Field vectors;         // M-orthonormal columns
    SearchRest rest = {};
};

/// library_code of the error (PLM_ERR_EIGENSOLVER) where some did not converge within the allowed restarts.
constexpr std::int64_t eigs_too_few = -1;

struct KnownPairs {
    const vector<double> *values = nullptr; // null: there are none
    const Field *vectors = nullptr;
    SearchRest *rest = nullptr; // taken: empty afterwards
};

struct EigsOptions {
    /// Of a pair's residual, relative to its value: the value is right to the square of that, over its
    /// distance from others. 0: machine precision, which takes a sixth more steps.
    double tolerance = 1e-12;
    std::int64_t max_restarts = 300;
    std::int64_t max_attempts = 3;   // each with twice the vectors, where the one before did not converge
    std::function<bool()> cancelled; // polled before each operation; true stops (PLM_CANCELLED)
    /// Whether copies of multiple eigenvalues are looked for that the iteration may have missed. Not needed
    /// where the number of modes is counted.
    bool look_for_missed = true;
    /// Whether what is left of the search is kept with the pairs.
    bool keep_rest = false;
    /// The lowest pairs, from an earlier search: this one goes on, from its rest if there is one. Where they
    /// are all that is wanted, it looks for missed ones alone.
    KnownPairs known;
};

} // namespace plm
