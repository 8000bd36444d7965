// The free motions of one contact set: x' = A x of its linear system, x = (root k y, y'), by the
// eigenvectors of A. They advance a motion over any time at once, however stiff the contact is. Real
// coordinates c, x = W c: of a complex pair of eigenvalues the two of z = c_1 + i c_2, z' = lambda z.
#pragma once
#include "orbits/flow_model.hpp"
#include <complex>
#include <map>

namespace plm {

class ContactModes {
  public:
    /// Of a model in which every coordinate has mass.
    ContactModes(const FlowModel &model, const PairStates &states);

    /// False: the eigenvectors are too near to each other, or a motion is free (eigenvalue 0).
    bool usable() const { return usable_; }

    struct Mode {
        std::complex<double> rate;
        std::int64_t first; // coordinate; of a complex pair also the next one
        bool is_pair;
        double speed; // |rate|
    };
    const std::vector<Mode> &modes() const { return modes_; }
    std::int64_t size() const { return to_state_.rows(); } // 2 n

    /// y and y' (n each) of coordinates, and back.
    void to_state(const double *c, double *y, double *v) const;
    void from_state(const double *y, const double *v, double *c) const;
    /// Rows of the displacements, n x 2n, and of the penetrations, Z x 2n, in the coordinates.
    const Matrix &displacement() const { return displacement_; }
    const Matrix &gap() const { return gap_; }
    /// Largest effect of a unit of a mode on a pair: Z x modes.
    const Matrix &reach() const { return reach_; }
    /// Loads in the coordinates: constant ones with the gaps' (they act through the springs), and Re(F_h
    /// exp(i h w t)) of the excitation, real and imaginary part of F_h.
    const vector<double> &constant_load() const { return constant_; }
    struct Load {
        int harmonic;
        vector<double> real, imag;
    };
    const std::vector<Load> &loads() const { return loads_; }

    /// m (2n x k, rows y and y') becomes exp(A dt) m.
    void advance(double dt, Matrix &m, Matrix &scratch) const;
    double bytes() const;

  private:
    void decompose(const FlowModel &model, const Matrix &stiffness);
    vector<double> load_in_coordinates(const vector<double> &force) const;

    std::int64_t n_;
    bool usable_ = false;
    vector<double> root_; // n
    std::vector<Mode> modes_;
    Matrix to_state_, from_state_, displacement_, gap_, reach_;
    vector<double> constant_;
    std::vector<Load> loads_;
};

/// Those of the contact sets that a model comes back to. Made when a set has been passed often enough for the
/// eigenvectors to be cheaper than what goes on without them.
class ContactModesKept {
  public:
    explicit ContactModesKept(std::shared_ptr<const FlowModel> model) : model_(std::move(model)) {}
    /// Null: not (yet). `effort`: pieces of a Taylor series that the last visit took.
    const ContactModes *find(const PairStates &states, std::int64_t effort);

  private:
    struct Entry {
        std::int64_t effort = 0, last_use = 0;
        std::unique_ptr<ContactModes> modes;
        bool tried = false;
    };
    void make_room(double bytes);

    std::shared_ptr<const FlowModel> model_;
    std::map<PairStates, Entry> entries_;
    std::int64_t clock_ = 0;
    double bytes_ = 0;
};

} // namespace plm
