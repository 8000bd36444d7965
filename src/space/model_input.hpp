// What a model is made from: all that the caller said, and the options.
#pragma once
#include "space/given_forces.hpp"
#include "structure/structure.hpp"

namespace plm {

/// Of a pair: k_n is chosen when the flexibility is known (PLM_AUTO_STIFFNESS of plm.h).
constexpr double auto_stiffness = -1;

/// All that the caller said, before it is checked as a whole.
struct ModelInput : StructureInput {
    /// Of the pairs of the gap matrix, or auto_stiffness.
    Contact contact;
    GivenForces rest_forces;
};

/// Of a factorization's numbers. automatic: double, unless only single fits the limit of memory.
enum class PrecisionChoice { automatic, full, single };

/// How the contact space (contact_space.hpp) is built; options of the model.
struct SpaceOptions {
    double tolerance = 1e-7; // relative error of the contact receptances at the highest frequency asked for
    double cutoff_factor = 2.0; // exact modes up to this multiple of the highest frequency
    /// Attachment vectors [(K + sigma M)^-1 M]^j (K + sigma M)^-1 B^T, j < max_blocks.
    std::int64_t max_blocks = 4;
    bool verify_counts = true;                 // Sturm count of the modes below the cutoff
    SolverName solver = SolverName::automatic; // of the sparse factorizations
    double reduction_error = 0; // of the matrices themselves, as the host states it; relative, of amplitudes
    PrecisionChoice precision = PrecisionChoice::automatic;
    double memory_limit = 0;       // MiB for the model and all that is made of it at once; 0: no limit
    bool absolute_outputs = false; // sums of DOFs include the motion of the supports, DOFs never do
};

} // namespace plm
