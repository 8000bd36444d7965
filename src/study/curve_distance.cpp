#include "study/curve_distance.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

PlanePoint operator+(PlanePoint a, PlanePoint b) {
    return {a.x + b.x, a.y + b.y};
}
PlanePoint operator-(PlanePoint a, PlanePoint b) {
    return {a.x - b.x, a.y - b.y};
}
PlanePoint operator*(double f, PlanePoint a) {
    return {f * a.x, f * a.y};
}
double dot(PlanePoint a, PlanePoint b) {
    return a.x * b.x + a.y * b.y;
}
double length(PlanePoint a) {
    return std::hypot(a.x, a.y);
}

/// Bernstein's form of a piece; its points bound it.
struct Bezier {
    PlanePoint p[4];
    explicit Bezier(const PlanePiece &piece) {
        // a circle's arc that turns by theta asks for chord / (3 cos^2(theta / 4))
        const double turn = std::clamp(dot(piece.from_direction, piece.to_direction), -1.0, 1.0),
                     arm = 2.0 / 3 * length(piece.to - piece.from) / (1 + std::sqrt(0.5 + 0.5 * turn));
        p[0] = piece.from, p[1] = piece.from + arm * piece.from_direction;
        p[2] = piece.to - arm * piece.to_direction, p[3] = piece.to;
    }
    PlanePoint at(double u) const {
        const double v = 1 - u;
        return v * v * v * p[0] + 3 * v * v * u * p[1] + 3 * v * u * u * p[2] + u * u * u * p[3];
    }
    PlanePoint slope(double u) const {
        const double v = 1 - u;
        return 3 * v * v * (p[1] - p[0]) + 6 * v * u * (p[2] - p[1]) + 3 * u * u * (p[3] - p[2]);
    }
    PlanePoint bend(double u) const {
        return 6 * (1 - u) * (p[2] - 2 * p[1] + p[0]) + 6 * u * (p[3] - 2 * p[2] + p[1]);
    }
    // Over [0, end], by Gauss's rule with five points on either half.
    double length_to(double end) const {
        static const double node[] = {0, 0.5384693101056831, 0.9061798459386640},
                            weight[] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
        double sum = 0;
        for (int half = 0; half < 2; ++half) {
            const double centre = (0.25 + 0.5 * half) * end, reach = 0.25 * end;
            sum += reach * weight[0] * length(slope(centre));
            for (int i = 1; i < 3; ++i)
                sum += reach * weight[i] *
                       (length(slope(centre - reach * node[i])) + length(slope(centre + reach * node[i])));
        }
        return sum;
    }
    // No point of the piece is nearer than this.
    double least_distance(PlanePoint q) const {
        const auto [x0, x1] = std::minmax({p[0].x, p[1].x, p[2].x, p[3].x});
        const auto [y0, y1] = std::minmax({p[0].y, p[1].y, p[2].y, p[3].y});
        return std::hypot(std::max({x0 - q.x, 0.0, q.x - x1}), std::max({y0 - q.y, 0.0, q.y - y1}));
    }
    // Of a point: the best of nine instants, then Newton's method on the distance as long as it falls.
    double distance(PlanePoint q) const {
        double u;
        return distance(q, u);
    }
    double distance(PlanePoint q, double &u) const {
        double best = std::numeric_limits<double>::infinity();
        u = 0;
        for (int i = 0; i <= 8; ++i)
            if (const double d = length(at(0.125 * i) - q); d < best) best = d, u = 0.125 * i;
        for (int i = 0; i < 20; ++i) {
            const PlanePoint off = at(u) - q, s = slope(u);
            const double square = dot(s, s), curvature = square + dot(off, bend(u));
            const double next = std::clamp(u - dot(off, s) / (curvature > 0 ? curvature : square), 0.0, 1.0);
            const double d = length(at(next) - q);
            if (!(d < best)) break;
            best = d, u = next;
        }
        return best;
    }
};

double distance_from(PlanePoint q, const vector<Bezier> &curve) {
    double best = std::numeric_limits<double>::infinity();
    worked(40.0 * static_cast<double>(curve.size()) + 2000);
    for (const Bezier &piece : curve)
        if (piece.least_distance(q) < best) best = std::min(best, piece.distance(q));
    return best;
}

vector<Bezier> beziers(const vector<PlanePiece> &curve) {
    vector<Bezier> out;
    for (const PlanePiece &piece : curve) out.emplace_back(piece);
    return out;
}

} // namespace

PlanePoint point_on(const PlanePiece &piece, double u) {
    return Bezier(piece).at(u);
}

double length_of(const PlanePiece &piece) {
    return Bezier(piece).length_to(1);
}

Nearest nearest_on(const PlanePiece &piece, PlanePoint point) {
    const Bezier bezier(piece);
    Nearest out;
    double u;
    out.distance = bezier.distance(point, u);
    const PlanePoint slope = bezier.slope(u);
    if (const double size = length(slope); size > 0) out.direction = (1 / size) * slope;
    return out;
}

double distance(PlanePoint point, const vector<PlanePiece> &curve) {
    return distance_from(point, beziers(curve));
}

vector<PlanePoint> equally_spaced(const vector<PlanePiece> &curve, std::int64_t n) {
    const vector<Bezier> pieces = beziers(curve);
    vector<double> end;
    double whole = 0;
    for (const Bezier &piece : pieces) end.push_back(whole += piece.length_to(1));
    vector<PlanePoint> out;
    std::size_t k = 0;
    for (std::int64_t i = 0; i < n && !pieces.empty(); ++i) {
        const double wanted = whole * static_cast<double>(i) / static_cast<double>(n - 1);
        while (k + 1 < pieces.size() && end[k] < wanted) ++k;
        const double before = k > 0 ? end[k - 1] : 0, own = end[k] - before;
        worked(2000);
        double u = own > 0 ? std::clamp((wanted - before) / own, 0.0, 1.0) : 0;
        for (int step = 0; step < 3 && u > 0 && u < 1; ++step) {
            const double speed = length(pieces[k].slope(u));
            if (!(speed > 0)) break;
            u = std::clamp(u - (pieces[k].length_to(u) - (wanted - before)) / speed, 0.0, 1.0);
        }
        out.push_back(pieces[k].at(u));
    }
    return out;
}

CurveDistance curve_distance(const vector<PlanePoint> &points, const vector<PlanePiece> &curve) {
    const vector<Bezier> pieces = beziers(curve);
    CurveDistance out;
    double squares = 0;
    for (const PlanePoint &p : points) {
        const double d = distance_from(p, pieces);
        squares += d * d;
        out.max = std::max(out.max, d);
    }
    if (!points.empty()) out.rms = std::sqrt(squares / static_cast<double>(points.size()));
    return out;
}

} // namespace plm
