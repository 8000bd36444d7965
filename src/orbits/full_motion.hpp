// Motion of the full model by Newmark's method.
#pragma once
#include "orbits/newmark.hpp"
#include "orbits/transient.hpp"

namespace plm {

class FullMotion final : public Transient {
  public:
    explicit FullMotion(std::shared_ptr<const Model> model) : model_(std::move(model)) {}

    bool is_reduced() const override { return false; }
    std::int64_t size() const override { return model_->n_free(); }
    void set_state(const double *q, const double *v) override;
    void start_at(const PointStart &start) override; // of any reduced model of this model
    void get_state(double *q, double *v) override;
    TransientRun run(const TransientOptions &options, const vector<std::int64_t> &observed,
                     Watch watch) override;
    PeriodicMotion find_periodic(const TransientOptions &options, Watch watch) override;

  private:
    const FullState &present();
    NewmarkResult march(const NewmarkOptions &options, double omega, const FullState &start,
                        NewmarkObserver &observer, Watch watch) const;

    std::shared_ptr<const Model> model_;
    FullState state_; // empty: not known yet
};

} // namespace plm
