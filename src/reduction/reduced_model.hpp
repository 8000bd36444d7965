// The reduced equations (paper, eq. (10), (11)) in coordinates where m and k are diagonal, with a basis P for
// h >= 1 and P_0 for h = 0. All that harmonic balance sees of the structure. m = 1, or 0 for the directions
// that follow statically (massless.hpp).
#pragma once
#include "linalg/kept.hpp"
#include "space/space.hpp"

namespace plm {

/// The contact of the model when the equations carry some of its pairs only (node sampling).
struct AllPairs {
    Matrix gap, gap_0; // B P, B P_0: Z x r, Z x r_0
    Contact contact;
};

struct StaticState; // space/rest.hpp

struct ReducedModel;

/// What a model is made from that serves one curve of another (compression.hpp).
struct CompressedFrom {
    std::shared_ptr<const ReducedModel> model; // with P_0 = P
    Matrix coordinates;                        // its, of the compressed model's: r x r'
};

struct ReducedModel {
    std::shared_ptr<const Model> model;
    // dynamic coordinates, h >= 1
    vector<double> lambda;           // r, rad^2/s^2: k, over a mass of 1
    std::int64_t n_massless = 0;     // the last ones: no mass
    vector<double> damping_diagonal; // r, when diagonal
    Matrix damping;                  // r x r when not diagonal; else empty
    double structural = 0;           // eta: k (1 + i eta)
    Matrix gap;                      // B P: Z x r
    // static coordinates, h = 0; when `same_static` they are the dynamic ones and the *_0 members repeat them
    bool same_static = true;
    vector<double> lambda_0;
    std::int64_t n_massless_0 = 0;
    Matrix gap_0;                      // B P_0: Z x r_0
    vector<double> damping_diagonal_0; // as the dynamic ones; both empty when `same_static`
    Matrix damping_0;
    // loads
    vector<double> preload_0; // P_0^T F_preload, r_0 (zeros without pre-load)
    HarmonicLoads excitation; // h >= 1: r; h = 0: r_0
    Contact contact;
    // Node sampling: all of the above about contact is of the pairs in `carried` only, their stiffness
    // includes that of the pairs left out, and all_pairs has the model's own. Null: all pairs are carried
    vector<std::int64_t> carried;
    std::shared_ptr<const AllPairs> all_pairs;
    Kept<StaticState> rest;                     // rest_of(), reduced_rest.hpp
    Kept<ReducedModel> widened;                 // widened(), widened_model.hpp
    std::shared_ptr<const CompressedFrom> from; // null: of a basis as it was built
    // recovery: q = P eta
    SpaceVectors vectors;   // P: n_free x r
    SpaceVectors vectors_0; // P_0: n_free x r_0, empty when same_static
    Matrix to_static;       // P = P_0 T: r_0 x r, empty when same_static
    Matrix in_space;        // P_0 = V in_space, V the space that it was made in; empty: P_0 = V, or not known

    std::int64_t size() const { return static_cast<std::int64_t>(lambda.size()); }
    std::int64_t static_size() const { return static_cast<std::int64_t>(lambda_0.size()); }
    double mass(std::int64_t j) const { return j < size() - n_massless ? 1.0 : 0.0; }
    double mass_0(std::int64_t j) const { return j < static_size() - n_massless_0 ? 1.0 : 0.0; }
    std::int64_t n_pairs() const { return contact.n_pairs(); } // in the equations
    // what the motion means for the pairs of the model, carried or not
    const Matrix &whole_gap() const { return all_pairs ? all_pairs->gap : gap; }
    const Matrix &whole_gap_0() const { return all_pairs ? all_pairs->gap_0 : gap_0; }
    const Contact &whole_contact() const { return all_pairs ? all_pairs->contact : contact; }
    std::int64_t n_whole_pairs() const { return whole_contact().n_pairs(); }
    const SpaceVectors &static_vectors() const { return same_static ? vectors : vectors_0; }
};

/// P_0 coordinates of motions q over the free DOFs (n_free x k).
Matrix static_coordinates_of(const ReducedModel &reduced, const Field &motions);

} // namespace plm
