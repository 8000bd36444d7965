#include "study/plane_curve.hpp"
#include "hbm/harmonic_choice.hpp"
#include "hbm/harmonic_tail.hpp"
#include "searches/point_equations.hpp"
#include "study/curve_point.hpp"
#include <algorithm>
#include <cmath>
#include <optional>

namespace plm {
namespace {

constexpr int deepest = 14; // bisections of a step of the sweep
constexpr std::size_t steps_between_polls = 8;
constexpr double difference_step = 1e-5; // of the slope of the amplitude, in arc length
// A piece halved is nearer by 16 where the curve is smooth; a quarter of that is counted on, since the drop
// that tells so may be chance. Where a pair begins to move its curvature is singular: by less than 3, and the
// middle may lie on the piece although the rest does not.
constexpr double smooth_gain = 4, first_gain = 0.25, least_gain = 1;

struct Node {
    PathState point, direction; // the latter: unit tangent in the metric of the piece
    PlanePoint at, tangent;
};

/// The piece between two neighbouring points of the branch.
class Step {
  public:
    Step(const Branch &branch, std::size_t first, const HbmOptions &options, const Output &output,
         const PlaneScale &scale)
        : branch_(branch), output_(output), scale_(scale),
          options_(options_of(branch.points()[first], branch.points()[first + 1], options)),
          equations_(equations_of(branch.reduced_model(), options_, branch.points()[first])),
          ends_{state_of(branch.points()[first]), state_of(branch.points()[first + 1])},
          metric_(curve_metric(ends_[1], options_)) {
        if (!have_same_equations(branch.points()[first], branch.points()[first + 1])) {
            set_chord(ends_[0], ends_[1]);
            for (PathState &end : ends_) correct_across(system(), metric_, options_, chord_, end);
        }
    }

    // Harmonics differ in number, or a point is an exact motion and its neighbour is none.
    static bool have_same_equations(const BranchPoint &a, const BranchPoint &b) {
        if (a.motion || b.motion) return a.motion && b.motion;
        return a.n_harmonics == b.n_harmonics;
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
    Residual &system() { return *equations_; }
    PathState state_of(const BranchPoint &point) const { return {equations_->unknowns(point), point.omega}; }

    static HbmOptions options_of(const BranchPoint &a, const BranchPoint &b, const HbmOptions &options) {
        return options_at(a.n_harmonics >= b.n_harmonics ? a : b, options.period_multiple, options);
    }

    void set_chord(const PathState &a, const PathState &b) {
        chord_ = difference(b, a);
        chord_length_ = metric_.length(chord_);
    }

    double amplitude(const PathState &at) {
        BranchPoint point = equations_->solved_point(at, 0, 0);
        if (options_.tail_correction)
            point.eta.append(
                harmonic_content(branch_.reduced(), point, options_.period_multiple).tail_response);
        Branch one(branch_.reduced_model(), options_.force_scale, options_.period_multiple);
        one.append(std::move(point));
        return one.amplitude(0, output_.dof, output_.measure, output_.harmonic);
    }

    PlanePoint in_plane(const PathState &at) {
        return {at.parameter / (2 * M_PI) / scale_.frequency_hz, amplitude(at) / scale_.amplitude};
    }

    // Tangent from the linearised equations, of length 1, along the chord.
    void set_direction(Node &n) {
        vector<double> r(n.point.x.size());
        system().residual(n.point.x.data(), n.point.parameter, r.data());
        system().linearize();
        const PathState along = tangent_at(system());
        const double length = metric_.length(along) * (metric_.product(along, chord_) < 0 ? -1 : 1);
        n.direction = std::isfinite(length) ? along : chord_; // exactly at a fold: the chord
        scale_by(1 / (std::isfinite(length) ? length : chord_length_), n.direction);
    }

    Node node(const PathState &point) {
        Node n;
        n.point = point;
        set_direction(n);
        n.at = in_plane(point);
        PlanePoint side[2];
        for (int k = 0; k < 2; ++k) {
            PathState beside = point;
            add((k == 0 ? -1 : 1) * difference_step, n.direction, beside);
            side[k] = in_plane(beside);
        }
        const double x = side[1].x - side[0].x, y = side[1].y - side[0].y, length = std::hypot(x, y);
        if (length > 0) n.tangent = {x / length, y / length};
        return n;
    }

    // A node of the piece before, in the metric and along the chord of this one.
    Node turned(Node n) const {
        double length = metric_.length(n.direction);
        if (metric_.product(n.direction, chord_) < 0) {
            length = -length;
            n.tangent = {-n.tangent.x, -n.tangent.y};
        }
        scale_by(1 / length, n.direction);
        return n;
    }

    // The curve's point across the middle of the chord, from the cubic through both ends.
    bool middle(const Node &a, const Node &b, PathState &m) {
        set_chord(a.point, b.point);
        if (!(chord_length_ > 1e-13)) return false;
        m = a.point;
        add(0.5, chord_, m);
        add(chord_length_ / 8, difference(a.direction, b.direction), m);
        const bool factored = true; // at the node made last
        return correct_across(system(), metric_, options_, chord_, m, factored);
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
        PathState point;
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
    std::unique_ptr<PeriodicEquations> equations_;
    PathState ends_[2];
    Metric metric_;
    PathState chord_;
    double chord_length_ = 0;
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
        // the unknowns of exact motions are measured at the piece's own frequency
        if (i + 2 < n && (points[i + 1].motion || !Step::have_same_equations(points[i], points[i + 1]) ||
                          !Step::have_same_equations(points[i + 1], points[i + 2])))
            known.reset();
    }
    return curve;
}

} // namespace plm
