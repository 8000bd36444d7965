// The structure with its contact: M q'' + C q' + K q = F(t) - B^T N(B q - g(t)), checked once and then
// read-only.
#pragma once
#include "linalg/kept.hpp"
#include "space/model_input.hpp"
#include "space/static_responses.hpp"

namespace plm {

class Model : public Structure {
  public:
    /// Throws plm::Error with the argument and index at fault.
    /// host: its own solver, or null.
    Model(const ModelInput &input, const SpaceOptions &options, const HostSolver *host, Watch watch);
    /// The same model under other loads, damping and motion of the walls: nothing is factored anew, and what
    /// is known of the first one, with all that was made of it, stays as it is.
    Model(const Model &built, const ModelInput &loads, Watch watch);

    /// From the bytes of another one, without its matrices (structure.hpp).
    explicit Model(ByteReader &bytes);
    void write(ByteWriter &bytes) const;

    std::int64_t n_pairs() const { return contact_.n_pairs(); }
    const Contact &contact() const { return contact_; }
    const vector<double> &contact_stiffness() const { return contact_.stiffness; } // k_n, resolved
    const vector<double> &initial_gap() const { return contact_.initial_gap; }
    const GivenForces &rest_forces() const { return rest_forces_; }
    /// Before the model is shared: gaps that follow from forces at rest (rest_gaps.hpp).
    void set_initial_gap(vector<double> gap) { contact_.initial_gap = std::move(gap); }
    /// 1 / median of the contact flexibility diag(B K^-1 B^T), rigid-body motion left out; 0 without pairs.
    /// Where every k_n is given, of some pairs at most.
    double local_stiffness() const { return local_stiffness_; }
    /// What contact forces and loads do statically outside the lowest modes: computed once, when it is first
    /// needed: by auto stiffness at the build, else by the first space.
    std::shared_ptr<const StaticResponses> responses(Watch watch) const;
    /// As lowest_modes(): `wanted` of them, or as many as there are, and those after them until one is not
    /// below `cutoff` (rad/s).
    /// search: how, but for what this sets of it.
    std::shared_ptr<const ExactModes> exact_modes_up_to(std::int64_t wanted, double cutoff, Watch watch,
                                                        ModeSearch search = {}) const;
    /// The same modes, with copies of multiple frequencies that may have been missed.
    std::shared_ptr<const ExactModes> looked_over(const ExactModes &modes, Watch watch) const;
    const SpaceOptions &space_options() const { return space_options_; }
    /// What is to be added to an output of motions relative to the base, at a frequency and a scale of the
    /// excitation.
    KnownMotion known_motion(std::int64_t output, double omega, double scale) const;

  private:
    template <class Self, class Bytes> static void pass(Self &self, Bytes &bytes);
    Model(const ModelInput &input, const SpaceOptions &options, const Solver &solver, Watch watch);
    void move_gaps();
    std::shared_ptr<const ExactModes> modes_at_hand(Watch watch) const;
    vector<double> elastic_flexibility(Watch watch) const;
    vector<double> flexibility_of_some() const;
    void resolve_contact_stiffness(Watch watch);

    Contact contact_;
    double local_stiffness_ = 0;
    Kept<StaticResponses> responses_;
    std::shared_ptr<const ExactModes> known_modes_; // of the model whose loads were changed; or null
    SpaceOptions space_options_;
    GivenForces rest_forces_;
};

} // namespace plm
