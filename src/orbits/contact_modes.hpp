// The free motions of one contact set: x' = A x of its linear system, x = (root k y, y'), by the
// eigenvectors of A. They advance a motion over any time at once, however stiff the contact is. Real
// coordinates c, x = W c: of a complex pair of eigenvalues the two of z = c_1 + i c_2, z' = lambda z.
// Motions that nothing brings back, as of a free body, have eigenvalues 0 whose eigenvectors coincide: they
// are kept as the last coordinates, which a small matrix moves. What relaxes without mass has no y' in x;
// what follows at once is not in x at all, but where the contact and the loads of the moment put it.
#pragma once
#include "linalg/lapack.hpp"
#include "orbits/contact_set.hpp"
#include <complex>
#include <map>
#include <memory>

namespace plm {

class ContactModes {
  public:
    ContactModes(const FlowModel &model, const PairStates &states);

    const ContactSet &set() const { return set_; }
    /// False: the eigenvectors are too near to each other.
    bool usable() const { return usable_; }
    /// The eigenvectors are so far from each other that products in single precision keep five digits.
    bool usable_in_single() const { return usable_ && condition_ > well_conditioned; }

    struct Mode {
        std::complex<double> rate;
        std::int64_t first; // coordinate; of a complex pair also the next one
        bool is_pair;
        double speed; // |rate|
    };
    const std::vector<Mode> &modes() const { return modes_; }
    /// Of the free motions: their coordinates, the last of all, c' = S c.
    const Matrix &free_block() const { return free_; }
    std::int64_t first_free() const { return size() - free_.rows(); }
    double free_speed() const { return free_speed_; }      // the largest modulus of their rates
    std::int64_t size() const { return to_state_.rows(); } // that of the model's state

    /// y of what moves and y' of what has mass, of coordinates, and back.
    void to_state(const double *c, double *y, double *v) const;
    void from_state(const double *y, const double *v, double *c) const;
    /// Rows of all displacements, n x size, and of the penetrations, as columns, size x Z, in the
    /// coordinates.
    const Matrix &displacement() const { return displacement_; }
    const Matrix &gap_by_pair() const { return gap_by_pair_; }
    const vector<double> &gap_size() const { return gap_size_; } // norms of its columns
    /// Largest effect of a unit of a mode on a pair: Z x modes.
    const Matrix &reach() const { return reach_; }
    /// A load: on the coordinates, and what it does at once to the penetrations (Z) and to the displacements
    /// of what follows (the model's n_following). Constant ones with the gaps', and w^p Re(F_h exp(i h w t))
    /// of the excitation, real and imaginary part of F_h.
    struct Load {
        vector<double> coordinates, gap, following;
    };
    const Load &constant_load() const { return constant_; }
    struct Harmonic {
        LoadPart part;
        Load real, imag;
        double frequency(double omega) const { return part.harmonic * omega; }
    };
    const std::vector<Harmonic> &loads() const { return loads_; }

    /// m (size x k, rows y and y') becomes the coordinates that belong to it; these, exp(A dt) times them;
    /// and back.
    void enter(Matrix &m) const;
    template <class Real> void turn(double dt, vector<Real> &coordinates) const;
    void leave(Matrix &coordinates) const;
    /// A row that is multiplied by states becomes one that is multiplied by their coordinates; and back.
    void enter_row(vector<double> &row) const;
    void leave_row(vector<double> &row) const;
    /// From these coordinates into those of another set's modes, at the same state: size x size.
    Matrix transition(const ContactModes &to) const;
    double bytes() const;

  private:
    static constexpr double well_conditioned = 1e-4; // reciprocal condition
    Matrix system_matrix(const FlowModel &model, const Matrix &stiffness);
    void decompose(const Matrix &system);
    bool take(const GeneralEigen &eigen, const SplitSpectrum *split);
    void find_displacements(const FlowModel &model);
    Load load_of(const FlowModel &model, const vector<double> &force, const vector<double> &gap) const;

    ContactSet set_;
    std::int64_t moving_, massive_; // coordinates that move, the first ones; of them those with mass
    bool usable_ = false;
    double condition_ = 0; // reciprocal, of the eigenvectors
    double free_speed_ = 0;
    vector<double> root_; // of the stiffness of each coordinate that moves: y enters x times this
    std::vector<Mode> modes_;
    Matrix free_;                  // see free_block()
    Matrix to_state_, from_state_; // W, and its inverse
    Matrix displacement_, gap_by_pair_, reach_;
    vector<double> gap_size_;
    Load constant_;
    std::vector<Harmonic> loads_;
};

/// Those of the contact sets that a model comes back to, and the ways from one to the next. Made when a set
/// has been passed often enough for the eigenvectors to be cheaper than what goes on without them.
class ContactModesKept {
  public:
    explicit ContactModesKept(std::shared_ptr<const FlowModel> model) : model_(std::move(model)) {}
    /// Null: not (yet). `effort`: pieces of a Taylor series that the visit takes without them.
    std::shared_ptr<const ContactModes> find(const PairStates &states, std::int64_t effort);
    /// Without any effort: null where they have not been made, or are not usable.
    std::shared_ptr<const ContactModes> known(const PairStates &states) const;
    /// ContactModes::transition(), kept, in double or single precision. Valid until the next call of any of
    /// these.
    template <class Real>
    const vector<Real> &transition(const std::shared_ptr<const ContactModes> &from,
                                   const std::shared_ptr<const ContactModes> &to);
    /// Null where it has not been asked for.
    const vector<double> *known_transition(const std::shared_ptr<const ContactModes> &from,
                                           const std::shared_ptr<const ContactModes> &to) const;
    /// What ended the last stay in a set, as far as a flow has said so: the pair (-1: none is known), and
    /// the excitation's angle then.
    struct Stay {
        std::int64_t pair = -1;
        double angle = 0;
    };
    Stay &last_stay(const PairStates &states) { return entries_[states].stay; }
    /// Where single motions are looked at from now on.
    void forget_transitions();
    /// Forgets all but the sets whose modes are known, which it returns, the last used ones last: what comes
    /// depends on these alone, and is the same where others take() them.
    std::vector<PairStates> settle();
    void take(const std::vector<PairStates> &sets);

  private:
    struct Entry {
        std::int64_t effort = 0;                   // pieces of series that visits have taken so far
        std::int64_t last_use = 0;                 // by clock_: what was used longest ago makes room first
        std::shared_ptr<const ContactModes> modes; // null: not made, or not usable
        bool tried = false;                        // made once: usable, or never
        Stay stay;
    };
    /// Forgets modes and transitions until so many bytes fit.
    void make_room(double bytes);
    using Known = std::pair<PairStates, std::shared_ptr<const ContactModes>>;
    void begin_with(const std::vector<Known> &known);

    std::shared_ptr<const FlowModel> model_;
    std::map<PairStates, Entry> entries_;
    using Way = std::pair<std::shared_ptr<const ContactModes>, std::shared_ptr<const ContactModes>>;
    template <class Real> std::map<Way, vector<Real>> &transitions();
    std::map<Way, vector<double>> transitions_;
    std::map<Way, vector<float>> single_transitions_;
    std::int64_t clock_ = 0; // counts uses
    double bytes_ = 0;       // that all of it takes
};

} // namespace plm
