// The structure with its contact: M q'' + C q' + K q = F(t) - B^T N(B q - g), checked once and then
// read-only.
#pragma once
#include "space/model_input.hpp"

namespace plm {

class Model : public Structure {
  public:
    /// Throws plm::Error with the argument and index at fault.
    /// host: its own solver, or null.
    Model(const ModelInput &input, const SpaceOptions &options, const HostSolver *host, Watch watch);

    std::int64_t n_pairs() const { return contact_.n_pairs(); }
    const Contact &contact() const { return contact_; }
    const vector<double> &contact_stiffness() const { return contact_.stiffness; } // k_n, resolved
    const vector<double> &initial_gap() const { return contact_.initial_gap; }
    /// 1 / median of the contact flexibility diag(B K^-1 B^T), rigid-body motion left out; 0 without pairs.
    double local_stiffness() const { return local_stiffness_; }
    /// (K + shift M)^-1 B^T, n_free x Z: computed once, at the build (auto stiffness and every space need
    /// it).
    const Field &attachment() const { return attachment_; }
    const SpaceOptions &space_options() const { return space_options_; }

  private:
    Model(const ModelInput &input, const SpaceOptions &options, const Solver &solver, Watch watch);
    void solve_attachment(Watch watch);
    vector<double> elastic_flexibility() const;
    void resolve_contact_stiffness();

    Contact contact_;
    double local_stiffness_ = 0;
    Field attachment_;
    SpaceOptions space_options_;
};

} // namespace plm
