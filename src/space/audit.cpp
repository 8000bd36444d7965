#include "space/audit.hpp"
#include "space/geometry_audit.hpp"
#include "space/modal_audit.hpp"
#include "space/row_audit.hpp"
#include <algorithm>
#include <cmath>
#include <map>

namespace plm {
namespace {

using Int = long long; // for printf

class Audit {
  public:
    explicit Audit(const Model &model) : m_(model) {}

    std::vector<Finding> run(bool quick) {
        mass();
        massless_dofs();
        still_dofs();
        rigid_modes();
        conditioning();
        rounding();
        units();
        for (Finding &f : geometry_audit(m_)) findings_.push_back(std::move(f));
        if (!quick)
            for (Finding &f : modal_audit(m_)) findings_.push_back(std::move(f));
        damping();
        loads();
        if (m_.n_pairs() == 0) {
            add(0, 0, "no contact pair: the model is linear");
            return findings_;
        }
        gaps();
        opened_by_preload();
        for (Finding &f : row_audit(m_)) findings_.push_back(std::move(f));
        contact_stiffness();
        return findings_;
    }

  private:
    void add(int severity, double value, std::string text) {
        findings_.push_back({severity, value, std::move(text)});
    }

    // Only what the matrices tell: how many DOFs a node has is not known otherwise.
    void mass() {
        if (m_.diagonal_twice()) {
            add(2, m_.trace_of_mass(),
                "the stiffness matrix looks as if its diagonal was added up twice, as a triangle and its "
                "mirror image do that both hold it: with half of it a translation would strain nothing. Give "
                "each entry once (one triangle with PLM_LOWER or PLM_UPPER, or all with PLM_FULL), of the "
                "mass matrix, too");
            return;
        }
        if (m_.geometry().is_known()) return; // which knows more
        if (m_.translations().empty()) {
            add(0, m_.trace_of_mass(),
                format("which DOFs are translations cannot be told from K (it holds supports already, or the "
                       "DOFs "
                       "are not numbered node by node); the diagonal of the mass matrix sums up to %g",
                       m_.trace_of_mass()));
            return;
        }
        double smallest = INFINITY, largest = 0;
        for (const Translation &t : m_.translations()) {
            smallest = std::min(smallest, t.mass), largest = std::max(largest, t.mass);
            add(t.mass > 0 ? 0 : 2, t.mass,
                format("mass %g of the whole structure in the translation of DOFs %lld, %lld, %lld, ... "
                       "(%lld per "
                       "node)%s",
                       t.mass, Int(t.first), Int(t.first + t.step), Int(t.first + 2 * t.step), Int(t.step),
                       t.mass > 0 ? "" : ": check the assembly of the mass matrix"));
        }
        // lumped and consistent masses are the same in all directions
        if (smallest > 0 && smallest < 0.99 * largest)
            add(1, smallest / largest,
                format("the mass differs between the translations, %g to %g: is the mass matrix complete in "
                       "every "
                       "direction?",
                       smallest, largest));
    }

    void massless_dofs() {
        const std::int64_t count = m_.n_massless_dofs();
        if (count > 0)
            add(1, static_cast<double>(count),
                format("%lld free DOFs have no mass; they follow quasi-statically. Give them their (rotary) "
                       "inertia if "
                       "their own motion matters",
                       Int(count)));
    }

    void still_dofs() {
        const StillDofs &still = m_.still_dofs();
        if (still.dof.empty()) return;
        const bool alike = still.high_hz < (1 + 1e-6) * still.low_hz;
        add(1, static_cast<double>(still.dof.size()),
            format("%lld DOFs (the first: DOF %lld) are coupled to nothing: alone in their rows of mass, "
                   "stiffness and damping, without contact and load. They are held at zero, and their own "
                   "frequency, %s, is no mode. If they are supports, fix them; if not, "
                   "entries are missing from the matrices",
                   Int(still.dof.size()), Int(still.dof.front()),
                   (alike ? format("%.6g Hz", still.low_hz)
                          : format("%.6g to %.6g Hz", still.low_hz, still.high_hz))
                       .c_str()));
    }

    void rigid_modes() {
        const std::int64_t n = m_.n_rigid();
        if (n == 0) {
            add(0, 0, "no rigid-body mode: the structure is held while its contacts are open");
            return;
        }
        const std::int64_t loose = m_.n_unheld();
        const std::string fact =
            format("%lld rigid-body modes while the contacts are open%s", Int(n),
                   n > 6 ? " (several loose bodies, or parts that are not connected)" : "");
        if (loose > 0) // stops at the ground make sense of what stands on it, or is pressed against them
            add(!m_.has_preload() && touches_ground(m_) ? 2 : 1, static_cast<double>(n),
                format("%s, and %lld of them whatever contact closes: is a support missing? Fix DOFs; "
                       "where free flight is meant, its mean position is taken as zero",
                       fact.c_str(), Int(loose)));
        else if (!m_.has_preload())
            add(1, static_cast<double>(n),
                fact + ", and no pre-load presses the contacts together that could hold them: give the "
                       "model a pre-load, or fix DOFs");
        else
            add(n > 6 ? 1 : 0, static_cast<double>(n), fact + "; closed contacts can hold them");
    }

    void conditioning() {
        const double condition = m_.reciprocal_condition();
        add(condition < 1e-12 ? 1 : 0, condition,
            format("reciprocal condition of the factored %s, estimated from its pivots: %.1e%s",
                   m_.shift() > 0 ? "K + sigma M" : "stiffness", condition,
                   condition < 1e-12 ? "; very stiff or very thin elements, or penalty terms?" : ""));
    }

    // Frequencies carry half of what their squares do; no result is to be wrong by 1 % without a word.
    void rounding() {
        const double uncertain = 0.5 * m_.uncertainty();
        if (uncertain < 5e-3) return;
        add(2, uncertain,
            format(
                "rounding of the stiffness matrix leaves the lowest elastic frequency uncertain by %.1g of "
                "it: the mesh is too fine, or a penalty too stiff, for double precision; use larger "
                "elements, a softer penalty, or supports",
                uncertain));
    }

    void units() {
        const double hz = m_.rough_lowest_elastic() / (2 * M_PI);
        if (!(hz > 0) || (hz >= 1e-3 && hz <= 1e7)) return;
        add(2, hz,
            format("the lowest elastic frequency of the open structure is about %.2g Hz, outside 1e-3..1e7 "
                   "Hz: do the units of mass and stiffness belong together (mm-N-t or m-N-kg)?",
                   hz));
    }

    void damping() {
        if (is_undamped(m_))
            add(1, 0,
                "no damping: the response at resonance is unbounded, and a curve may end there; give the "
                "model modal, Rayleigh or structural damping");
    }

    void loads() {
        double preload = m_.has_preload() ? column_norms(m_.preload())[0] : 0;
        add(0, preload,
            m_.has_preload() ? format("static pre-load, norm %g", preload) : "no static pre-load");
        std::map<int, double> dynamic; // by the power of the frequency
        for (const auto &[part, load] : m_.excitation()) {
            if (part.harmonic == 0) continue;
            double &sum = dynamic[part.power];
            sum = std::hypot(sum, column_norms(load.real)[0], column_norms(load.imag)[0]);
        }
        bool is_driven = false;
        for (const auto &[power, size] : dynamic) {
            if (!(size > 0)) continue;
            is_driven = true;
            const std::string growth = power == 0 ? std::string() : format(" times omega^%d", power);
            add(0, size, format("harmonic excitation, norm %g%s", size, growth.c_str()));
        }
        std::map<int, double> walls; // by the power of the frequency
        for (const auto &[part, gaps] : m_.contact().motion)
            for (std::int64_t i = 0; part.harmonic > 0 && i < m_.n_pairs(); ++i) {
                double &most = walls[part.power];
                most = std::max(most, std::abs(Contact::moved(gaps, i)));
            }
        for (const auto &[power, wall] : walls) {
            if (!(wall > 0)) continue;
            is_driven = true;
            const std::string growth = power == 0 ? std::string() : format(" times omega^%d", power);
            add(0, wall, format("gaps that move, by up to %g%s in one harmonic", wall, growth.c_str()));
        }
        if (!is_driven)
            add(1, 0,
                format("no harmonic excitation on the free DOFs: the response is zero; %s",
                       m_.excitation_on_supports() > 0
                           ? "the one there is acts on fixed DOFs only: move it to DOFs "
                             "that are free"
                           : "give the model one, of harmonic 1"));
    }

    void gaps() {
        const vector<double> &g = m_.initial_gap();
        const double low = *std::min_element(g.begin(), g.end()),
                     high = *std::max_element(g.begin(), g.end());
        const auto interfering = std::count_if(g.begin(), g.end(), [](double v) { return v < 0; });
        add(0, high,
            format("initial gaps from %g to %g over %lld pairs; %s", low, high, Int(m_.n_pairs()),
                   closing_motion().c_str()));
        if (interfering > 0)
            add(1, static_cast<double>(interfering),
                format("%lld pairs start with interference (gap < 0), down to %g; if they should be open, "
                       "the sign of the gap or the normal is reversed",
                       Int(interfering), low));
    }

    // A reversed sign shows here at a glance.
    std::string closing_motion() const {
        const auto row = m_.given_gap_rows()[Contact::normal_row(0)];
        DofTerm strongest = row.front();
        for (const DofTerm &t : row)
            if (std::abs(t.coefficient) > std::abs(strongest.coefficient)) strongest = t;
        return format("motion of DOF %lld in its %s direction closes pair 0", Int(strongest.dof),
                      strongest.coefficient > 0 ? "positive" : "negative");
    }

    // The linear answer of the open structure to the pre-load.
    void opened_by_preload() {
        if (!m_.has_preload() || m_.n_rigid() > 0) return;
        const vector<double> answer = m_.static_gaps(m_.preload());
        vector<double> u(m_.initial_gap().size());
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i)
            u[i] = answer[Contact::normal_row(i)] - m_.initial_gap()[i];
        const double closest = *std::max_element(u.begin(), u.end());
        if (closest >= 0) return;
        // what only touches with its gap taken up may be moved away from it
        const bool touched = *std::min_element(m_.initial_gap().begin(), m_.initial_gap().end()) <= 0;
        add(touched ? 2 : 1, closest,
            format("under the pre-load all %lld pairs are open, the closest by %g: if it should press them "
                   "together, "
                   "its sign, the normals (out of body a towards b) or the gaps are wrong",
                   Int(m_.n_pairs()), -closest));
    }

    void contact_stiffness() {
        const vector<double> &k = m_.contact_stiffness();
        const auto [low, high] = std::minmax_element(k.begin(), k.end());
        const double local = m_.local_stiffness();
        if (!(local > 0)) {
            add(1, 0,
                "the bodies are rigid at the contact: no local stiffness to compare k_n with; choose it by "
                "the "
                "penetration you allow, largest contact force over k_n");
            return;
        }
        const double ratio = *high / local;
        const std::string fact =
            format("contact stiffness %g to %g, that is %.3g to %.3g of the local stiffness %g", *low, *high,
                   *low / local, ratio, local);
        if (ratio > 1000)
            add(1, ratio,
                fact + (ratio > 1e6 ? "; are k_n and K in the same units? Above 1000" : "; above 1000") +
                    ", curves of few harmonics grow small loops and are slow: 1 to 50 is a good choice "
                    "(PLM_AUTO_STIFFNESS: 10)");
        else if (*low / local < 0.1) // and where it does next to nothing the curve is that of no contact
            add(*high / local < 1e-4 ? 2 : 1, *low / local,
                fact + "; below 0.1 the contact is soft and bodies interpenetrate: 1 to 50 is a good choice "
                       "(PLM_AUTO_STIFFNESS: 10). Are k_n and K in the same units?");
        else
            add(0, ratio, fact);
    }

    const Model &m_;
    std::vector<Finding> findings_;
};

} // namespace

bool is_undamped(const Model &model) {
    const Damping &d = model.damping();
    const bool modal =
        std::any_of(d.modal_ratio.begin(), d.modal_ratio.end(), [](double z) { return z > 0; });
    return d.alpha == 0 && d.beta == 0 && d.structural == 0 && !modal && !d.has_matrix;
}

std::vector<Finding> audit(const Model &model) {
    return Audit(model).run(false);
}

std::vector<Finding> quick_audit(const Model &model) {
    return Audit(model).run(true);
}

} // namespace plm
