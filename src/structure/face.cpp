#include "structure/face.hpp"
#include <algorithm>
#include <limits>

namespace plm {
namespace {

constexpr int n_monomials = 8; // 1, s, t, s^2, s t, t^2, s^2 t, s t^2

// Where a point is on a face: s, t >= 0 and s + t <= 1 on triangles, |s|, |t| <= 1 on quadrilaterals.
struct Place {
    double s, t;
};
// what is not negative inside: constant + s + t times these
struct Side {
    double constant, s, t;
};

struct Domain {
    int n_corners;
    Place corner[4];
    Side side[4];
};
constexpr Domain triangle{3, {{0, 0}, {1, 0}, {0, 1}}, {{0, 0, 1}, {1, -1, -1}, {0, 1, 0}}};
constexpr Domain square{
    4, {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {{1, 0, 1}, {1, -1, 0}, {1, 0, -1}, {1, 1, 0}}};

struct Shape {
    int n_nodes;
    const Domain &domain;
    double of[most_face_nodes][n_monomials]; // shape functions by monomials
};

constexpr Shape shapes[] = {
    {3, triangle, {{1, -1, -1}, {0, 1}, {0, 0, 1}}},
    {4,
     square,
     {{.25, -.25, -.25, 0, .25},
      {.25, .25, -.25, 0, -.25},
      {.25, .25, .25, 0, .25},
      {.25, -.25, .25, 0, -.25}}},
    {6,
     triangle,
     {{1, -3, -3, 2, 4, 2},
      {0, -1, 0, 2},
      {0, 0, -1, 0, 0, 2},
      {0, 4, 0, -4, -4},
      {0, 0, 0, 0, 4},
      {0, 0, 4, 0, -4, -4}}},
    {8,
     square,
     {{-.25, 0, 0, .25, .25, .25, -.25, -.25},
      {-.25, 0, 0, .25, -.25, .25, -.25, .25},
      {-.25, 0, 0, .25, .25, .25, .25, .25},
      {-.25, 0, 0, .25, -.25, .25, .25, -.25},
      {.5, 0, -.5, -.5, 0, 0, .5},
      {.5, .5, 0, 0, 0, -.5, 0, -.5},
      {.5, 0, .5, -.5, 0, 0, -.5},
      {.5, -.5, 0, 0, 0, -.5, 0, .5}}},
};

const Shape &shape_of(int n_nodes) {
    return *std::find_if(std::begin(shapes), std::end(shapes),
                         [&](const Shape &s) { return s.n_nodes == n_nodes; });
}

// The face as seen from the point, so that what is near to it has all its digits.
class Seen {
  public:
    Seen(const Point *node, int n_nodes, const Point &from)
        : shape_(shape_of(n_nodes)), domain_(shape_.domain) {
        for (int i = 0; i < n_nodes; ++i) {
            const Point r = difference(node[i], from);
            for (int m = 0; m < n_monomials; ++m)
                for (int k = 0; k < 3; ++k) by_[m][k] += shape_.of[i][m] * r[k];
        }
    }

    // From the best place of a grid downhill, and likewise along the sides; the nearest of these.
    Place closest() const {
        constexpr int steps = 4;
        const int n = domain_.n_corners;
        Place best = domain_.corner[0];
        const auto take = [&](Place p) {
            if (half_square(p) < half_square(best)) best = p;
        };
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; j <= (n == 3 ? steps - i : steps); ++j) {
                const double s = double(i) / steps, t = double(j) / steps;
                take(n == 3 ? Place{s, t} : Place{2 * s - 1, 2 * t - 1});
            }
        take(downhill(best, nullptr));
        for (int i = 0; i < n; ++i) {
            const Place a = domain_.corner[i], b = domain_.corner[(i + 1) % n],
                        along{(b.s - a.s) / steps, (b.t - a.t) / steps};
            Place start = a;
            for (int j = 1; j <= steps; ++j) {
                const Place p{a.s + j * along.s, a.t + j * along.t};
                if (half_square(p) < half_square(start)) start = p;
            }
            take(downhill(start, &along));
        }
        return best;
    }

    Point position(Place p) const {
        return sum(1, p.s, p.t, p.s * p.s, p.s * p.t, p.t * p.t, p.s * p.s * p.t, p.s * p.t * p.t);
    }
    Point tangent_s(Place p) const { return sum(0, 1, 0, 2 * p.s, p.t, 0, 2 * p.s * p.t, p.t * p.t); }
    Point tangent_t(Place p) const { return sum(0, 0, 1, 0, p.s, 2 * p.t, p.s * p.s, 2 * p.s * p.t); }

    /// Unit; zero where there is no area. size: the area by that of s and t.
    Point normal(Place p, double *size = nullptr) const {
        const Point a = tangent_s(p), b = tangent_t(p);
        Point n = cross(a, b);
        const double area = length(n);
        const bool is_plane = area > 1e-12 * length(a) * length(b);
        for (double &x : n) x = is_plane ? x / area : 0;
        if (size) *size = area;
        return n;
    }
    int n_corners() const { return domain_.n_corners; }
    Place corner(int i) const { return domain_.corner[i % domain_.n_corners]; }

    double weight(int node, Place p) const {
        const double m[] = {1, p.s, p.t, p.s * p.s, p.s * p.t, p.t * p.t, p.s * p.s * p.t, p.s * p.t * p.t};
        double sum = 0;
        for (int i = 0; i < n_monomials; ++i) sum += shape_.of[node][i] * m[i];
        return sum;
    }

  private:
    template <class... Factors> Point sum(Factors... factors) const {
        const double m[] = {double(factors)...};
        Point x{};
        for (int i = 0; i < n_monomials; ++i)
            for (int k = 0; k < 3; ++k) x[k] += m[i] * by_[i][k];
        return x;
    }
    double half_square(Place p) const {
        const Point r = position(p);
        return dot(r, r) / 2;
    }

    // Newton's step towards a smaller distance, all over the face or along a side; Gauss' and Newton's where
    // the distance is not convex.
    Place step(Place p, const Place *along) const {
        const Point r = position(p), a = tangent_s(p), b = tangent_t(p);
        const double g[] = {dot(r, a), dot(r, b)}, gauss[] = {dot(a, a), dot(a, b), dot(b, b)},
                     bend[] = {dot(r, sum(0, 0, 0, 2, 0, 0, 2 * p.t, 0)),
                               dot(r, sum(0, 0, 0, 0, 1, 0, 2 * p.s, 2 * p.t)),
                               dot(r, sum(0, 0, 0, 0, 0, 2, 0, 2 * p.s))};
        for (const double with : {1.0, 0.0}) {
            const double ss = gauss[0] + with * bend[0], st = gauss[1] + with * bend[1],
                         tt = gauss[2] + with * bend[2];
            if (along) {
                const double slope = g[0] * along->s + g[1] * along->t,
                             curvature = ss * along->s * along->s + 2 * st * along->s * along->t +
                                         tt * along->t * along->t;
                if (curvature > 0) return {-slope / curvature * along->s, -slope / curvature * along->t};
            } else {
                const double det = ss * tt - st * st;
                if (ss > 0 && det > 1e-14 * ss * tt)
                    return {(st * g[1] - tt * g[0]) / det, (st * g[0] - ss * g[1]) / det};
            }
        }
        return {0, 0}; // no extent that way
    }

    // How much of a step stays on the face.
    double room(Place p, Place d) const {
        double most = 1;
        for (int i = 0; i < domain_.n_corners; ++i) {
            const Side &side = domain_.side[i];
            const double here = std::max(0.0, side.constant + side.s * p.s + side.t * p.t),
                         falls = -(side.s * d.s + side.t * d.t);
            if (falls > here) most = std::min(most, here / falls);
        }
        return most;
    }

    Place downhill(Place p, const Place *along) const {
        constexpr double rounding = 1e-14;
        double value = half_square(p);
        for (int i = 0; i < 50; ++i) {
            const Place d = step(p, along);
            double share = room(p, d);
            Place next = p;
            double at_next = std::numeric_limits<double>::infinity();
            for (; share > rounding && !(at_next <= value * (1 + rounding)); share /= 2)
                next = {p.s + share * d.s, p.t + share * d.t}, at_next = half_square(next);
            if (!(at_next <= value * (1 + rounding))) break;
            const double moved = std::max(std::abs(next.s - p.s), std::abs(next.t - p.t));
            p = next, value = at_next;
            if (moved < rounding) break;
        }
        return p;
    }

    const Shape &shape_;
    const Domain &domain_;
    std::array<Point, n_monomials> by_{};
};

} // namespace

bool is_face(std::int64_t n_nodes) {
    return n_nodes == 3 || n_nodes == 4 || n_nodes == 6 || n_nodes == 8;
}

ClosestPoint closest_on_face(const Point *node, int n_nodes, const Point &to) {
    const Seen face(node, n_nodes, to);
    const Place place = face.closest();
    ClosestPoint found;
    for (int i = 0; i < n_nodes; ++i) found.weight[static_cast<std::size_t>(i)] = face.weight(i, place);
    const Point away = face.position(place);
    for (int k = 0; k < 3; ++k) found.at[k] = to[k] + away[k];
    found.distance = length(away);
    found.normal = face.normal(place);
    return found;
}

namespace {

struct Quadrature {
    Place at;
    double weight;
};

// Gauss' points of a line, 2 or 3, make those of the square; of the triangle 3 (exact to degree 2) or 6 (4).
std::vector<Quadrature> quadrature(int n_nodes) {
    std::vector<Quadrature> points;
    if (n_nodes == 3 || n_nodes == 6) {
        const auto three = [&](double near, double weight) {
            const double far = 1 - 2 * near;
            for (const Place p : {Place{near, near}, Place{far, near}, Place{near, far}})
                points.push_back({p, weight / 2});
        };
        if (n_nodes == 3) return three(1.0 / 6, 1.0 / 3), points;
        three(0.445948490915964886, 0.223381589678011466);
        three(0.0915762135097707435, 0.109951743655321868);
        return points;
    }
    using Line = std::vector<std::pair<double, double>>;
    const Line line = n_nodes == 4
                          ? Line{{-std::sqrt(1.0 / 3), 1}, {std::sqrt(1.0 / 3), 1}}
                          : Line{{-std::sqrt(0.6), 5.0 / 9}, {0, 8.0 / 9}, {std::sqrt(0.6), 5.0 / 9}};
    for (const auto &[s, by_s] : line)
        for (const auto &[t, by_t] : line) points.push_back({{s, t}, by_s * by_t});
    return points;
}

} // namespace

std::vector<FacePoint> face_points(const Point *node, int n_nodes) {
    const Seen face(node, n_nodes, node[0]);
    std::vector<FacePoint> points;
    for (const Quadrature &q : quadrature(n_nodes)) {
        FacePoint p;
        for (int i = 0; i < n_nodes; ++i) p.weight[static_cast<std::size_t>(i)] = face.weight(i, q.at);
        p.at = face.position(q.at);
        for (int k = 0; k < 3; ++k) p.at[k] += node[0][k];
        double size = 0;
        p.normal = face.normal(q.at, &size);
        p.area = q.weight * size;
        points.push_back(p);
    }
    return points;
}

void normals_at_nodes(const Point *node, int n_nodes, Point *normal) {
    const Seen face(node, n_nodes, node[0]);
    for (int i = 0; i < n_nodes; ++i) {
        const Place a = face.corner(i), b = face.corner(i + 1);
        normal[i] = face.normal(i < face.n_corners() ? a : Place{(a.s + b.s) / 2, (a.t + b.t) / 2});
    }
}

// Bernstein's coefficients of the polynomial.
int hull_of_face(const Point *node, int n_nodes, Point *hull) {
    const int corners = shape_of(n_nodes).domain.n_corners;
    const bool is_curved = n_nodes > corners;
    Point middle{};
    for (int i = 0; i < n_nodes; ++i)
        for (int k = 0; k < 3; ++k) {
            const bool is_corner = i < corners;
            hull[i][k] = is_corner ? node[i][k]
                                   : 2 * node[i][k] -
                                         (node[i - corners][k] + node[(i - corners + 1) % corners][k]) / 2;
            middle[k] += is_corner ? -0.75 * node[i][k] : node[i][k];
        }
    if (!is_curved || corners == 3) return n_nodes;
    hull[n_nodes] = middle;
    return n_nodes + 1;
}

} // namespace plm
