#include "space/geometry_audit.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Int = long long; // for printf

constexpr double noticeable = 1e-6; // of the size of the structure: coordinates of decks have so many digits
const char *const rigid_motion_name[] = {"the translation x",    "the translation y",
                                         "the translation z",    "the rotation about x",
                                         "the rotation about y", "the rotation about z"};

/// Materials of machines in systems of units that belong together: steel, by density and speed of waves.
struct Units {
    const char *name;
    double density, speed;
};
constexpr Units systems[] = {{"m-N-kg", 7850, 5200},         {"mm-N-t", 7.85e-9, 5.2e6},
                             {"mm-kN-kg-ms", 7.85e-6, 5200}, {"mm-N-g-ms", 7.85e-3, 5200},
                             {"in-lbf-s", 7.35e-4, 2.05e5},  {"ft-lbf-s", 15.2, 17000}};

class GeometryAudit {
  public:
    explicit GeometryAudit(const Model &model) : m_(model), g_(model.geometry()) {}

    std::vector<Finding> run() {
        nodes();
        body();
        units();
        strains();
        if (m_.n_pairs() > 0) rows();
        return findings_;
    }

  private:
    void add(int severity, double value, std::string text) {
        findings_.push_back({severity, value, std::move(text)});
    }

    void nodes() {
        std::string counts;
        for (std::size_t n = 1; n <= 6; ++n)
            if (g_.nodes_of_dofs()[n] > 0)
                counts +=
                    format("%s%lld of %zu DOFs", counts.empty() ? "" : ", ", Int(g_.nodes_of_dofs()[n]), n);
        add(0, g_.size(),
            format("%lld nodes (%s) from (%g, %g, %g) to (%g, %g, %g)%s", Int(g_.n_nodes()), counts.c_str(),
                   g_.low()[0], g_.low()[1], g_.low()[2], g_.high()[0], g_.high()[1], g_.high()[2],
                   g_.n_others() > 0 ? format("; %lld DOFs belong to none", Int(g_.n_others())).c_str()
                                     : ""));
    }

    void body() {
        const Geometry::Body b = g_.body();
        double least = INFINITY, most = 0;
        for (std::size_t k = 0; k < 3; ++k)
            if (g_.strains()[k].moves) least = std::min(least, b.mass[k]), most = std::max(most, b.mass[k]);
        add(0, most,
            format("mass %g, %g, %g in x, y, z; centre of gravity (%g, %g, %g); moments of inertia about it "
                   "%g, %g, %g (xy %g, xz %g, yz %g)",
                   b.mass[0], b.mass[1], b.mass[2], b.centre[0], b.centre[1], b.centre[2], b.inertia[0],
                   b.inertia[1], b.inertia[2], b.inertia[3], b.inertia[4], b.inertia[5]));
        if (!(least >= 0.99 * most))
            add(least > 0 ? 1 : 2, least / most,
                format(
                    "the mass differs between the directions, %g to %g: is the mass matrix complete in every "
                    "direction, and are the DOFs those of the nodes they were given with?",
                    least, most));
        constexpr double eccentric = 0.1; // of the size: masses beside their nodes
        double outside = 0;
        for (std::size_t k = 0; k < 3; ++k)
            outside = std::max({outside, g_.low()[k] - b.centre[k], b.centre[k] - g_.high()[k]});
        if (outside > eccentric * g_.size())
            add(2, outside,
                format("the centre of gravity lies %g outside the box around the nodes, which is %g across: "
                       "coordinates and DOFs do not belong together",
                       outside, g_.size()));
    }

    // The box around all nodes holds more than the material, the cube between two nodes less: the density
    // lies between. Of shells and beams neither is near, and nothing is judged.
    void units() {
        const double c = g_.wave_speed();
        const Point side = difference(g_.high(), g_.low());
        const double volume = side[0] * side[1] * side[2], mass = g_.body().mass[0],
                     most = g_.density_at_nodes();
        if (!(c > 0)) return;
        std::string fact = format("waves run at about %.2g in the units of the model", c);
        const std::string known = "; steel has 5200 and 7850 in m-N-kg, 5.2e6 and 7.85e-9 in mm-N-t, 2.05e5 "
                                  "and 7.35e-4 in in-lbf-s";
        if (!(mass > 0 && volume > 0 && most > 0)) return add(0, c, fact + known);
        const double least = std::min(most, mass / volume);
        fact += format(", and the density lies between %.2g and %.2g", least, most);
        for (const Units &u : systems) // from plastics and wood on
            if (c > 0.1 * u.speed && c < 4 * u.speed && most > 0.1 * u.density && least < 3 * u.density)
                return add(
                    0, c,
                    format("%s; steel has %.3g and %.3g in %s", fact.c_str(), u.speed, u.density, u.name));
        add(1, c, fact + known + ": do the units of mass, stiffness and coordinates belong together?");
    }

    void strains() {
        std::int64_t by_translation = 0;
        for (std::size_t motion = 0; motion < 3; ++motion)
            by_translation = std::max(by_translation, g_.strains()[motion].count);
        for (std::size_t motion = 0; motion < 6; ++motion) {
            const Geometry::Strain &s = g_.strains()[motion];
            if (s.count == 0) continue;
            const std::string fact =
                format("%s leaves forces in K at %lld DOFs (the first: DOF %lld), up to %.1g of their terms",
                       rigid_motion_name[motion], Int(s.count), Int(s.first), s.largest);
            if (motion < 3)
                add(0, static_cast<double>(s.count),
                    fact + ": springs to the ground or supports are in the matrix");
            else if (s.count > by_translation)
                add(1, static_cast<double>(s.count),
                    fact + ", where translations leave them at fewer: elements that do not turn as rigid "
                           "bodies, DOFs in axes of their own, coordinates of other nodes, or stiffness by "
                           "stress (then it is meant)");
        }
    }

    void rows() {
        const auto all = m_.given_gap_rows();
        const double size = g_.size();
        std::int64_t reversed = 0, first_reversed = -1, apart = 0, first_apart = -1, turning = 0,
                     first_turning = -1;
        double farthest = 0, widest = 0, most_turned = 0;
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i) {
            const DofTerms &row = all[Contact::normal_row(i)];
            double along = 0;
            if (!g_.distance(row, along)) continue;
            const double by_coordinates = -along, given = m_.initial_gap()[i];
            if (std::abs(by_coordinates) > noticeable * size && std::abs(given) > noticeable * size &&
                by_coordinates * given < 0 && reversed++ == 0)
                first_reversed = i;
            if (std::abs(by_coordinates - given) > noticeable * size && apart++ == 0) first_apart = i;
            farthest = std::max(farthest, std::abs(by_coordinates - given));
            double turned = 0;
            for (std::size_t motion = 3; motion < 6; ++motion) {
                const double arm = g_.size_moved(row, motion);
                if (arm > 0) turned = std::max(turned, std::abs(g_.moved(row, motion)) / arm);
            }
            if (turned > 1e-3 && turning++ == 0) first_turning = i;
            most_turned = std::max(most_turned, turned), widest = std::max(widest, g_.sideways(row));
        }
        if (reversed > 0)
            add(1, static_cast<double>(reversed),
                format(
                    "%lld pairs (the first: pair %lld) have a gap of one sign and nodes that stand as with "
                    "the other: is the normal, which points out of the first body towards the second, or "
                    "the sign of the gap reversed?",
                    Int(reversed), Int(first_reversed)));
        add(0, farthest,
            apart == 0 ? std::string("the gaps are those of the coordinates")
                       : format("the gaps of %lld pairs (the first: pair %lld) are other than their nodes "
                                "stand apart, by up to %g",
                                Int(apart), Int(first_apart), farthest));
        if (turning > 0)
            add(1, widest,
                format(
                    "%lld pairs (the first: pair %lld) open when the structure turns as one body, by up to "
                    "%.1g of its size for a turn of 1: their nodes do not stand opposite to one another%s, "
                    "so that their forces make a moment",
                    Int(turning), Int(first_turning), 2 * most_turned,
                    widest > 0 ? format(" (sideways by up to %g)", widest).c_str() : ""));
    }

    const Model &m_;
    const Geometry &g_;
    std::vector<Finding> findings_;
};

} // namespace

std::vector<Finding> geometry_audit(const Model &model) {
    if (!model.geometry().is_known()) return {};
    return GeometryAudit(model).run();
}

} // namespace plm
