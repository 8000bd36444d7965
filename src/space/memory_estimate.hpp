// How much memory a model will take, phase by phase, before it is built; and with what precision its factor
// fits.
#pragma once
#include "space/model_input.hpp"

namespace plm {

/// Bytes. Matrices stay; the factorization holds more while it is made than is kept of it; the others are
/// what a phase holds at most beside the matrices and the factor.
struct MemoryEstimate {
    double structure = 0;
    double factorization = 0, factor = 0; // at most; kept
    double modes = 0, contact_space = 0, basis = 0;
    double peak() const;
};

/// Without a limit of memory: for a factor kept in that precision. The host's solver counts as nothing.
MemoryEstimate estimate_memory(const StructureEstimate &structure, std::int64_t n_pairs,
                               FactorPrecision precision);

/// Of a model as its options ask for it. PLM_ERR_MEMORY with what would fit where nothing does.
MemoryEstimate estimate_memory(const ModelInput &input, const SpaceOptions &options, const HostSolver *host);

/// Who factors for the model, in which precision; PLM_ERR_MEMORY as above.
Solver fitting_solver(const ModelInput &input, const SpaceOptions &options, const HostSolver *host,
                      Watch watch);

} // namespace plm
