#include "space/audit.hpp"
#include "space/modal_audit.hpp"
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
        rigid_modes();
        conditioning();
        rounding();
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
        rotations();
        mixed_components();
        repeated_rows();
        row_balance();
        contact_stiffness();
        return findings_;
    }

  private:
    void add(int severity, double value, std::string text) {
        findings_.push_back({severity, value, std::move(text)});
    }

    // Only what the matrices tell: how many DOFs a node has is not known otherwise.
    void mass() {
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
        if (loose > 0)
            add(1, static_cast<double>(n),
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

    void damping() {
        const Damping &d = m_.damping();
        const bool modal =
            std::any_of(d.modal_ratio.begin(), d.modal_ratio.end(), [](double z) { return z > 0; });
        if (d.alpha == 0 && d.beta == 0 && d.structural == 0 && !modal && !d.has_matrix)
            add(1, 0,
                "no damping: the response at resonance is unbounded, and a curve may end there; give the "
                "model modal, Rayleigh or structural damping");
    }

    void loads() {
        double preload = m_.has_preload() ? column_norms(m_.preload())[0] : 0;
        add(0, preload,
            m_.has_preload() ? format("static pre-load, norm %g", preload) : "no static pre-load");
        double dynamic = 0;
        for (const auto &[harmonic, load] : m_.excitation()) {
            if (harmonic == 0) continue;
            dynamic = std::hypot(dynamic, column_norms(load.real)[0], column_norms(load.imag)[0]);
        }
        if (dynamic > 0)
            add(0, dynamic, format("harmonic excitation, norm %g", dynamic));
        else
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
        const auto row = m_.gap_rows().rows()[Contact::normal_row(0)];
        GapRows::Term strongest = row.front();
        for (const GapRows::Term &t : row)
            if (std::abs(t.coefficient) > std::abs(strongest.coefficient)) strongest = t;
        return format("motion of DOF %lld in its %s direction closes pair 0", Int(m_.dof(strongest.dof)),
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
        add(1, closest,
            format("under the pre-load all %lld pairs are open, the closest by %g: if it should press them "
                   "together, "
                   "its sign, the normals (out of body a towards b) or the gaps are wrong",
                   Int(m_.n_pairs()), -closest));
    }

    // Where translations are known, a gap row of other DOFs alone measures an angle.
    void rotations() {
        const vector<Translation> &known = m_.translations();
        if (known.empty() || known.front().step < 2) return;
        const auto rows = m_.gap_rows().rows();
        std::int64_t turned = 0, one = -1;
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i) {
            const auto &row = rows[Contact::normal_row(i)];
            const bool moves = std::any_of(row.begin(), row.end(), [&](const GapRows::Term &g) {
                return std::any_of(known.begin(), known.end(),
                                   [&](const Translation &t) { return t.holds(m_.dof(g.dof)); });
            });
            if (!moves && turned++ == 0) one = i;
        }
        if (turned > 0)
            add(1, static_cast<double>(turned),
                format("%lld pairs (the first: pair %lld, DOF %lld) touch no DOF of a translation: do they "
                       "use a "
                       "rotation, or numbers that are off by one? Translations are DOFs %lld, %lld, ... "
                       "counted from 0",
                       Int(turned), Int(one), Int(m_.dof(rows[static_cast<std::size_t>(one)].front().dof)),
                       Int(known.front().first), Int(known.front().first + known.front().step)));
    }

    // Two nodes touch along an axis by one component, the same on both sides, unless their DOFs were counted
    // with another number of them per node.
    void mixed_components() {
        const vector<Translation> &known = m_.translations();
        if (known.empty() || known.front().step < 2) return;
        const std::int64_t step = known.front().step;
        const auto is_mixed = [&](const vector<GapRows::Term> &row) {
            if (row.size() != 2) return false;
            const std::int64_t a = m_.dof(row[0].dof), b = m_.dof(row[1].dof);
            const bool opposed =
                std::abs(row[0].coefficient + row[1].coefficient) < 1e-6 * std::abs(row[0].coefficient);
            return opposed && a / step != b / step && a % step != b % step;
        };
        const auto rows = m_.gap_rows().rows();
        std::int64_t mixed = 0, one = -1;
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i)
            if (is_mixed(rows[Contact::normal_row(i)]) && mixed++ == 0) one = i;
        if (mixed == 0) return;
        const auto &row = rows[Contact::normal_row(one)];
        const std::int64_t a = m_.dof(row[0].dof), b = m_.dof(row[1].dof);
        add(1, static_cast<double>(mixed),
            format("%lld pairs of two DOFs (the first: pair %lld, DOFs %lld and %lld) join component %lld of "
                   "one node to component %lld of another: the stiffness matrix has %lld DOFs per node; were "
                   "they counted with another number of them?",
                   Int(mixed), Int(one), Int(a), Int(b), Int(a % step), Int(b % step), Int(step)));
    }

    // Rows as (DOF, coefficient) lists; equal ones share a key.
    void repeated_rows() {
        const auto rows = m_.gap_rows().rows();
        std::map<std::vector<std::pair<std::int64_t, double>>, std::int64_t> first;
        std::int64_t repeated = 0, one = 0, other = 0;
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i) {
            std::vector<std::pair<std::int64_t, double>> row;
            for (const GapRows::Term &t : rows[Contact::normal_row(i)])
                row.emplace_back(t.dof, t.coefficient);
            const auto [place, fresh] = first.emplace(std::move(row), i);
            if (fresh) continue;
            if (repeated++ == 0) one = place->second, other = i;
        }
        if (repeated > 0)
            add(2, static_cast<double>(repeated),
                format("%lld gap rows repeat an earlier one (the first: pair %lld repeats pair %lld): the "
                       "contact stiffness counts twice there; add each pair once",
                       Int(repeated), Int(other), Int(one)));
    }

    // A pair of nodes moved together keeps its gap: the coefficients of a row cancel, unless a side is ground
    // or fixed.
    void row_balance() {
        std::int64_t unbalanced = 0, scaled = 0;
        for (const auto &row : m_.gap_rows().rows()) {
            double sum = 0, positive = 0, negative = 0;
            for (const GapRows::Term &t : row) {
                sum += t.coefficient;
                (t.coefficient > 0 ? positive : negative) += t.coefficient * t.coefficient;
            }
            const double side = std::sqrt(std::max(positive, negative));
            const bool two_sided = positive > 0 && negative > 0 && row.size() == 2;
            unbalanced += two_sided && std::abs(sum) > 1e-6 * side;
            scaled += side > 1.5 || side < 0.3;
        }
        if (unbalanced > 0)
            add(1, static_cast<double>(unbalanced),
                format("%lld two-DOF gap rows do not sum to zero: moving both nodes together changes the "
                       "gap. Give "
                       "both sides the same normal, with opposite signs",
                       Int(unbalanced)));
        if (scaled > 0)
            add(1, static_cast<double>(scaled),
                format("%lld gap rows are far from unit length: k_n and the gap are "
                       "then not per unit of distance. Divide each row by its length (a DOF given twice adds "
                       "up)",
                       Int(scaled)));
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
        else if (*low / local < 0.1)
            add(1, *low / local,
                fact + "; below 0.1 the contact is soft and bodies interpenetrate: 1 to 50 is a good choice");
        else
            add(0, ratio, fact);
    }

    const Model &m_;
    std::vector<Finding> findings_;
};

} // namespace

std::vector<Finding> audit(const Model &model) {
    return Audit(model).run(false);
}

std::vector<Finding> quick_audit(const Model &model) {
    return Audit(model).run(true);
}

} // namespace plm
