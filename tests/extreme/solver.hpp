// Cases of the extreme table as a host would hand them over: structures as triplets through the C API, every
// option at its default unless it defines the case.
#pragma once
#include "plm/plm.h"
#include "support/exact_flow.hpp"
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

struct scene;

namespace extreme {

/// A call that failed; what() is the library's own text.
struct Failure : std::runtime_error {
    Failure(plm_status s, std::int32_t r, const std::string &text)
        : std::runtime_error(text), status(s), reason(r) {}
    plm_status status;
    std::int32_t reason;
};

struct Setup {
    double low = 0, high = 0; // frequency range in rad per time unit; 0, 0: the sampler's window
    int harmonics = 0;        // 0: the default, as many as each point needs
    bool sampled = false;     // aft = sampled with 256 samples instead of the default
    bool upward = false;
    double force_scale = 1;
    std::string kind = "full"; // of the basis: without reduction error unless a row is about the reduction
    std::map<std::string, std::int64_t> sampler; // options that define the case
};

/// Piecewise-linear modes of the scene's own dominant mode.
Setup setup_of(const scene &s);

/// What Newton and the continuation did.
struct Work {
    std::int64_t points = 0, iterations = 0, failed_steps = 0;
    double seconds = 0; // of the processor
    void add(const Work &w);
};

/// A branch and what it took.
class Curve {
  public:
    Curve(plm_context *ctx, plm_model *model, plm_basis *basis, plm_branch *branch);
    ~Curve();
    Curve(const Curve &) = delete;
    Curve &operator=(const Curve &) = delete;

    std::int32_t end_reason = 0;
    std::string end_text, unknowns;
    std::vector<double> omega;
    Work work;

    std::size_t size() const { return omega.size(); }
    std::vector<double> amplitude(std::int64_t dof, std::int32_t measure = PLM_PEAK, int harmonic = 0) const;
    /// q(0), q'(0) of the first n DOFs, of the motion itself: harmonics of an impact are far from its
    /// velocity.
    std::vector<double> state(std::size_t point, std::int64_t n) const;
    std::vector<std::int32_t> bifurcations() const; // PLM_BIFURCATION_... of every point
    plm_branch *handle() const { return branch_; }

  private:
    plm_context *ctx_;
    plm_model *model_;
    plm_basis *basis_;
    plm_branch *branch_;
};

class Solver {
  public:
    Solver(const exact::Structure &structure, const Setup &setup);
    /// Mass matrix given in full (n x n), for structures whose masses the exact flow cannot hold.
    Solver(const exact::Structure &structure, const std::vector<double> &mass, const Setup &setup);
    Solver(const scene &s, const Setup &setup); // borrows its matrices
    ~Solver();
    Solver(const Solver &) = delete;
    Solver &operator=(const Solver &) = delete;

    std::unique_ptr<Curve> sweep();
    std::unique_ptr<Curve> solve(double omega, const Curve *start = nullptr, std::size_t point = 0);
    /// Frequency (rad per time unit) and height of the highest point.
    std::pair<double, double> peak(const Curve &curve, std::int64_t dof, std::int32_t measure = PLM_PEAK,
                                   int harmonic = 0);
    std::int64_t basis_size() const;
    double model_stiffness() const;                 // the library's local stiffness
    double window_low() const, window_high() const; // rad per time unit; kind plm only
    plm_context *context() const { return ctx_; }

  private:
    void build(const exact::Structure &s, const std::vector<double> &mass, const Setup &setup);
    void finish(const Setup &setup);
    void check(plm_status status) const;

    double low_ = 0, high_ = 0;
    plm_context *ctx_ = nullptr;
    plm_model *model_ = nullptr;
    plm_sampler *sampler_ = nullptr;
    plm_basis *basis_ = nullptr;
    plm_hbm *hbm_ = nullptr;
};

/// 1 / median contact flexibility (diagonal of B K^-1 B'), by this folder's own dense solver.
double local_stiffness(const exact::Structure &s);

} // namespace extreme
