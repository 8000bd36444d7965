#include "structure/surface_projection.hpp"
#include <algorithm>
#include <limits>
#include <numeric>

namespace plm {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// The nodes of a face, gathered.
int gather(const SurfaceMesh &mesh, std::int64_t face, Point *node) {
    const int n = mesh.n_nodes(face);
    for (int i = 0; i < n; ++i) node[i] = mesh.node[mesh.nodes(face)[i]];
    return n;
}

} // namespace

Surface::Surface(SurfaceMesh mesh) : mesh_(std::move(mesh)), order_(mesh_.n_faces()) {
    std::iota(order_.begin(), order_.end(), 0);
    vector<Box> boxes;
    for (std::int64_t face = 0; face < mesh_.n_faces(); ++face) boxes.push_back(box_of(face));
    branches_.push_back({{}, 0, mesh_.n_faces(), -1});
    for (std::size_t k = 0; k < branches_.size(); ++k) split(static_cast<std::int64_t>(k), boxes);
}

Surface::Box Surface::box_of(std::int64_t face) const {
    Point node[most_face_nodes], hull[most_hull_points];
    const int n = hull_of_face(node, gather(mesh_, face, node), hull);
    Box box{hull[0], hull[0]};
    for (int i = 1; i < n; ++i)
        for (int k = 0; k < 3; ++k)
            box.low[k] = std::min(box.low[k], hull[i][k]), box.high[k] = std::max(box.high[k], hull[i][k]);
    return box;
}

// In halves, across the direction in which the faces reach farthest.
void Surface::split(std::int64_t branch, const vector<Box> &boxes) {
    constexpr std::int64_t few = 2;
    Branch b = branches_[branch];
    b.box = boxes[order_[b.first]];
    for (std::int64_t i = b.first; i < b.end; ++i)
        for (int k = 0; k < 3; ++k) {
            const Box &box = boxes[order_[i]];
            b.box.low[k] = std::min(b.box.low[k], box.low[k]);
            b.box.high[k] = std::max(b.box.high[k], box.high[k]);
        }
    const Point reach = difference(b.box.high, b.box.low);
    const auto axis = std::max_element(reach.begin(), reach.end()) - reach.begin();
    const auto middle = [&](std::int64_t face) {
        const auto k = static_cast<std::size_t>(axis);
        return boxes[face].low[k] + boxes[face].high[k];
    };
    if (b.end - b.first > few) {
        const std::int64_t half = b.first + (b.end - b.first) / 2;
        std::nth_element(order_.begin() + b.first, order_.begin() + half, order_.begin() + b.end,
                         [&](std::int64_t i, std::int64_t j) {
                             return middle(i) != middle(j) ? middle(i) < middle(j) : i < j;
                         });
        b.below = static_cast<std::int64_t>(branches_.size());
        branches_.push_back({{}, b.first, half, -1});
        branches_.push_back({{}, half, b.end, -1});
    }
    branches_[branch] = b;
}

double Surface::square_distance(const Box &box, const Point &to) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double off = std::max({box.low[k] - to[k], to[k] - box.high[k], 0.0});
        sum += off * off;
    }
    return sum;
}

ClosestPoint Surface::closest_on(std::int64_t face, const Point &to) const {
    Point node[most_face_nodes];
    return closest_on_face(node, gather(mesh_, face, node), to);
}

// Of faces that are equally near the first one, whatever the order in which they are met.
Projection Surface::closest(const Point &to) const {
    Projection best;
    best.point.distance = infinite;
    const auto may_hold = [&](double square) { return square <= best.point.distance * best.point.distance; };
    std::vector<std::pair<double, std::int64_t>> waiting{{square_distance(branches_[0].box, to), 0}};
    while (!waiting.empty()) {
        const auto [square, at] = waiting.back();
        waiting.pop_back();
        if (!may_hold(square)) continue;
        const Branch &b = branches_[at];
        if (b.below < 0) {
            for (std::int64_t i = b.first; i < b.end; ++i) {
                const std::int64_t face = order_[i];
                const ClosestPoint point = closest_on(face, to);
                if (best.face < 0 || point.distance < best.point.distance ||
                    (point.distance == best.point.distance && face < best.face))
                    best = {face, point};
            }
            continue;
        }
        std::pair<double, std::int64_t> near{square_distance(branches_[b.below].box, to), b.below},
            far{square_distance(branches_[b.below + 1].box, to), b.below + 1};
        if (far.first < near.first) std::swap(near, far);
        waiting.push_back(far);
        waiting.push_back(near);
    }
    return best;
}

} // namespace plm
