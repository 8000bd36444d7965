// A smaller basis from responses: proper orthogonal decomposition of motions computed on a larger one, by
// their energy (Kerschen et al. 2005). Of the unreduced structure's responses it is the classical one; of
// those of piecewise-linear modes it needs no unreduced solution.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// Motions in the coordinates of one reduced model; only the size of columns among each other matters.
struct Responses {
    std::shared_ptr<const ReducedModel> of;
    Matrix dynamic;   // r x n: cosine and sine parts of harmonics h >= 1
    Matrix mean;      // r_0 x m: parts of h = 0
    double omega = 0; // a typical frequency (rad/s): weighs kinetic against elastic energy
};

struct Compressed {
    std::shared_ptr<const ReducedModel> reduced;
    vector<double> singular_values; // of the dynamic part, in the energy norm, scaled by the largest
};

/// Keeps as many directions as leave out less than `tolerance` of the responses in the energy norm, or `size`
/// of them when size > 0. P' = P Y, P_0' = P_0 Y_0 with P' in its span, each diagonalised.
Compressed compress(const Responses &responses, double tolerance, std::int64_t size);

/// The model of one curve: its motions (r x n in the coordinates of `from`, which has P_0 = P, mean parts
/// among them) compressed as above beside the modes of `from` below `kept` (rad/s), with open contact and
/// with each of `springs` (Z, in the place of the pairs). Those stay, however little they move: it is by them
/// that a motion loses its stability. No larger than `most`, if the modes with open contact leave room.
std::shared_ptr<const ReducedModel> compress_beside_modes(std::shared_ptr<const ReducedModel> from,
                                                          const Matrix &motions,
                                                          const std::vector<vector<double>> &springs,
                                                          double omega, double tolerance, double kept,
                                                          std::int64_t most);

/// Coordinates (r' x k) of a compressed model in those of the model it is made from; of any other as they
/// are.
Matrix uncompressed(const ReducedModel &m, const Matrix &coordinates);
/// The model that a compressed one is made from; any other itself.
std::shared_ptr<const ReducedModel> uncompressed(const std::shared_ptr<const ReducedModel> &m);

/// A model of exact motions (P_0 = P), made in the space that `whole` is all of, as one compressed from it.
std::shared_ptr<const ReducedModel> as_part_of(std::shared_ptr<const ReducedModel> whole,
                                               const ReducedModel &part);

} // namespace plm
