// The structure with its contact: M q'' + C q' + K q = F(t) - B^T N(B q - g), checked once and then
// read-only.
#pragma once
#include "contact/contact.hpp"
#include "structure/structure.hpp"

namespace plm {

/// All that the caller said, before it is checked as a whole.
struct ModelInput : StructureInput {
    /// Of the pairs of the gap matrix. PLM_AUTO_STIFFNESS: chosen when the flexibility is known.
    Contact contact;
};

/// Of a factorization's numbers. automatic: double, unless only single fits the limit of memory.
enum class PrecisionChoice { automatic, full, single };

/// How the contact space (contact_space.hpp) is built; options of the model.
struct SpaceOptions {
    double tolerance = 1e-7; // relative error of the contact receptances at the highest frequency asked for
    double cutoff_factor = 2.0; // exact modes up to this multiple of the highest frequency
    /// Attachment vectors (K + sigma M)^-1 [M (K + sigma M)^-1]^j B^T, j < max_blocks.
    std::int64_t max_blocks = 4;
    bool verify_counts = true;                 // Sturm count of the modes below the cutoff
    SolverName solver = SolverName::automatic; // of the sparse factorizations
    double reduction_error = 0; // of the matrices themselves, as the host states it; relative, of amplitudes
    PrecisionChoice precision = PrecisionChoice::automatic;
    double memory_limit = 0; // MiB for the model and all that is made of it at once; 0: no limit
};

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
