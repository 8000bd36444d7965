// A surface of many faces, and where on it points are nearest. The search costs as the logarithm of their
// number.
#pragma once
#include "linalg/memory.hpp"
#include "structure/face.hpp"

namespace plm {

/// Faces by places in the table of nodes, compressed rows (face.hpp says in which order).
struct SurfaceMesh {
    vector<Point> node;
    vector<std::int64_t> face_ptr{0}, face_node;
    std::int64_t n_faces() const { return static_cast<std::int64_t>(face_ptr.size()) - 1; }
    int n_nodes(std::int64_t face) const { return static_cast<int>(face_ptr[face + 1] - face_ptr[face]); }
    const std::int64_t *nodes(std::int64_t face) const { return face_node.data() + face_ptr[face]; }
};

struct Projection {
    std::int64_t face = -1;
    ClosestPoint point;
};

class Surface {
  public:
    /// At least one face.
    explicit Surface(SurfaceMesh mesh);
    Projection closest(const Point &to) const;
    const SurfaceMesh &mesh() const { return mesh_; }

  private:
    struct Box {
        Point low, high;
    };
    // Of faces first to end in order_; those of more than a few are split into the branches at below and
    // below + 1.
    struct Branch {
        Box box;
        std::int64_t first, end, below;
    };
    Box box_of(std::int64_t face) const;
    static double square_distance(const Box &box, const Point &to);
    void split(std::int64_t branch, const vector<Box> &boxes);
    ClosestPoint closest_on(std::int64_t face, const Point &to) const;

    SurfaceMesh mesh_;
    vector<std::int64_t> order_;
    vector<Branch> branches_;
};

} // namespace plm
