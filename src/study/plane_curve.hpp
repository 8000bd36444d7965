// A response curve in the plane of frequency and amplitude, as cubic pieces with the exact tangents of its
// points. Further points are computed on the curve until the pieces follow it to a tolerance, whatever the
// steps of the sweep were: chords would be 1e-3 off.
#pragma once
#include "searches/hbm.hpp"
#include "study/curve_distance.hpp"

namespace plm {

struct PlaneSamples {
    vector<double> hz, amplitude;
};

/// Both axes of the plane are divided by these.
struct PlaneScale {
    double frequency_hz = 1, amplitude = 1;
};

struct PlaneCurve {
    vector<PlanePiece> pieces;
    double resolution = 0;       // largest distance of the curve from its pieces, estimated
    std::int64_t unresolved = 0; // pieces where no further point of the curve was found
};

/// options: those the branch was computed with, with its frequency range. tolerance: of `resolution`.
PlaneCurve plane_curve(const Branch &branch, const HbmOptions &options, const Output &output,
                       const PlaneScale &scale, double tolerance, Watch watch = Watch());

} // namespace plm
