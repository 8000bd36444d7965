// What contact forces and loads do to the structure statically, outside its exact modes, in small matrices:
// the responses X = (K + sigma M)^-1 F themselves are formed a block at a time and not kept.
#pragma once
#include "space/exact_modes.hpp"
#include <memory>

namespace plm {

/// F: the contact forces, a column B^T e_i for each gap row, then the loads that are not zero.
class ActingForces {
  public:
    explicit ActingForces(const Structure &structure);

    std::int64_t count() const { return n_contact() + loads_.cols(); }
    std::int64_t n_contact() const { return structure_.gap_rows().n_rows(); }
    /// F T and F^T X.
    Field combine(const Matrix &t) const;
    Matrix products(const Field &x) const;
    /// F^T X and X^T M X of X = (K + sigma M)^-1 F; false: not to be had without X.
    bool multiply_responses(Matrix &energy, Matrix &inertia) const {
        return structure_.multiply_responses(loads_, energy, inertia);
    }

  private:
    const Structure &structure_;
    Field loads_;
};

struct StaticResponses {
    std::shared_ptr<const ExactModes> modes;
    Matrix modal;   // Phi^T F: p x s
    Matrix energy;  // F^T X = X^T (K + sigma M) X: s x s
    Matrix inertia; // X^T M X

    /// The energy of each response with the modes in it; of the flexible ones alone.
    vector<double> whole_energies(double shift) const;
    vector<double> elastic_energies(double shift) const;
};

/// Without solutions as a whole, where the factorization offers that (Structure::multiply_responses()), and
/// the share of the modes is taken off in small matrices. For what loses digits there by two solutions a
/// force: X = (K + sigma M)^-1 F and (K + sigma M)^-1 M X, whose product with F is X^T M X.
StaticResponses static_responses(const Structure &structure, std::shared_ptr<const ExactModes> modes,
                                 Watch watch);
/// The same outside more modes, among which are the earlier ones: in small matrices, but for forces of which
/// hardly anything is left then.
StaticResponses outside_more_modes(const Structure &structure, const StaticResponses &earlier,
                                   std::shared_ptr<const ExactModes> modes, Watch watch);
/// The same outside the first modes only.
StaticResponses outside_first_modes(const Structure &structure, const StaticResponses &earlier,
                                    std::int64_t count);

} // namespace plm
