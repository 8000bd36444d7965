// A subspace of the free DOFs in which M and K are diagonal, with everything the reduced problem needs
// projected on it. The contact space (unreduced structure to a tolerance) and Craig-Bampton are two ways to
// make one.
//
// Directions without mass have no frequency: they follow statically, and so do those whose inertia does not
// count (massless.hpp). They are coordinates like the others, with a stiffness and their damping, but no
// mass.
#pragma once
#include "linalg/kept.hpp"
#include "space/linear_contact.hpp"
#include "space/model.hpp"
#include "space/space_vectors.hpp"
#include <limits>

namespace plm {

struct RestState; // space/rest.hpp

struct Space {
    std::shared_ptr<const Model> model;
    SpaceVectors vectors;            // V: n_free x m; V^T M V = diag(mass)
    vector<double> lambda;           // V^T K V = diag(lambda), >= 0 (rigid-body modes: exactly 0), ascending
    std::int64_t n_massless = 0;     // the last ones: mass 0, and one stiffness for all
    Matrix gap;                      // B V: Z x m
    vector<double> damping_diagonal; // V^T C V = diag(...) when the damping is proportional or modal
    Matrix damping;                  // V^T C V, m x m, when an explicit C is present; else empty
    vector<double> preload;          // V^T F_preload, m; empty without pre-load
    HarmonicLoads excitation;        // V^T F_h
    std::int64_t n_exact_modes = 0;  // the first ones are exact modes of the open system
    double highest_frequency = 0;    // the space is accurate up to here (rad/s)
    double error_estimate = 0;       // relative error of the contact receptances there; 0 when not estimated
    bool is_contact_space = false;   // the unreduced structure to the model's tolerance (make_contact_space)
    std::shared_ptr<const StaticResponses> responses; // contact space: what it was made from
    bool counts_verified = false;                     // Sturm count agreed
    double seconds = 0;      // contact space: of making it, with the earlier ones it was made from
    Kept<RestState> rest;    // rest_of()
    std::string description; // "78 open modes below 20.1 kHz + 2 x 92 attachment vectors, error 3e-8"

    /// All but its vectors, of which one row is written; what asks for others answers PLM_ERR_STATE.
    void write(ByteWriter &bytes) const;
    static std::shared_ptr<const Space> read(ByteReader &bytes, std::shared_ptr<const Model> model);

    std::int64_t size() const { return static_cast<std::int64_t>(lambda.size()); }
    std::int64_t n_massive() const { return size() - n_massless; }
    double mass(std::int64_t j) const { return j < n_massive() ? 1.0 : 0.0; }
    std::int64_t n_pairs() const { return model->contact().n_pairs(); }
};

/// Fills damping and loads of a space whose vectors, lambda and gap are set.
void project_onto(Space &space);

/// Modes of the linear system in which every pair keeps its state, those below `upper` (rad^2/s^2), or all
/// when upper is infinite.
SpaceModes modes_of_contact_set(const Space &space, const PairStates &states, double upper);

/// How far a contact space goes that is to be a first one.
struct SpaceLimits {
    bool provisional = false; // another one with a highest frequency follows, which verifies the modes
    /// Where more exact modes are counted, it reaches less far, but to this frequency (rad/s).
    std::int64_t most_modes = std::numeric_limits<std::int64_t>::max();
    double least_frequency = 0;
};

/// The contact space: exact open modes up to cutoff_factor x highest_frequency, and contact attachment
/// vectors block by block until the receptance error at highest_frequency (rad/s) is below the model's
/// tolerance. previous: an earlier contact space of the same model or null; it is returned when it already
/// serves, and its exact modes are used again when they reach far enough.
std::shared_ptr<const Space> make_contact_space(std::shared_ptr<const Model> model, double highest_frequency,
                                                std::int64_t least_modes, Watch watch,
                                                std::shared_ptr<const Space> previous = nullptr,
                                                const SpaceLimits &limits = {});

} // namespace plm
