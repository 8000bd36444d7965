// The closest points of surfaces, flat and curved, against what is known of them.
#include "linalg/support.hpp"
#include "structure/surface_projection.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::closest_on_face;
using plm::ClosestPoint;
using plm::difference;
using plm::dot;
using plm::length;
using plm::Point;
using plm::Surface;
using plm::SurfaceMesh;

namespace {

double away(const Point &a, const Point &b) {
    return length(difference(a, b));
}
double sum(const ClosestPoint &c) {
    double total = 0;
    for (double w : c.weight) total += w;
    return total;
}
Point interpolated(const Point *node, int n, const ClosestPoint &c) {
    Point x{};
    for (int i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 3; ++k) x[k] += c.weight[static_cast<std::size_t>(i)] * node[i][k];
    return x;
}

void at_its_nodes_a_face_is_its_nodes(void **) {
    const Point node[] = {{0, 0, 0},      {4, 0, 1},       {5, 3, 0},   {-1, 4, 0.5},
                          {2, -0.3, 0.4}, {4.7, 1.4, 0.9}, {2, 3.6, 0}, {-0.6, 2, 0.5}};
    const Point six[] = {node[0], node[1], node[2], node[4], node[5], {2.4, 1.6, 0.2}};
    for (int n : {3, 4, 6, 8})
        for (int i = 0; i < n; ++i) {
            const Point *nodes = n == 6 ? six : node;
            const ClosestPoint c = closest_on_face(nodes, n, nodes[i]);
            assert_true(below(c.distance, 1e-13));
            assert_true(near(c.weight[static_cast<std::size_t>(i)], 1, 1e-12));
            assert_true(near(sum(c), 1, 1e-14));
        }
}

// In the plane of a face and above it, and beside it.
void flat_faces(void **) {
    const Point node[] = {{0, 0, 2}, {3, 0, 2}, {4, 2, 2}, {0, 2, 2}};
    ClosestPoint c = closest_on_face(node, 4, {1, 1.3, 7});
    assert_true(near(c.distance, 5, 1e-13) && below(away(c.at, {1, 1.3, 2}), 1e-13));
    assert_true(near(c.normal[2], 1, 1e-15));
    c = closest_on_face(node, 4, {-3, 1, -2}); // beside an edge
    assert_true(near(c.distance, 5, 1e-13) && below(away(c.at, {0, 1, 2}), 1e-13));
    c = closest_on_face(node, 4, {7, 6, 14}); // beyond a corner
    assert_true(near(c.distance, 13, 1e-13) && near(c.weight[2], 1, 1e-13));
    c = closest_on_face(node, 3, {1, 0.2, 7}); // half of it
    assert_true(near(c.distance, 5, 1e-13) && below(away(c.at, {1, 0.2, 2}), 1e-13) &&
                near(sum(c), 1, 1e-14));
    c = closest_on_face(node, 3,
                        {0, 2, 2}); // over the long side, onto it at right angles: the foot on y = x / 2
    assert_true(near(c.distance, 4 / std::sqrt(5.0), 1e-13) && below(away(c.at, {0.8, 0.4, 2}), 1e-13));
}

// x = (s, t, (s^2 + t^2) / 2) exactly, by 6 and by 8 nodes; a point at distance d along the normal.
Point on_bowl(double s, double t) {
    return {s, t, (s * s + t * t) / 2};
}
void closest_points_of_a_bowl(void **) {
    const Point eight[] = {on_bowl(-1, -1), on_bowl(1, -1), on_bowl(1, 1), on_bowl(-1, 1),
                           on_bowl(0, -1),  on_bowl(1, 0),  on_bowl(0, 1), on_bowl(-1, 0)};
    const Point six[] = {on_bowl(0, 0),  on_bowl(1, 0),   on_bowl(0, 1),
                         on_bowl(.5, 0), on_bowl(.5, .5), on_bowl(0, .5)};
    test::Random random(7);
    for (int k = 0; k < 400; ++k) {
        double s = random(), t = random();
        const double d = 0.7 * random() - 0.2; // less than the radius at the bottom, 1, on the hollow side
        const bool triangle = k % 2 == 1;
        if (triangle) {
            s = std::abs(s), t = std::abs(t);
            if (s + t > 1) s = 1 - s, t = 1 - t;
        }
        const double slope = std::sqrt(1 + s * s + t * t);
        const Point normal{-s / slope, -t / slope, 1 / slope},
            foot = on_bowl(s, t),
            p{foot[0] - d * normal[0], foot[1] - d * normal[1], foot[2] - d * normal[2]};
        const Point *node = triangle ? six : eight;
        const int n = triangle ? 6 : 8;
        const ClosestPoint c = closest_on_face(node, n, p);
        assert_true(below(away(c.at, foot), 1e-12));
        assert_true(near(c.distance, std::abs(d), 1e-13));
        assert_true(below(away(c.normal, normal), 1e-12));
        assert_true(below(away(interpolated(node, n, c), foot), 1e-12));
    }
}

// Far digits are not lost: 1 mm faces at 10 km.
void a_small_face_far_away(void **) {
    const double far = 1e7;
    const Point node[] = {{far, far, 0}, {far + 1, far, 0}, {far + 1, far + 1, 0}, {far, far + 1, 0}};
    const ClosestPoint c = closest_on_face(node, 4, {far + 0.25, far + 0.5, 0.125});
    assert_true(near(c.distance, 0.125, 1e-14));
    assert_true(near(c.weight[0], 0.375, 1e-14) && near(c.weight[2], 0.125, 1e-14));
}

// A sphere of 8-node faces: six squares of n x n, their nodes on radius 1.
SurfaceMesh sphere(int n) {
    SurfaceMesh mesh;
    const auto put = [&](int side, double u, double v) {
        Point x{};
        const double w = side % 2 == 0 ? 1 : -1;
        x[static_cast<std::size_t>(side / 2)] = w;
        x[static_cast<std::size_t>((side / 2 + 1) % 3)] = u * w; // outward by the right-hand rule
        x[static_cast<std::size_t>((side / 2 + 2) % 3)] = v;
        const double r = length(x);
        mesh.node.push_back({x[0] / r, x[1] / r, x[2] / r});
        mesh.face_node.push_back(static_cast<std::int64_t>(mesh.face_node.size()));
    };
    for (int side = 0; side < 6; ++side)
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double h = 2.0 / n, u = -1 + i * h, v = -1 + j * h;
                const double at[8][2] = {
                    {u, v},         {u + h, v},         {u + h, v + h},     {u, v + h},
                    {u + h / 2, v}, {u + h, v + h / 2}, {u + h / 2, v + h}, {u, v + h / 2}};
                for (const auto &a : at) put(side, a[0], a[1]);
                mesh.face_ptr.push_back(static_cast<std::int64_t>(mesh.face_node.size()));
            }
    return mesh;
}

// As the closest of all faces tried one by one, and on a sphere to what its elements of 0.2 leave of it.
void the_search_finds_the_closest_face_of_all(void **) {
    const Surface surface(sphere(8));
    const SurfaceMesh &mesh = surface.mesh();
    test::Random random(3);
    for (int k = 0; k < 200; ++k) {
        const Point p{1.5 * random(), 1.5 * random(), 1.5 * random()};
        const plm::Projection found = surface.closest(p);
        double least = 1e300;
        for (std::int64_t f = 0; f < mesh.n_faces(); ++f)
            least = std::min(least, closest_on_face(mesh.node.data() + 8 * f, 8, p).distance);
        assert_true(near(found.point.distance, least, 1e-14));
        const double r = length(p);
        if (r < 0.1) continue;
        assert_true(near(found.point.distance, std::abs(r - 1), 4e-4));
        assert_true(near(dot(found.point.normal, p) / r, 1, 1e-4));
    }
}

// Of a node that several faces share, the first.
void ties_among_faces(void **) {
    SurfaceMesh mesh;
    mesh.node = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}, {5, 5, 5}};
    mesh.face_node = {1, 4, 5, 2, 0, 1, 2, 3};
    mesh.face_ptr = {0, 4, 8};
    const Surface surface(mesh);
    assert_int_equal(surface.closest({1, 0.5, 1}).face, 0);
    assert_int_equal(surface.closest({0.9, 0.5, 1}).face, 1);
    assert_int_equal(surface.closest({100, 0.5, 1}).face, 0);
}

// 20,000 points on 90,000 faces: a second, where trying all of them would take hours.
void many_faces_are_no_matter(void **) {
    constexpr int n = 300;
    SurfaceMesh mesh;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) mesh.node.push_back({double(i), double(j), std::sin(0.1 * i)});
    for (std::int64_t i = 0; i < n; ++i)
        for (std::int64_t j = 0; j < n; ++j) {
            const std::int64_t a = i * (n + 1) + j;
            for (std::int64_t k : {a, a + n + 1, a + n + 2, a + 1}) mesh.face_node.push_back(k);
            mesh.face_ptr.push_back(static_cast<std::int64_t>(mesh.face_node.size()));
        }
    const Surface surface(std::move(mesh));
    for (int k = 0; k < 20'000; ++k) {
        const double x = 0.013 * k + 0.2, y = 0.011 * k + 0.3;
        const plm::Projection found = surface.closest({x, y, 0.01 + std::sin(0.1 * x)});
        assert_true(found.face >= 0 && found.point.distance < 0.02);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(at_its_nodes_a_face_is_its_nodes),
        cmocka_unit_test(flat_faces),
        cmocka_unit_test(closest_points_of_a_bowl),
        cmocka_unit_test(a_small_face_far_away),
        cmocka_unit_test(the_search_finds_the_closest_face_of_all),
        cmocka_unit_test(ties_among_faces),
        cmocka_unit_test(many_faces_are_no_matter),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
