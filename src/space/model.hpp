// The structure: M q'' + C q' + K q = F(t) - B^T N(B q - g), on its free DOFs, checked once and then
// read-only.
#pragma once
#include "contact/contact.hpp"
#include "linalg/monitor.hpp"
#include "structure/solver/factor.hpp"
#include "structure/translations.hpp"
#include <complex>
#include <map>
#include <memory>

namespace plm {

/// Complex amplitude of one excitation harmonic, F(t) = Re(F exp(i h omega t)); `imag` is empty for h = 0.
struct HarmonicLoad {
    vector<double> real, imag;
};

struct Damping {
    double alpha = 0, beta = 0; // C = alpha M + beta K
    double structural = 0;      // K (1 + i eta), h >= 1
    vector<double> modal_ratio; // of the open system's modes, the last one for all beyond
    bool has_matrix = false;    // an explicit C is present (Model::damping_matrix)
};

/// One matrix as the caller gave it: what to read, checked at the entry. Borrowed arrays stay the caller's.
struct MatrixInput; // src/model/matrix_input.hpp

/// All that the caller said, before it is checked as a whole. Indices base 0 over all n_dof.
struct ModelInput {
    std::int64_t n_dof = 0;
    std::shared_ptr<const MatrixInput> mass, stiffness, damping_matrix;
    Damping damping;
    vector<std::int64_t> fixed; // DOFs held at zero, in any order, some perhaps twice
    // gap matrix by rows: B = [pair; dof; coefficient] triplets, one stiffness and gap per pair
    vector<std::int64_t> gap_pair, gap_dof;
    vector<double> gap_coefficient;
    Contact contact;        // stiffness PLM_AUTO_STIFFNESS: chosen when the flexibility is known
    vector<double> preload; // empty: none
    std::map<int, HarmonicLoad> excitation; // by harmonic
};

/// How the contact space (contact_space.hpp) is built; options of the model.
struct SpaceOptions {
    double tolerance = 1e-7; // relative error of the contact receptances at the highest frequency asked for
    double cutoff_factor = 2.0; // exact modes up to this multiple of the highest frequency
    std::int64_t max_blocks =
        4; // attachment vectors (K + sigma M)^-1 [M (K + sigma M)^-1]^j B^T, j < max_blocks
    bool verify_counts = true; // Sturm count of the modes below the cutoff
};

class Model {
  public:
    /// Checks the input as a whole, removes fixed DOFs, factors K (or K + sigma M when K is singular), finds
    /// rigid-body modes. Throws plm::Error with the argument and index at fault.
    Model(const ModelInput &input, const SpaceOptions &options, const HostSolver *host, Watch watch);
    ~Model();
    Model(const Model &) = delete;

    std::int64_t n_dof() const { return n_dof_; }
    std::int64_t n_free() const { return static_cast<std::int64_t>(free_dof_.size()); }
    std::int64_t n_pairs() const { return gap_matrix_.rows; }
    const vector<std::int64_t> &free_dof() const { return free_dof_; } // free index -> DOF
    /// DOF -> free index, or -1 when fixed.
    std::int64_t free_index(std::int64_t dof) const { return free_of_[dof]; }

    // all below on the free DOFs
    const SparseMatrix &mass() const { return mass_; }
    const SparseMatrix &stiffness() const { return stiffness_; }
    const SparseMatrix &damping_matrix() const {
        return damping_matrix_;
    } // explicit part only; 0 x 0 if none
    const Damping &damping() const { return damping_; }
    const SparseMatrix &gap_matrix() const { return gap_matrix_; } // Z x n_free
    const Contact &contact() const { return contact_; }
    const vector<double> &contact_stiffness() const { return contact_.stiffness; } // k_n, resolved
    const vector<double> &initial_gap() const { return contact_.initial_gap; }
    /// 1 / median of the contact flexibility diag(B K^-1 B^T), rigid-body motion left out; 0 without pairs.
    double local_stiffness() const { return local_stiffness_; }
    bool has_preload() const { return !preload_.empty(); }
    const vector<double> &preload() const { return preload_; }
    const std::map<int, HarmonicLoad> &excitation() const { return excitation_; }

    /// Motions known to strain nothing before supports are applied; empty where the matrices do not tell.
    const vector<Translation> &translations() const { return translations_; }
    /// Norm of the harmonic excitation on fixed DOFs, where it does nothing.
    double excitation_on_supports() const { return excitation_on_supports_; }

    /// Factor of K + shift() M; shift() is 0 when K is positive definite.
    const Factor &factor() const { return *factor_; }
    double shift() const { return shift_; }
    /// M-orthonormal rigid-body modes of the open structure (n_free x count, may have no column).
    const Matrix &rigid_modes() const { return rigid_modes_; }
    /// What rounding of K makes of the first elastic eigenvalue where there are rigid-body modes, relative.
    double uncertainty() const { return uncertainty_; }
    /// (K + shift M)^-1 B^T, n_free x Z: computed once, at the build (auto stiffness and every space need
    /// it).
    const Matrix &attachment() const { return attachment_; }
    const SpaceOptions &space_options() const { return space_options_; }
    const HostSolver *host_solver() const { return host_; }

    /// q over all DOFs (n_dof) from free DOFs (n_free), fixed ones zero; and the inverse restriction.
    void expand(const double *free, double *all) const;
    void restrict_to_free(const double *all, double *free) const;

  private:
    void assemble(const ModelInput &input);
    void assemble_matrices(const ModelInput &input);
    void assemble_gap(const ModelInput &input);
    void assemble_loads(const ModelInput &input);
    void factor_stiffness(Watch watch);
    void resolve_contact_stiffness();

    std::int64_t n_dof_ = 0;
    vector<std::int64_t> free_dof_, free_of_;
    SparseMatrix mass_, stiffness_, damping_matrix_, gap_matrix_;
    Damping damping_;
    Contact contact_;
    vector<double> preload_;
    std::map<int, HarmonicLoad> excitation_;
    vector<Translation> translations_;
    double excitation_on_supports_ = 0;
    double local_stiffness_ = 0, shift_ = 0, uncertainty_ = 0;
    std::unique_ptr<Factor> factor_;
    Matrix rigid_modes_, attachment_;
    SpaceOptions space_options_;
    HostSolver host_copy_;
    const HostSolver *host_ = nullptr;
};

} // namespace plm
