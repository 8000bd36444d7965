// Surfaces whose meshes do not match: partners, gaps, areas, and rows that no rigid motion changes.
#include "structure/surface_contact.hpp"
#include "structure/surface_normals.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <map>
#include <vector>

using plm::CoupledNode;
using plm::cross;
using plm::length;
using plm::MeshSurface;
using plm::Point;
using plm::SurfaceContactChoice;
using plm::SurfacePair;

namespace {

CoupledNode node(std::int64_t i, const Point &at) {
    return {{3 * i, 3 * i + 1, 3 * i + 2, plm::no_dof, plm::no_dof, plm::no_dof}, at};
}

// n x m quadrilaterals (or twice as many triangles) over the unit square of s and t, their nodes from
// `first` on.
template <class Place>
MeshSurface sheet(int n, int m, std::int64_t first, Place place, bool triangles = false,
                  bool turned = false) {
    MeshSurface s;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= m; ++j)
            s.node.push_back(node(first + i * (m + 1) + j, place(double(i) / n, double(j) / m)));
    const auto face = [&](std::initializer_list<int> nodes) {
        std::vector<int> around(nodes);
        if (turned) std::reverse(around.begin(), around.end());
        for (int k : around) s.face_node.push_back(k);
        s.face_ptr.push_back(static_cast<std::int64_t>(s.face_node.size()));
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
            const int a = i * (m + 1) + j, b = a + m + 1;
            if (triangles)
                face({a, b, b + 1}), face({a, b + 1, a + 1});
            else
                face({a, b, b + 1, a + 1});
        }
    return s;
}

// A quarter of a cylinder, its normals outwards.
auto cylinder(double radius) {
    return [radius](double s, double t) -> Point {
        return {radius * std::cos(s * M_PI / 2), radius * std::sin(s * M_PI / 2), 2 * t};
    };
}

Point rigid(const Point &x, int motion) {
    if (motion < 3) {
        Point u{};
        u[static_cast<std::size_t>(motion)] = 1;
        return u;
    }
    Point axis{};
    axis[static_cast<std::size_t>(motion - 3)] = 1;
    return cross(axis, x);
}

double along(const SurfacePair &pair, const MeshSurface &slave, const MeshSurface &master, int motion) {
    std::map<std::int64_t, double> q;
    for (const MeshSurface *s : {&slave, &master})
        for (const CoupledNode &n : s->node)
            for (std::size_t k = 0; k < 3; ++k) q[n.dof[k]] = rigid(n.at, motion)[k];
    double u = 0;
    for (const plm::DofTerm &t : pair.row) u += t.coefficient * q.at(t.dof);
    return u;
}

SurfaceContactChoice within(double search) {
    SurfaceContactChoice c;
    c.search = search;
    return c;
}

// Curved, apart by a gap, of meshes that do not match, of every kind of normal and of point: translations
// and rotations of both bodies change no row.
void rigid_motion_changes_no_row(void **) {
    for (const bool triangles : {false, true})
        for (const bool smooth : {false, true})
            for (const bool points : {false, true}) {
                const MeshSurface inner = sheet(7, 3, 0, cylinder(1)),
                                  outer = sheet(5, 4, 1000, cylinder(1.05), triangles, true);
                SurfaceContactChoice choice = within(0.2);
                choice.is_smooth = smooth, choice.at_points = points;
                for (const auto &[slave, master] : {std::pair(&inner, &outer), std::pair(&outer, &inner)}) {
                    const std::vector<SurfacePair> pairs = surface_contact(*slave, *master, choice);
                    std::int64_t n = 0;
                    double worst = 0;
                    for (const SurfacePair &p : pairs) {
                        n += p.has_partner();
                        for (int motion = 0; p.has_partner() && motion < 6; ++motion)
                            worst = std::max(worst, std::abs(along(p, *slave, *master, motion)));
                    }
                    assert_true(n == static_cast<std::int64_t>(pairs.size()));
                    // some digits of the lever arms, of size 2
                    assert_true(worst < 2e-13);
                }
            }
}

// Between cylinders the gap is the difference of the radii, but for the sagittae of faces: with 64 against 96
// around (16 and 24 on a quarter) R (1 - cos(pi / 64)) = 1.2e-3 R at most. Smooth normals point along the
// radius to the square of the angle between nodes, and what facets cut off, of either side, comes back to its
// fourth power, 6e-6, at the rim, too, where a face has neighbours on one side only.
void gaps_and_normals_of_a_cylinder(void **) {
    const MeshSurface inner = sheet(24, 2, 0, cylinder(1)),
                      outer = sheet(16, 2, 1000, cylinder(1.01), false, true);
    for (const bool points : {false, true})
        for (const bool smooth : {false, true}) {
            SurfaceContactChoice choice = within(0.1);
            choice.is_smooth = smooth, choice.at_points = points;
            double gap = 0, turn = 0;
            for (const SurfacePair &p : surface_contact(inner, outer, choice)) {
                assert_true(p.has_partner());
                gap = std::max(gap, std::abs(p.gap - 0.01));
                if (points) continue;
                const Point &x = inner.node[p.point].at;
                turn = std::max(turn, length(cross(p.normal, Point{x[0], x[1], 0})));
            }
            assert_true(below(gap, smooth ? 1e-5 : 1.3e-3 * 1.01));
            assert_true(below(turn, smooth ? 3e-3 : 0.06));
        }
    // of a sheet seen from its other side, too
    SurfaceContactChoice choice = within(0.1);
    choice.is_smooth = choice.is_two_sided = true;
    for (const SurfacePair &p : surface_contact(inner, sheet(16, 2, 1000, cylinder(1.01)), choice))
        assert_true(below(std::abs(p.gap - 0.01), 1e-5));
}

// What nodes stand for sums to the area, and is each one's integral of its shape function on plane faces.
void areas(void **) {
    const auto plane = [](double s, double t) -> Point { return {3 * s, 2 * t, 0}; };
    for (const bool triangles : {false, true}) {
        const MeshSurface s = sheet(3, 2, 0, plane, triangles);
        const plm::SurfaceNormals normals(places(s));
        double sum = 0;
        for (std::size_t i = 0; i < s.node.size(); ++i) {
            sum += normals.area(static_cast<std::int64_t>(i));
            assert_true(std::abs(normals.at_node(static_cast<std::int64_t>(i))[2] - 1) < 1e-14);
        }
        assert_true(std::abs(sum - 6) < 1e-13);
        if (!triangles) assert_true(std::abs(normals.area(0) - 0.25) < 1e-14); // a corner of cells of 1 x 1
    }
    // 6 and 8 nodes: all positive, and the whole area
    for (const int n : {6, 8}) {
        MeshSurface s;
        const Point corner[] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
        const int corners = n / 2;
        for (int i = 0; i < n; ++i) {
            const Point &a = corner[i % corners], &b = corner[(i + 1) % corners];
            s.node.push_back(node(i, i < corners ? a : Point{(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, 0}));
            s.face_node.push_back(i);
        }
        s.face_ptr.push_back(n);
        const plm::SurfaceNormals normals(places(s));
        double sum = 0;
        for (int i = 0; i < n; ++i) {
            assert_true(normals.area(i) > 0.05);
            sum += normals.area(i);
        }
        assert_true(std::abs(sum - (n == 6 ? 2 : 4)) < 1e-13);
    }
}

// A uniform pressure of the slave's points on the master: its resultant and moments are those of the
// pressure, and the slave's nodal forces are the exact ones.
void pressure_passes(void **) {
    const auto plane = [](double s, double t) -> Point { return {s, t, 0}; };
    const auto above = [](double s, double t) -> Point { return {s, t, 1e-3}; };
    const MeshSurface master = sheet(3, 3, 0, plane), slave = sheet(4, 5, 1000, above, false, true);
    for (const bool points : {false, true}) {
        SurfaceContactChoice choice = within(0.1);
        choice.at_points = points;
        std::map<std::int64_t, double> force;
        for (const SurfacePair &p : surface_contact(slave, master, choice)) {
            assert_true(p.has_partner() && std::abs(p.gap - 1e-3) < 1e-15);
            for (const plm::DofTerm &t : p.row) force[t.dof] += p.area * t.coefficient;
        }
        double sum = 0, moment = 0, worst = 0;
        for (const CoupledNode &n : master.node) {
            const double f = force[n.dof[2]];
            sum += f, moment += n.at[0] * f;
            const bool edge_x = n.at[0] < 1e-9 || n.at[0] > 1 - 1e-9,
                       edge_y = n.at[1] < 1e-9 || n.at[1] > 1 - 1e-9;
            const double exact = 1 / 9.0 / (edge_x ? 2 : 1) / (edge_y ? 2 : 1);
            worst = std::max(worst, std::abs(f / exact - 1));
        }
        assert_true(std::abs(sum - 1) < 1e-13 && std::abs(moment - 0.5) < 1e-13);
        // of one node of the master, cells of 1/3 against 1/4 and 1/5
        assert_true(below(worst, points ? 0.5 : 0.5));
        for (const CoupledNode &n : slave.node) {
            const bool edge_x = n.at[0] < 1e-9 || n.at[0] > 1 - 1e-9,
                       edge_y = n.at[1] < 1e-9 || n.at[1] > 1 - 1e-9;
            const double exact = 1 / 20.0 / (edge_x ? 2 : 1) / (edge_y ? 2 : 1);
            assert_true(std::abs(-force[n.dof[2]] / exact - 1) < 1e-12);
        }
    }
}

void who_has_no_partner(void **) {
    const auto plane = [](double s, double t) -> Point { return {s, t, 0}; };
    const MeshSurface master = sheet(2, 2, 0, plane);
    MeshSurface slave; // nodes alone
    for (const Point &at :
         {Point{0.5, 0.4, 0.1}, Point{0.5, 0.4, 0.9}, Point{1.2, 0.5, 0.05}, Point{0.3, 0.3, -0.01}})
        slave.node.push_back(node(100 + static_cast<std::int64_t>(slave.node.size()), at));
    const std::vector<SurfacePair> pairs = surface_contact(slave, master, within(0.5));
    assert_true(pairs[0].has_partner() && std::abs(pairs[0].gap - 0.1) < 1e-15 && pairs[0].normal[2] == -1);
    assert_int_equal(pairs[1].face, SurfacePair::none);                           // too far
    assert_int_equal(pairs[2].face, SurfacePair::none);                           // beside
    assert_true(pairs[3].has_partner() && std::abs(pairs[3].gap + 0.01) < 1e-15); // interference
    SurfaceContactChoice sheet_like = within(0.5);
    sheet_like.is_two_sided = true;
    const std::vector<SurfacePair> either = surface_contact(slave, master, sheet_like);
    assert_true(std::abs(either[3].gap - 0.01) < 1e-15 && either[3].normal[2] == 1);
    // faces that look the same way
    const auto above = [](double s, double t) -> Point { return {s, t, 0.01}; };
    for (const bool turned : {false, true})
        for (const SurfacePair &p :
             surface_contact(sheet(3, 3, 100, above, false, turned), master, within(0.5)))
            assert_true(turned ? p.has_partner() : p.face == SurfacePair::opposed);
    // the same DOFs on both sides
    for (const SurfacePair &p : surface_contact(sheet(2, 2, 0, plane, false, true), master, within(0.5)))
        assert_int_equal(p.face, SurfacePair::held);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(rigid_motion_changes_no_row),
        cmocka_unit_test(gaps_and_normals_of_a_cylinder),
        cmocka_unit_test(areas),
        cmocka_unit_test(pressure_passes),
        cmocka_unit_test(who_has_no_partner),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
