// The vectors of a space, V: never formed as a whole, but recovered when asked for. Those of a contact space
// are combinations of exact modes, of the responses to contact forces and loads, which are solved for, and of
// few further vectors.
#pragma once
#include "space/static_responses.hpp"

namespace plm {

class SpaceVectors {
  public:
    SpaceVectors() = default;
    /// V as it is.
    explicit SpaceVectors(Field vectors);
    /// What V is made of, and its coordinates in that: V = Phi A + X B + Y C with the responses X.
    struct Parts {
        std::shared_ptr<const Structure> structure;
        std::shared_ptr<const ExactModes> modes;
        Matrix of_modes, of_responses; // p x m, s x m
        Field further;                 // outside the modes: n_free x q
        Matrix of_further;             // q x m
    };
    explicit SpaceVectors(Parts parts) : parts_(std::move(parts)) {}

    std::int64_t rows() const { return parts_.further.rows(); }
    std::int64_t cols() const { return parts_.of_further.cols(); }
    /// What it keeps.
    std::int64_t bytes() const;

    const Parts &parts() const { return parts_; }

  private:
    Parts parts_;
};

/// V Y, V y and V^T F: to rounding, by as many solutions as there are columns.
Field combine(const SpaceVectors &v, const Matrix &y);
Field combine(const SpaceVectors &v, const vector<double> &y);
Matrix gram(const SpaceVectors &v, const Field &f);
/// V.
Field all_columns(const SpaceVectors &v);
/// V^T F, empty where there is no load.
vector<double> projected(const SpaceVectors &v, const Field &load);
HarmonicLoads projected(const SpaceVectors &v, const std::map<int, HarmonicForce> &loads);

} // namespace plm
