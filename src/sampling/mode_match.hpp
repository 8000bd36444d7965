// Which mode of one linear system resembles a given shape: the mass-weighted modal assurance criterion (MAC).
// In the coordinates of a Space it is the squared cosine of the coordinates that have mass. Modes of one
// frequency are turned so that one of them has all that they resemble the shape together.
#pragma once
#include "space/space.hpp"

namespace plm {

/// (x . y)^2 / ((x . x) (y . y)); 0 when one of them vanishes.
double mac(std::int64_t n, const double *x, const double *y);

/// sqrt(lambda) / 2 pi
double to_hz(double eigenvalue);

struct MatchedModes {
    SpaceModes modes;
    vector<double> mac;     // of each mode with the reference shape
    std::int64_t best = -1; // the highest of those that move the contact, if there are any; of equal ones the
                            // lowest. -1: the space has no mode
    bool moves = false;     // it moves the contact
    double likeness = 0;    // MAC of that one with what of the shape moves the contact
    std::int64_t rival = -1; // one of another frequency that resembles the shape as well, or -1
};

/// The modes of a contact set below `upper` (rad^2/s^2), and beyond it as far as is needed to be sure of the
/// best match: all modes together make up the shape, so the search ends when those found leave too little for
/// a better one.
MatchedModes match_modes(const Space &space, const PairStates &states, const vector<double> &shape,
                         double upper);

} // namespace plm
