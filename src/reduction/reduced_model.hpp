// The reduced equations (paper, eq. (10), (11)) in coordinates where m = I and k is diagonal, with a basis P
// for h >= 1 and P_0 for h = 0. All that harmonic balance sees of the structure.
#pragma once
#include "model/space.hpp"

namespace plm {

struct ReducedModel {
    std::shared_ptr<const Model> model;
    // dynamic coordinates, h >= 1
    vector<double> lambda;           // r, rad^2/s^2
    vector<double> damping_diagonal; // r, when diagonal
    Matrix damping;                  // r x r when not diagonal; else empty
    double structural = 0;           // eta: k (1 + i eta)
    Matrix gap;                      // B P: Z x r
    // static coordinates, h = 0; when `same_static` they are the dynamic ones and the *_0 members repeat them
    bool same_static = true;
    vector<double> lambda_0;
    Matrix gap_0; // B P_0: Z x r_0
    // loads
    vector<double> preload_0;               // P_0^T F_preload, r_0 (zeros without pre-load)
    std::map<int, HarmonicLoad> excitation; // h >= 1: r; h = 0: r_0
    // contact
    vector<double> contact_stiffness, initial_gap;
    // recovery: q = P eta
    Matrix vectors;   // n_free x r
    Matrix vectors_0; // n_free x r_0, empty when same_static

    std::int64_t size() const { return static_cast<std::int64_t>(lambda.size()); }
    std::int64_t static_size() const { return static_cast<std::int64_t>(lambda_0.size()); }
    std::int64_t n_pairs() const { return gap.rows(); }
    const Matrix &static_vectors() const { return same_static ? vectors : vectors_0; }
};

} // namespace plm
