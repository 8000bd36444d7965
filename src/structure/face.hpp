// A face of an element: its shape functions, and its point that is closest to a given one.
#pragma once
#include "structure/point.hpp"
#include <cstdint>
#include <vector>

namespace plm {

/// Of 3, 4, 6 or 8 nodes: the corners around, then, with 6 and 8, those in the middle of the sides, from the
/// side between the first two corners on.
constexpr int most_face_nodes = 8;
bool is_face(std::int64_t n_nodes);

struct ClosestPoint {
    std::array<double, most_face_nodes> weight{}; // shape functions there, whose sum is 1
    Point at{};
    Point normal{}; // unit, by the right-hand rule around the corners; zero where the face has no area
    double distance = 0;
};
ClosestPoint closest_on_face(const Point *node, int n_nodes, const Point &to);

/// Points that integrate over the face, each with the area it stands for: what its shape functions and
/// polynomials a degree above them take on a plane face is exact (with middle nodes: two degrees above).
struct FacePoint {
    std::array<double, most_face_nodes> weight{};
    Point at{};
    Point normal{}; // as above
    double area = 0;
};
std::vector<FacePoint> face_points(const Point *node, int n_nodes);
/// At each of its nodes; zero where two sides fall together there.
void normals_at_nodes(const Point *node, int n_nodes, Point *normal);

/// Whose hull holds all of the face, curved as it may be; returns how many there are.
constexpr int most_hull_points = 9;
int hull_of_face(const Point *node, int n_nodes, Point *hull);

} // namespace plm
