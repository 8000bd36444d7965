// One scenario: a host that makes models, samplers, bases, solvers and everything else in an order drawn by
// chance, reads all results, loses handles and goes on with them, cancels, and runs out of memory.
#pragma once
#include "structure.hpp"
#include <string>

namespace scenarios {

class Scenario {
  public:
    Scenario(Tally &tally, std::uint64_t seed, const Limits &limits);
    /// Draws the whole scenario; what is wrong is in the tally and on the standard output.
    void run();

  private:
    using Action = void (Scenario::*)();
    static const std::vector<Action> &actions();

    bool create_context();
    void create_model();
    void steps();
    void finish();

    void build_model();
    void read_rest_and_modes();
    void create_sampler();
    void run_sampler();
    void create_basis();
    void build_basis();
    void create_hbm();
    void sweep();
    void read_branch();
    void read_point();
    void find_peak();
    void compute_response();
    void solve();
    void find_isolated();
    void find_backbones();
    void estimate_error();
    void refine_basis();
    void find_nonlinear_mode();
    void follow_bifurcation();
    void find_by_marching();
    void create_transient();
    void run_transient();
    void create_study();
    void run_study();
    void change_options();
    void read_everything();
    void destroy_one();

    template <class H> H *pick(const std::vector<H *> &all);
    void keep(plm_branch *branch);
    void keep_found(std::int64_t count);
    std::int64_t any_dof() { return random_.integer(random_.chance(0.02) ? -1 : 0, n_dof_ - 1); }
    std::int32_t any_measure() { return static_cast<std::int32_t>(random_.integer(PLM_PEAK, PLM_HARMONIC)); }
    std::int32_t any_harmonic() { return static_cast<std::int32_t>(random_.integer(0, 4)); }
    std::int64_t any_point(plm_branch *branch);
    double some_frequency(plm_branch *branch);

    Tally &tally_;
    Random random_;
    Witness witness_;
    Memory memory_;
    Borrowed arrays_;
    bool tame_;
    std::int64_t n_dof_ = 1;
    plm_context *context_ = nullptr;
    std::vector<plm_model *> models_;
    std::vector<plm_sampler *> samplers_;
    std::vector<plm_basis *> bases_;
    std::vector<plm_hbm *> hbms_;
    std::vector<plm_branch *> branches_;
    std::vector<plm_transient *> transients_;
    std::vector<plm_study *> studies_;
};

} // namespace scenarios
