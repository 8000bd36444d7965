#include "structure/surface_normals.hpp"
#include <algorithm>

namespace plm {
namespace {

constexpr double less_than_45_degrees = 0.7;

void add(Point &to, double factor, const Point &x) {
    for (std::size_t k = 0; k < 3; ++k) to[k] += factor * x[k];
}

// Zero where hardly anything is left.
void normalise(Point &x, double of) {
    const double size = length(x);
    for (double &c : x) c = size > 1e-9 * of ? c / size : 0;
}

} // namespace

SurfaceNormals::SurfaceNormals(const SurfaceMesh &mesh)
    : area_(mesh.node.size(), 0.0), at_node_(mesh.node.size()), face_ptr_(mesh.face_ptr),
      of_corner_(mesh.face_node.size()), smooth_(mesh.face_node.size()) {
    for (std::int64_t face = 0; face < mesh.n_faces(); ++face) take_face(mesh, face);
    for (std::size_t i = 0; i < at_node_.size(); ++i) normalise(at_node_[i], area_[i]);
    smooth_corners(mesh);
    bend_rims(mesh);
}

void SurfaceNormals::take_face(const SurfaceMesh &mesh, std::int64_t face) {
    const int n = mesh.n_nodes(face);
    const bool has_middles = n > 4;
    Point node[most_face_nodes], mean{};
    for (int i = 0; i < n; ++i) node[i] = mesh.node[mesh.nodes(face)[i]];
    std::array<double, most_face_nodes> share{};
    double area = 0, shares = 0;
    for (const FacePoint &p : face_points(node, n)) {
        area += p.area;
        add(mean, p.area, p.normal);
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
            const double part = p.area * p.weight[i] * (has_middles ? p.weight[i] : 1);
            share[i] += part, shares += part;
        }
    }
    normalise(mean, area);
    face_area_.push_back(area);
    of_face_.push_back(mean);
    Point *corner = of_corner_.data() + mesh.face_ptr[face];
    normals_at_nodes(node, n, corner);
    for (int i = 0; i < n; ++i) {
        const std::int64_t at = mesh.nodes(face)[i];
        if (dot(corner[i], corner[i]) == 0) corner[i] = mean;
        const double part = shares > 0 ? area * share[static_cast<std::size_t>(i)] / shares : 0;
        area_[at] += part;
        add(at_node_[at], part, corner[i]);
    }
}

void SurfaceNormals::smooth_corners(const SurfaceMesh &mesh) {
    const auto n_places = static_cast<std::int64_t>(mesh.face_node.size());
    vector<std::int64_t> order(n_places), face_of(n_places);
    for (std::int64_t face = 0; face < mesh.n_faces(); ++face)
        std::fill(face_of.begin() + mesh.face_ptr[face], face_of.begin() + mesh.face_ptr[face + 1], face);
    for (std::int64_t p = 0; p < n_places; ++p) order[p] = p;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int64_t a, std::int64_t b) { return mesh.face_node[a] < mesh.face_node[b]; });
    for (auto first = order.begin(); first != order.end();) {
        const auto end = std::find_if(
            first, order.end(), [&](std::int64_t p) { return mesh.face_node[p] != mesh.face_node[*first]; });
        for (auto p = first; p != end; ++p) {
            double sum = 0;
            for (auto q = first; q != end; ++q) {
                if (dot(of_corner_[*p], of_corner_[*q]) < less_than_45_degrees) continue;
                add(smooth_[*p], face_area_[face_of[*q]], of_corner_[*q]);
                sum += face_area_[face_of[*q]];
            }
            normalise(smooth_[*p], sum);
        }
        first = end;
    }
}

bool SurfaceNormals::is_smooth_across(const SurfaceMesh &mesh, std::int64_t face, int side) const {
    const std::int64_t *node = mesh.nodes(face);
    const std::vector<std::int64_t> &both =
        faces_at_.at(std::minmax({node[side], node[(side + 1) % mesh.n_nodes(face)]}));
    return std::any_of(both.begin(), both.end(), [&](std::int64_t f) {
        return f != face && dot(of_face_[f], of_face_[face]) >= less_than_45_degrees;
    });
}

// The normal at an end of such a side is that of this face alone, straight across the side. Faces with middle
// nodes have bends of their own.
void SurfaceNormals::bend_rims(const SurfaceMesh &mesh) {
    for (std::int64_t face = 0; face < mesh.n_faces(); ++face)
        for (int i = 0, n = mesh.n_nodes(face); n <= 4 && i < n; ++i)
            faces_at_[std::minmax({mesh.nodes(face)[i], mesh.nodes(face)[(i + 1) % n]})].push_back(face);
    const vector<Point> straight = smooth_;
    for (std::int64_t face = 0; face < mesh.n_faces(); ++face) {
        const int n = mesh.n_nodes(face);
        const std::int64_t first = mesh.face_ptr[face];
        const auto bend = [&](int end, int behind) {
            Point t = difference(mesh.node[mesh.nodes(face)[end]], mesh.node[mesh.nodes(face)[behind]]);
            normalise(t, 0);
            Point &normal = smooth_[first + end];
            add(normal, -dot(straight[first + behind], t) - dot(straight[first + end], t), t);
            normalise(normal, 1);
        };
        for (int i = 0; n <= 4 && i < n; ++i)
            if (!is_smooth_across(mesh, face, i)) bend(i, (i + n - 1) % n), bend((i + 1) % n, (i + 2) % n);
    }
    faces_at_.clear();
}

Point SurfaceNormals::smooth(std::int64_t face, const std::array<double, most_face_nodes> &weight) const {
    Point n{};
    for (std::int64_t p = face_ptr_[face]; p < face_ptr_[face + 1]; ++p)
        add(n, weight[static_cast<std::size_t>(p - face_ptr_[face])], smooth_[p]);
    normalise(n, 1);
    return n;
}

double SurfaceNormals::rise(const SurfaceMesh &mesh, std::int64_t face,
                            const std::array<double, most_face_nodes> &weight) const {
    const std::int64_t *node = mesh.nodes(face);
    Point at{};
    for (int i = 0; i < mesh.n_nodes(face); ++i)
        add(at, weight[static_cast<std::size_t>(i)], mesh.node[node[i]]);
    double rise = 0;
    for (int i = 0; i < mesh.n_nodes(face); ++i)
        rise += weight[static_cast<std::size_t>(i)] *
                dot(difference(mesh.node[node[i]], at), smooth_[mesh.face_ptr[face] + i]) / 2;
    return rise;
}

} // namespace plm
