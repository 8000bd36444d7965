// How far one curve in the plane lies from another: over the arc length of the reference, so that folds do
// not spoil it.
#pragma once
#include "linalg/memory.hpp"
#include <cstdint>

namespace plm {

struct PlanePoint {
    double x = 0, y = 0;
};

/// A cubic between two points with the directions of the tangents there (unit vectors): the curve's shape to
/// the fourth order of the distance of the points.
struct PlanePiece {
    PlanePoint from, to, from_direction, to_direction;
};

/// The piece's point at u in [0, 1].
PlanePoint point_on(const PlanePiece &piece, double u);
double length_of(const PlanePiece &piece);

/// The piece's nearest point: how far it is, and the direction of the piece there (a unit vector).
struct Nearest {
    double distance = 0;
    PlanePoint direction;
};
Nearest nearest_on(const PlanePiece &piece, PlanePoint point);

/// Smallest distance of the point from the curve; infinite from an empty one.
double distance(PlanePoint point, const vector<PlanePiece> &curve);

/// n points equally spaced over the arc length of the curve, its ends among them (n >= 2).
vector<PlanePoint> equally_spaced(const vector<PlanePiece> &curve, std::int64_t n);

struct CurveDistance {
    double rms = 0, max = 0;
};
CurveDistance curve_distance(const vector<PlanePoint> &points, const vector<PlanePiece> &curve);

} // namespace plm
