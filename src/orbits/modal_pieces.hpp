// Pieces of a flow in the modes of its contact set. A piece is as long as the slow modes allow whose motion
// its polynomials describe; the free motion of the fast ones is known by its exponentials, and as long as it
// is too small to bring a pair to zero nothing has to resolve it.
#pragma once
#include "contact/piece_penetrations.hpp"
#include "orbits/contact_modes.hpp"
#include "orbits/flow_piece.hpp"

namespace plm {

class ModalPieces {
  public:
    ModalPieces(const FlowModel &model, double omega, double force_scale, FlowParameter parameter)
        : model_(model), omega_(omega), force_scale_(force_scale), parameter_(parameter) {}

    /// Goes on from a state (and its change) in the linear system of these modes. False: a load is in
    /// resonance with one of them, by which would be divided.
    bool enter(std::shared_ptr<const ContactModes> modes, const FlowState &state, const FlowState &change);
    bool inside() const { return modes_ != nullptr; }
    const std::shared_ptr<const ContactModes> &modes() const { return modes_; }
    /// Goes on in the modes of another set where the last piece went to: by ContactModes::transition(), in
    /// the place of leave() and enter(). False as there; it is then where it was.
    bool pass(std::shared_ptr<const ContactModes> to, const vector<double> &transition);
    double now() const { return now_; }
    /// The state (and its change) where the last piece went to. Velocities without mass become zero:
    /// ExactFlow::complete().
    void leave(FlowState &state, FlowState &change);

    /// Polynomials over the longest piece, no longer than `longest`, that the pairs' distances from zero
    /// allow; its length.
    double expand(double longest);
    /// Penetrations without the fast modes, each nearer to zero by all that these may add.
    const PiecePenetrations &penetrations() const { return penetrations_; }
    /// Whether fast modes act on a pair: its zero is then not an event, but as far as the piece goes.
    bool is_veiled(std::int64_t pair) const { return veil_[static_cast<std::size_t>(pair)] > 0; }
    /// Displacements as polynomials, n x terms, and what the fast modes add.
    const Matrix &coefficient();
    const FastMotion &fast() const { return fast_; }
    /// Of the penetrations, by the size of the coordinates (Z).
    const vector<double> &rounding() const { return tiny_; }
    /// To `duration` beyond the beginning of the last piece.
    void advance(double duration);

    /// Integral of Re(load exp(i frequency t)) . y from now on (modal_work.cpp). Not with free motions.
    double work(const HarmonicLoad &load, double frequency, double duration) const;

    /// In the place of expand(), where no polynomials are needed (modal_stay.cpp). False: free motions are
    /// known by their powers alone.
    bool begin_stay();
    /// Penetrations and their rates at `duration` from now, Z x 2.
    void look(double duration, Matrix &u);
    /// Bounds of the fourth derivatives of the penetrations until then (Z).
    const vector<double> &fourth(double duration);
    /// How long from now a pair takes to zero, by Newton's method from a guess; NaN: it finds none.
    double zero_of(std::int64_t pair, double guess) const;

  private:
    using Complex = std::complex<double>;
    static constexpr std::int64_t flops_of_mode = 200; // its exponential, and its loads
    // Response of one mode to one load: (plus (t) e^{iht} + minus (t) e^{-iht}), linear in t for the change.
    struct Steady {
        Complex plus, minus, plus_slope, minus_slope;
        double size; // |plus| + |minus|
    };
    using Part = vector<double> ContactModes::Load::*; // the gaps' or what follows
    double scale(const ContactModes::Harmonic &load) const { return force_scale_ * load.part.growth(omega_); }
    bool set_steady();
    bool begin(const vector<double> &coordinates, const vector<double> &changed);
    vector<double> changed_now() const;
    /// What the loads put aside at once: at a time; as powers of the share of a piece, added to the last
    /// rows.
    void put_aside(Part part, double time, vector<double> &sum) const;
    void add_put_aside(Part part, Matrix &powers) const;
    void steady_at(double time, vector<double> &motion, vector<double> *change) const;
    void turn_free(const vector<double> &from, vector<double> &to) const;
    void veil(double duration, vector<double> &sum) const;
    bool allows(double duration);
    void bound_travel();
    void find_penetrations();
    void fill_powers(double duration);
    void add_free_powers(double duration);
    void add_steady_powers(std::size_t load, double duration);
    void keep_fast();
    /// The free motions, whose coordinates are the last ones: from the values given to powers of the share of
    /// a piece, under the loads or under what the parameter changes of them.
    void expand_free(const double *from, bool changed, double duration, Matrix &powers) const;
    void advance_free(double share);
    void sum_rounding();

    const FlowModel &model_;
    double omega_, force_scale_;
    FlowParameter parameter_;
    std::shared_ptr<const ContactModes> modes_;
    double start_ = 0, now_ = 0;                 // of the stay in the set; of the last piece
    vector<double> constant_, changed_constant_; // c, steady under the constant loads
    std::vector<std::vector<Steady>> steady_;    // by load and mode
    vector<double> free_, changed_free_;         // free part of c at start_
    vector<double> present_, at_now_;            // free part at now_; c there
    vector<double> changed_unheld_;              // of the free motions at now_
    Matrix unheld_powers_, changed_unheld_powers_;
    vector<double> both_, passed_;            // c and its change, before and after pass()
    bool puts_aside_ = false;                 // the harmonic loads do, too
    vector<double> veil_, tiny_;              // of the pairs
    vector<double> now_penetration_, travel_; // of the pairs; how far each may go within the piece
    PiecePenetrations penetrations_;
    vector<double> aside_;                       // of the pairs or of what follows
    vector<double> size_, inverse_;              // |z| of the modes; 1, 1/2, 1/3, ...
    vector<std::int64_t> first_;                 // of the modes that a piece resolves
    vector<double> re_, im_, turn_re_, turn_im_; // their z and rate x duration
    vector<double> even_, odd_;                  // of the coordinates
    Matrix powers_;                              // size x terms
    Matrix aside_powers_, coefficient_;
    FastMotion fast_;
    double duration_ = 0;
    std::int64_t n_terms_ = 0;
    Matrix ahead_;                // coordinates and their rates, size x 2
    vector<double> way_, fourth_; // of the modes, of the pairs
};

} // namespace plm
