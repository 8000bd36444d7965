// Small structures as models, and the dense eigenproblems that say what is true of them.
#pragma once
#include "linalg/lapack.hpp"
#include "space/model.hpp"
#include "support/exact_flow.hpp"
#include <functional>
#include <string>
#include <vector>

namespace test {

/// damping_ratios: modal damping instead of the structure's C when not empty; explicit_damping: C as a
/// matrix; mass: n x n instead of the structure's diagonal when not empty.
struct ModelExtras {
    std::vector<double> modal_ratio;
    double alpha = 0, beta = 0;
    bool explicit_damping = false;
    double structural = 0;
    std::vector<double> mass = {};
};
std::shared_ptr<const plm::Model> make_model(const exact::Structure &s, const ModelExtras &extras = {},
                                             const plm::SpaceOptions &options = {});

/// Two chains of n masses side by side, each fixed at one end (or free), coupled by weak springs, with a
/// contact pair between masses i of both for the last n_pairs masses. Everything a little uneven: no
/// symmetric ties.
exact::Structure two_chains(int n, int n_pairs, double contact_stiffness, bool supported);

/// A body that is hinged by a ligament at height -3 and touches a wall with five pairs at the heights -2 ..
/// 2: a breathing crack through five sixths of a section. Open it turns about the ligament, with all pairs on
/// one side; closed about the middle of the section, with pairs on both.
exact::Structure breathing_crack();

/// Eigenvalues and M-orthonormal vectors of K + B^T k B over the closed pairs, dense over all DOFs.
plm::SymmetricEigen dense_modes(const exact::Structure &s, const plm::PairStates &states);
plm::Matrix dense_stiffness(const exact::Structure &s, const plm::PairStates &states);

/// What a call that must fail reports.
struct Failure {
    bool thrown = false;
    int status = 0;
    std::string argument;
};
Failure failure_of(const std::function<void()> &call);

/// Keeps what the library logs as warnings.
struct Recorder : plm::Monitor {
    void log(int level, const std::string &text) override {
        if (level == 2) warnings.push_back(text);
    }
    bool progress(const char *, double) override { return false; }
    std::vector<std::string> warnings;
};

} // namespace test
