// Motion of a reduced model by its exact flow.
#pragma once
#include "orbits/exact_flow.hpp"
#include "orbits/transient.hpp"

namespace plm {

class ReducedMotion final : public Transient {
  public:
    explicit ReducedMotion(std::shared_ptr<const ReducedModel> reduced);

    bool is_reduced() const override { return true; }
    std::int64_t size() const override { return flow_model_->size(); }
    void set_state(const double *q, const double *v) override; // static_coordinates_of()
    void start_at(const PointStart &start) override;
    void get_state(double *q, double *v) override;
    TransientRun run(const TransientOptions &options, const vector<std::int64_t> &observed,
                     Watch watch) override;
    PeriodicMotion find_periodic(const TransientOptions &options, Watch watch) override;

  private:
    class March; // of one run
    const FlowState &present();
    void use_frequency(double omega);
    Matrix dof_rows(const vector<std::int64_t> &dofs) const;

    std::shared_ptr<const ReducedModel> reduced_;
    std::shared_ptr<const FlowModel> flow_model_;
    double model_omega_; // that flow_model_ was made for: matters to structural damping
    FlowState state_;    // empty: not known yet
};

} // namespace plm
