// A reduced model in the time domain: y'' + C y' + diag(lambda) y = F_preload + F(t) - G^T max(k_n u, 0),
// u = G y - g(t), in mass-normalised coordinates. Harmonic balance may use two sets of coordinates, P for
// h >= 1 and P_0 for h = 0; a flow needs one. P_0 spans P and has diagonal m and k too, so the flow lives in
// P_0 (reduction/widened_model.hpp), and T (ReducedModel::to_static) takes dynamic coordinates to its own.
//
// Coordinates without mass come last. They are turned so that their own damping is diagonal: those with
// damping relax (c y' + k y = f: their displacement is a state), those without follow at once (k y = f: no
// state, a flexibility at the contact).
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
    /// PLM_ERR_ARGUMENT when it is missing then.
    explicit FlowModel(std::shared_ptr<const ReducedModel> reduced, double omega = 0);

    std::int64_t size() const { return static_cast<std::int64_t>(lambda_.size()); }
    std::int64_t n_massive() const { return size() - n_relaxing_ - n_following_; } // the first ones
    std::int64_t n_moving() const { return size() - n_following_; } // and those that relax: in the state
    std::int64_t n_following() const { return n_following_; }
    std::int64_t state_size() const { return n_moving() + n_massive(); } // displacements, velocities
    double mass(std::int64_t j) const { return j < n_massive() ? 1.0 : 0.0; }
    std::int64_t n_pairs() const { return gap_.rows(); }
    const ReducedModel &reduced() const { return *reduced_; } // the widened one

    const vector<double> &lambda() const { return lambda_; } // n
    bool has_diagonal_damping() const { return damping_.empty(); }
    const vector<double> &damping_diagonal() const { return damping_diagonal_; } // n, when diagonal
    const Matrix &damping() const { return damping_; }                           // n x n, when not
    /// Diagonal entry of the damping, whichever of the two it is.
    double own_damping(std::int64_t j) const {
        return damping_.empty() ? damping_diagonal_[j] : damping_(j, j);
    }
    const Matrix &gap() const { return gap_; }                 // Z x n
    const Matrix &gap_by_pair() const { return gap_by_pair_; } // its transpose
    /// What the coordinates that follow do at the contact: Z x Z, empty without them.
    const Matrix &flexibility() const { return flexibility_; }
    const vector<double> &preload() const { return preload_; }
    /// The pre-load and, through the springs of a contact set (one a pair), the gaps.
    vector<double> constant_load(const vector<double> &springs) const;
    const HarmonicLoads &excitation() const { return excitation_; } // n each, h = 0 too
    /// The pairs' walls move, in parts that the excitation has, too, if with zeros.
    bool walls_move() const { return walls_move_; }
    /// Amplitudes of the gaps that go with one part, Z.
    vector<std::complex<double>> gap_motion(const LoadPart &part) const;
    const Contact &contact() const { return reduced_->contact; }
    const vector<double> &contact_stiffness() const { return reduced_->contact.stiffness; }
    const vector<double> &initial_gap() const { return reduced_->contact.initial_gap; }

    /// The state at `fraction` of the period of a point of harmonic balance: eta_0 (r_0), eta r x 2H with
    /// columns a_1, b_1, ..., a_H, b_H. PLM_ERR_ARGUMENT when the sizes do not fit.
    FlowState state(const vector<double> &eta_0, const Matrix &eta, double omega, double fraction) const;
    /// Row of P_0 of a DOF of the full model (n; zeros when it is fixed): q_dof = row . y. A reduced model
    /// without a model has the rows of its vectors as DOFs.
    vector<double> dof_row(std::int64_t dof) const;
    /// q on the free DOFs of the model, one column.
    Field field(const vector<double> &y) const;
    /// y in the coordinates of P_0, and back.
    vector<double> in_static_coordinates(const vector<double> &y) const;
    vector<double> from_static_coordinates(const vector<double> &y) const;

  private:
    void add_structural_damping(double omega);
    void sort_massless();
    double least_damping() const;
    void turn_damping();

    std::shared_ptr<const ReducedModel> reduced_; // widened
    Matrix to_flow_;                              // T: n x r; empty when the coordinates are the dynamic ones
    Matrix turn_; // of the last coordinates: those of P_0 = turn times the flow's; empty: they all have mass
    Matrix gap_, gap_by_pair_, flexibility_, damping_;
    vector<double> lambda_, damping_diagonal_, preload_;
    std::int64_t n_relaxing_ = 0, n_following_ = 0;
    HarmonicLoads excitation_;
    bool walls_move_ = false;
};

} // namespace plm
