// A reduced model in the time domain: y'' + C y' + diag(lambda) y = F_preload + F(t) - G^T max(k_n u, 0),
// u = G y - g, in mass-normalised coordinates. Harmonic balance may use two sets of coordinates, P for
// h >= 1 and P_0 for h = 0; a flow needs one. P_0 spans P and is M-orthonormal with a diagonal stiffness too,
// so the flow lives in P_0, and T = P_0^T M P (orthonormal columns) takes dynamic coordinates to its own.
#pragma once
#include "reduction/reduced_model.hpp"

namespace plm {

/// Displacement, velocity (n each) and time (s).
struct FlowState {
    vector<double> y, v;
    double time = 0;
};

class FlowModel {
  public:
    /// omega (rad/s) is needed for structural damping only, which has no causal form in time: it is replaced
    /// by viscous damping that loses the same energy per cycle at omega, c = eta lambda / omega.
    /// PLM_ERR_ARGUMENT when it is missing then. Outside the span of P (a few static directions) Rayleigh
    /// damping and an explicit C are projected like everything else; modal damping, known on P only, is
    /// continued by its largest value.
    explicit FlowModel(std::shared_ptr<const ReducedModel> reduced, double omega = 0);

    std::int64_t size() const { return static_cast<std::int64_t>(lambda_.size()); }
    std::int64_t n_pairs() const { return gap_->rows(); }
    const ReducedModel &reduced() const { return *reduced_; }

    const vector<double> &lambda() const { return lambda_; } // n
    bool has_diagonal_damping() const { return damping_.empty(); }
    const vector<double> &damping_diagonal() const { return damping_diagonal_; } // n, when diagonal
    const Matrix &damping() const { return damping_; }                           // n x n, when not
    double damping_trace() const;
    const Matrix &gap() const { return *gap_; } // Z x n
    const vector<double> &preload() const { return reduced_->preload_0; }
    const std::map<int, HarmonicLoad> &excitation() const { return excitation_; } // n each, h = 0 too
    const vector<double> &contact_stiffness() const { return reduced_->contact_stiffness; }
    const vector<double> &initial_gap() const { return reduced_->initial_gap; }

    /// The state at `fraction` of the period of a point of harmonic balance: eta_0 (r_0), eta r x 2H with
    /// columns a_1, b_1, ..., a_H, b_H. PLM_ERR_ARGUMENT when the sizes do not fit.
    FlowState state(const vector<double> &eta_0, const Matrix &eta, double omega, double fraction) const;
    /// Row of P_0 of a DOF of the full model (n; zeros when it is fixed): q_dof = row . y. A reduced model
    /// without a model has the rows of its vectors as DOFs.
    vector<double> dof_row(std::int64_t dof) const;
    /// q over all DOFs of the model (n_dof).
    vector<double> field(const vector<double> &y) const;

  private:
    void find_coordinates();
    void project_loads();
    void add_structural_damping(double omega);
    void project_damping();

    std::shared_ptr<const ReducedModel> reduced_;
    Matrix to_flow_; // T: n x r; empty when the coordinates are the dynamic ones
    const Matrix *gap_ = nullptr;
    vector<double> lambda_, damping_diagonal_;
    Matrix damping_;
    std::map<int, HarmonicLoad> excitation_;
};

} // namespace plm
