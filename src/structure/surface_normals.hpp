// Areas of a surface and its normals: of its faces, and smooth across their edges.
#pragma once
#include "structure/surface_projection.hpp"
#include <map>
#include <vector>

namespace plm {

class SurfaceNormals {
  public:
    explicit SurfaceNormals(const SurfaceMesh &mesh);

    /// Of the faces around it, the sum of which is the surface's: with middle nodes the shares are by the
    /// squares of the shape functions, for their integrals are not positive there. 0 where there is no face.
    double area(std::int64_t node) const { return area_[node]; }
    /// The mean of the faces around a node, and of a face, unit; zero where they cancel.
    const Point &at_node(std::int64_t node) const { return at_node_[node]; }
    const Point &of_face(std::int64_t face) const { return of_face_[face]; }
    double area_of_face(std::int64_t face) const { return face_area_[face]; }
    /// On a face, by its shape functions there: from a mean at each node over those faces that meet this one
    /// at less than 45 degrees, so that edges that are meant stay. Along those, and at the rim, a face bends
    /// as much towards the edge as it does towards its other side.
    Point smooth(std::int64_t face, const std::array<double, most_face_nodes> &weight) const;
    /// How far the surface with these normals at its nodes stands above the face there. Of facets of a
    /// parabola what they cut off: half of what each tangent plane tells.
    double rise(const SurfaceMesh &mesh, std::int64_t face,
                const std::array<double, most_face_nodes> &weight) const;

  private:
    void take_face(const SurfaceMesh &mesh, std::int64_t face);
    void smooth_corners(const SurfaceMesh &mesh);
    void bend_rims(const SurfaceMesh &mesh);
    bool is_smooth_across(const SurfaceMesh &mesh, std::int64_t face, int side) const;

    vector<double> area_, face_area_;
    vector<Point> at_node_, of_face_;
    vector<std::int64_t> face_ptr_;
    vector<Point> of_corner_, smooth_; // by place in the list of faces
    std::map<std::pair<std::int64_t, std::int64_t>, std::vector<std::int64_t>> faces_at_; // of a side's ends
};

} // namespace plm
