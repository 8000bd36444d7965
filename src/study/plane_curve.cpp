#include "study/plane_curve.hpp"
#include "hbm/curve.hpp"
#include "hbm/harmonic_tail.hpp"
#include "hbm/make_system.hpp"
#include "study/curve_point.hpp"
#include <algorithm>
#include <cmath>
#include <optional>

namespace plm {
namespace {

constexpr int deepest = 14; // bisections of a step of the sweep
constexpr std::size_t steps_between_polls = 8;
constexpr double difference_step = 1e-5; // of the slope of the amplitude, in arc length
// A piece halved is nearer by 16 where the curve is smooth. Where a pair begins to move its curvature is
// singular: by less than 3, and the middle may lie on the piece although the rest does not.
constexpr double smooth_gain = 16, first_gain = 0.25, least_gain = 1;

struct Node {
    CurvePoint point;
    vector<double> direction; // unit tangent in the metric of the piece, with direction_omega
    double direction_omega = 0;
    PlanePoint at, tangent;
};

/// The piece between two neighbouring points of the branch.
class Step {
  public:
    Step(const Branch &branch, std::size_t first, const HbmOptions &options, const Output &output,
         const PlaneScale &scale)
        : branch_(branch), output_(output), scale_(scale),
          options_(options_of(branch.points()[first], branch.points()[first + 1], options)),
          system_(make_system(branch.reduced_model(), options_)),
          ends_{load(*system_, branch.points()[first]), load(*system_, branch.points()[first + 1])},
          metric_(ends_[1], options_) {
        if (branch.points()[first].n_harmonics != branch.points()[first + 1].n_harmonics) {
            set_chord(ends_[0], ends_[1]);
            for (CurvePoint &end : ends_)
                correct_across(*system_, metric_, options_, chord_, chord_omega_, end);
        }
    }

    // known: what the piece before has made of the point between them, if that had as many harmonics. Becomes
    // this piece's other end.
    void append_to(PlaneCurve &curve, double tolerance, std::optional<Node> &known) {
        set_chord(ends_[0], ends_[1]);
        if (!(chord_length_ > 0)) return;
        const Node first = known ? turned(*known) : node(ends_[0]);
        known = node(ends_[1]);
        halve(first, *known, deepest, 0, tolerance, curve);
    }

  private:
    static HbmOptions options_of(const BranchPoint &a, const BranchPoint &b, const HbmOptions &options) {
        return options_at(a.n_harmonics >= b.n_harmonics ? a : b, options.period_multiple, options);
    }

    void set_chord(const CurvePoint &a, const CurvePoint &b) {
        chord_ = b.x;
        for (std::size_t i = 0; i < chord_.size(); ++i) chord_[i] -= a.x[i];
        chord_omega_ = b.omega - a.omega;
        chord_length_ = std::sqrt(metric_.product(chord_, chord_omega_, chord_, chord_omega_));
    }

    double amplitude(const vector<double> &x, double omega) {
        BranchPoint point;
        point.force_scale = options_.force_scale;
        system_->to_point(x.data(), omega, point);
        if (options_.tail_correction)
            point.eta.append(
                harmonic_content(branch_.reduced(), point, options_.period_multiple).tail_response);
        Branch one(branch_.reduced_model(), options_.force_scale, options_.period_multiple);
        one.append(std::move(point));
        return one.amplitude(0, output_.dof, output_.measure, output_.harmonic);
    }

    PlanePoint in_plane(double omega, double amplitude) const {
        return {omega / (2 * M_PI) / scale_.frequency_hz, amplitude / scale_.amplitude};
    }

    // Tangent (dx, domega) from the linearised equations, turned along the chord.
    void set_direction(Node &n) {
        vector<double> along(n.point.x.size());
        system_->residual(n.point.x.data(), n.point.omega, along.data());
        system_->omega_derivative(along.data());
        system_->linearize();
        system_->solve(along.data(), 1);
        for (double &v : along) v = -v;
        double length = std::sqrt(metric_.product(along, 1, along, 1));
        if (metric_.product(along, 1, chord_, chord_omega_) < 0) length = -length;
        n.direction_omega = 1 / length;
        for (double &v : along) v /= length;
        n.direction = std::move(along);
        if (std::isfinite(length)) return;
        n.direction = chord_; // exactly at a fold
        for (double &v : n.direction) v /= chord_length_;
        n.direction_omega = chord_omega_ / chord_length_;
    }

    Node node(const CurvePoint &point) {
        Node n;
        n.point = point;
        set_direction(n);
        n.at = in_plane(point.omega, amplitude(point.x, point.omega));
        PlanePoint side[2];
        for (int k = 0; k < 2; ++k) {
            const double step = (k == 0 ? -1 : 1) * difference_step;
            vector<double> x(point.x);
            for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * n.direction[i];
            const double omega = point.omega + step * n.direction_omega;
            side[k] = in_plane(omega, amplitude(x, omega));
        }
        const double x = side[1].x - side[0].x, y = side[1].y - side[0].y, length = std::hypot(x, y);
        if (length > 0) n.tangent = {x / length, y / length};
        return n;
    }

    // A node of the piece before, in the metric and along the chord of this one.
    Node turned(Node n) const {
        double length =
            std::sqrt(metric_.product(n.direction, n.direction_omega, n.direction, n.direction_omega));
        if (metric_.product(n.direction, n.direction_omega, chord_, chord_omega_) < 0) {
            length = -length;
            n.tangent = {-n.tangent.x, -n.tangent.y};
        }
        for (double &v : n.direction) v /= length;
        n.direction_omega /= length;
        return n;
    }

    // The curve's point across the middle of the chord, from the cubic through both ends.
    bool middle(const Node &a, const Node &b, CurvePoint &m) {
        set_chord(a.point, b.point);
        if (!(chord_length_ > 1e-13)) return false;
        m = a.point;
        for (std::size_t i = 0; i < m.x.size(); ++i)
            m.x[i] =
                0.5 * (a.point.x[i] + b.point.x[i]) + chord_length_ / 8 * (a.direction[i] - b.direction[i]);
        m.omega = 0.5 * (a.point.omega + b.point.omega) +
                  chord_length_ / 8 * (a.direction_omega - b.direction_omega);
        const bool factored = true; // at the node made last
        return correct_across(*system_, metric_, options_, chord_, chord_omega_, m, factored);
    }

    // By the distance of the curve's middle, and by how its direction differs there.
    static double miss_of(const PlanePiece &piece, const Node &m) {
        const Nearest nearest = nearest_on(piece, m.at);
        const double turn = nearest.direction.x * m.tangent.y - nearest.direction.y * m.tangent.x;
        return std::max(nearest.distance, 0.25 * length_of(piece) * std::abs(turn));
    }

    static double gain_of(double miss_before, double miss) {
        if (miss_before == 0) return first_gain;
        return 10 * miss < miss_before ? smooth_gain : least_gain;
    }

    // miss_before: of the piece that this one is a half of; 0: of none
    void halve(const Node &a, const Node &b, int depth, double miss_before, double tolerance,
               PlaneCurve &curve) {
        const PlanePiece piece{a.at, b.at, a.tangent, b.tangent};
        CurvePoint point;
        if (!middle(a, b, point)) {
            ++curve.unresolved;
            curve.pieces.push_back(piece);
            return;
        }
        const Node m = node(point);
        const double miss = miss_of(piece, m), gain = gain_of(miss_before, miss);
        if (miss <= gain * tolerance || depth == 0) {
            curve.resolution = std::max(curve.resolution, miss / gain);
            curve.pieces.push_back({a.at, m.at, a.tangent, m.tangent});
            curve.pieces.push_back({m.at, b.at, m.tangent, b.tangent});
            return;
        }
        halve(a, m, depth - 1, miss, tolerance, curve);
        halve(m, b, depth - 1, miss, tolerance, curve);
    }

    const Branch &branch_;
    const Output &output_;
    const PlaneScale &scale_;
    HbmOptions options_;
    std::unique_ptr<HbmSystem> system_;
    CurvePoint ends_[2];
    CurveMetric metric_;
    vector<double> chord_;
    double chord_omega_ = 0, chord_length_ = 0;
};

} // namespace

PlaneCurve plane_curve(const Branch &branch, const HbmOptions &options, const Output &output,
                       const PlaneScale &scale, double tolerance, Watch watch) {
    PlaneCurve curve;
    HbmOptions own = options;
    own.period_multiple = branch.period_multiple();
    const std::vector<BranchPoint> &points = branch.points();
    const std::size_t n = points.size();
    std::optional<Node> known;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        if (i % steps_between_polls == 0)
            watch.step("between the points", static_cast<double>(i) / static_cast<double>(n));
        Step(branch, i, own, output, scale).append_to(curve, tolerance, known);
        if (i + 2 < n && (points[i].n_harmonics != points[i + 1].n_harmonics ||
                          points[i + 1].n_harmonics != points[i + 2].n_harmonics))
            known.reset();
    }
    return curve;
}

} // namespace plm
