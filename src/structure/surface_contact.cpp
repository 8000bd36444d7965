#include "structure/surface_contact.hpp"
#include "structure/surface_normals.hpp"
#include <algorithm>

namespace plm {
namespace {

// Beside a face stands what is farther from it along it than this part of the face, and of the gap.
constexpr double beside_face = 0.01, beside_gap = 0.5;

Point scaled(double factor, const Point &x) {
    return {factor * x[0], factor * x[1], factor * x[2]};
}

// A node, or a point of a face.
struct SlavePoint {
    Point at, normal; // normal: zero where there are no faces
    double area;
    std::int64_t node, face; // one of them is -1
    FaceWeights weight;
    double rise; // of the smooth surface above it
};

std::vector<SlavePoint> points_of(const MeshSurface &slave, const SurfaceContactChoice &choice) {
    const SurfaceMesh mesh = places(slave);
    const SurfaceNormals normals(mesh);
    std::vector<SlavePoint> points;
    if (!choice.at_points) {
        for (std::int64_t i = 0; i < static_cast<std::int64_t>(mesh.node.size()); ++i)
            if (mesh.n_faces() == 0 || normals.area(i) > 0)
                points.push_back({mesh.node[i], normals.at_node(i), normals.area(i), i, -1, {}, 0});
        return points;
    }
    for (std::int64_t face = 0; face < mesh.n_faces(); ++face) {
        Point node[most_face_nodes];
        for (int i = 0; i < mesh.n_nodes(face); ++i) node[i] = mesh.node[mesh.nodes(face)[i]];
        for (const FacePoint &p : face_points(node, mesh.n_nodes(face)))
            points.push_back({p.at, p.normal, p.area, -1, face, p.weight,
                              choice.is_smooth ? normals.rise(mesh, face, p.weight) : 0});
    }
    return points;
}

class Master {
  public:
    Master(const MeshSurface &surface, const SurfaceContactChoice &choice)
        : surface_(surface), choice_(choice), faces_(places(surface)), normals_(faces_.mesh()) {}

    SurfacePair partner_of(const SlavePoint &x) const {
        const Projection on = faces_.closest(x.at);
        SurfacePair pair;
        pair.area = x.area, pair.distance = on.point.distance;
        if (on.point.distance > choice_.search) return pair;
        Point out = normal(on);
        if (dot(out, out) == 0) return pair;
        const bool knows_side = dot(x.normal, x.normal) > 0;
        const Point off = difference(x.at, on.point.at);
        const double facing = knows_side ? -dot(x.normal, out) : choice_.is_two_sided ? dot(off, out) : 1;
        if (facing < 0 && !choice_.is_two_sided) return pair.face = SurfacePair::opposed, pair;
        const double side = facing < 0 ? -1 : 1;
        out = scaled(side, out);
        const double along = dot(out, off);
        const Point lateral = difference(off, scaled(along, out));
        if (length(lateral) >
            beside_gap * std::abs(along) + beside_face * std::sqrt(normals_.area_of_face(on.face)))
            return pair;
        pair.face = on.face, pair.normal = scaled(-1, out);
        const FaceWeights weight = moved(on, lateral, out);
        pair.gap = dot(out, difference(x.at, place(on.face, weight)));
        if (choice_.is_smooth) pair.gap -= side * normals_.rise(faces_.mesh(), on.face, weight) + x.rise;
        add_motion(pair.row, surface_, on.face, weight, out);
        return pair;
    }

  private:
    Point normal(const Projection &on) const {
        if (choice_.is_smooth) return normals_.smooth(on.face, on.point.weight);
        return dot(on.point.normal, on.point.normal) > 0 ? on.point.normal : normals_.of_face(on.face);
    }

    Point place(std::int64_t face, const FaceWeights &weight) const {
        const SurfaceMesh &mesh = faces_.mesh();
        Point at{};
        for (int i = 0; i < mesh.n_nodes(face); ++i)
            for (std::size_t k = 0; k < 3; ++k)
                at[k] += weight[static_cast<std::size_t>(i)] * mesh.node[mesh.nodes(face)[i]][k];
        return at;
    }

    // Weights nearest those of the projection whose point lies farther by `by` across the normal: linear in
    // the places of the nodes, as seen along it.
    FaceWeights moved(const Projection &on, const Point &by, const Point &normal) const {
        const SurfaceMesh &mesh = faces_.mesh();
        const int n = mesh.n_nodes(on.face);
        FaceWeights equal{};
        std::fill(equal.begin(), equal.begin() + n, 1.0 / n);
        const Point middle = place(on.face, equal);
        Point arm[most_face_nodes];
        double longest = 0;
        for (int i = 0; i < n; ++i) {
            const Point r = difference(mesh.node[mesh.nodes(on.face)[i]], middle);
            arm[i] = difference(r, scaled(dot(r, normal), normal));
            longest = std::max(longest, length(arm[i]));
        }
        // two directions across the normal
        Point a = normal;
        *std::min_element(a.begin(), a.end(), [](double x, double y) { return std::abs(x) < std::abs(y); }) +=
            1;
        a = cross(normal, a);
        a = scaled(1 / length(a), a);
        const Point b = cross(normal, a);
        double aa = 0, ab = 0, bb = 0;
        for (int i = 0; i < n; ++i) {
            const double x = dot(arm[i], a), y = dot(arm[i], b);
            aa += x * x, ab += x * y, bb += y * y;
        }
        FaceWeights weight = on.point.weight;
        const double det = aa * bb - ab * ab, u = dot(by, a), v = dot(by, b);
        if (!(det > 1e-12 * std::pow(longest, 4))) return weight; // seen edge on
        const double x = (bb * u - ab * v) / det, y = (aa * v - ab * u) / det;
        for (int i = 0; i < n; ++i)
            weight[static_cast<std::size_t>(i)] += x * dot(arm[i], a) + y * dot(arm[i], b);
        return weight;
    }

    const MeshSurface &surface_;
    const SurfaceContactChoice &choice_;
    Surface faces_;
    SurfaceNormals normals_;
};

} // namespace

std::vector<SurfacePair> surface_contact(const MeshSurface &slave, const MeshSurface &master,
                                         const SurfaceContactChoice &choice) {
    const Master faces(master, choice);
    std::vector<SurfacePair> pairs;
    for (const SlavePoint &x : points_of(slave, choice)) {
        SurfacePair pair = faces.partner_of(x);
        pair.point = x.node >= 0 ? x.node : static_cast<std::int64_t>(pairs.size());
        if (pair.has_partner()) {
            if (x.node >= 0)
                add_motion(pair.row, slave.node[x.node], pair.normal);
            else
                add_motion(pair.row, slave, x.face, x.weight, pair.normal);
            clear_rounding(pair.row);
            pair.row.erase(std::remove_if(pair.row.begin(), pair.row.end(),
                                          [](const DofTerm &t) { return t.coefficient == 0; }),
                           pair.row.end());
            if (pair.row.empty()) pair.face = SurfacePair::held; // a node of both, too
        }
        pairs.push_back(std::move(pair));
    }
    return pairs;
}

} // namespace plm
