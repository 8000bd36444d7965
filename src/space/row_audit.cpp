#include "space/row_audit.hpp"
#include <algorithm>
#include <cmath>
#include <map>

namespace plm {
namespace {

using Int = long long; // for printf

constexpr double balanced = 1e-6; // coefficients of printed rows

class RowAudit {
  public:
    explicit RowAudit(const Model &model) : m_(model) {}

    std::vector<Finding> run() {
        rotations();
        mixed_components();
        repeated_rows();
        row_balance();
        return findings_;
    }

  private:
    void add(int severity, double value, std::string text) {
        findings_.push_back({severity, value, std::move(text)});
    }

    using Place = Geometry::Place;

    // The DOFs of a node from K, where its translations tell how many there are.
    std::int64_t per_node() const { return m_.translations().empty() ? 1 : m_.translations().front().step; }

    // By the coordinates that the host gave, else as K numbers the nodes; node -1: neither tells.
    Place place(std::int64_t dof) const {
        if (m_.geometry().is_known()) return m_.geometry().place(dof);
        if (m_.translations().empty()) return {};
        return {dof / per_node(), static_cast<std::size_t>(dof % per_node())};
    }

    // By the coordinates, which know of springs to the ground, too; else what strains nothing in K.
    bool translates(std::int64_t dof) const {
        if (m_.geometry().is_known()) {
            const Place p = m_.geometry().place(dof);
            return p.node < 0 || p.component < 3;
        }
        const vector<Translation> &known = m_.translations();
        return per_node() < 2 ||
               std::any_of(known.begin(), known.end(), [&](const Translation &t) { return t.holds(dof); });
    }

    // A gap row of rotations alone measures an angle.
    void rotations() {
        const auto rows = m_.given_gap_rows();
        std::int64_t turned = 0, one = -1;
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i) {
            const auto &row = rows[Contact::normal_row(i)];
            const bool moves =
                std::any_of(row.begin(), row.end(), [&](const DofTerm &g) { return translates(g.dof); });
            if (!moves && !row.empty() && turned++ == 0) one = i;
        }
        if (turned == 0) return;
        std::string where;
        if (!m_.geometry().is_known()) {
            const Translation &first = m_.translations().front();
            where = format(" Translations are DOFs %lld, %lld, ... counted from 0", Int(first.first),
                           Int(first.first + first.step));
        }
        add(2, static_cast<double>(turned),
            format("%lld pairs (the first: pair %lld, DOF %lld) touch no DOF of a translation: do they use a "
                   "rotation, or numbers that are off by one?%s",
                   Int(turned), Int(one), Int(rows[static_cast<std::size_t>(one)].front().dof),
                   where.c_str()));
    }

    // Two nodes touch along an axis by one component, the same on both sides, unless their DOFs were counted
    // with another number of them per node.
    void mixed_components() {
        const auto is_mixed = [&](const DofTerms &row) {
            if (row.size() != 2) return false;
            const Place a = place(row[0].dof), b = place(row[1].dof);
            const bool opposed =
                std::abs(row[0].coefficient + row[1].coefficient) < 1e-6 * std::abs(row[0].coefficient);
            return opposed && a.node >= 0 && b.node >= 0 && a.node != b.node && a.component != b.component;
        };
        const auto rows = m_.given_gap_rows();
        std::int64_t mixed = 0, one = -1;
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i)
            if (is_mixed(rows[Contact::normal_row(i)]) && mixed++ == 0) one = i;
        if (mixed == 0) return;
        const auto &row = rows[Contact::normal_row(one)];
        const std::int64_t a = row[0].dof, b = row[1].dof;
        add(1, static_cast<double>(mixed),
            format("%lld pairs of two DOFs (the first: pair %lld, DOFs %lld and %lld) join component %lld of "
                   "one node to component %lld of another%s; were they counted with another number of them "
                   "per node?",
                   Int(mixed), Int(one), Int(a), Int(b), Int(place(a).component), Int(place(b).component),
                   (m_.geometry().is_known()
                        ? std::string()
                        : format(": the stiffness matrix has %lld DOFs per node", Int(per_node())))
                       .c_str()));
    }

    // Rows as (DOF, coefficient) lists; equal ones share a key.
    void repeated_rows() {
        const auto rows = m_.given_gap_rows();
        std::map<std::vector<std::pair<std::int64_t, double>>, std::int64_t> first;
        std::int64_t repeated = 0, one = 0, other = 0;
        for (std::int64_t i = 0; i < m_.n_pairs(); ++i) {
            std::vector<std::pair<std::int64_t, double>> row;
            for (const DofTerm &t : rows[Contact::normal_row(i)]) row.emplace_back(t.dof, t.coefficient);
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
        for (const auto &row : m_.given_gap_rows()) {
            double sum = 0, positive = 0, negative = 0;
            for (const DofTerm &t : row) {
                sum += t.coefficient;
                (t.coefficient > 0 ? positive : negative) += t.coefficient * t.coefficient;
            }
            const double side = std::sqrt(std::max(positive, negative));
            const bool two_sided = positive > 0 && negative > 0 && row.size() == 2 && !is_of_one_node(row);
            unbalanced += two_sided && std::abs(sum) > balanced * side;
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

    // Against the ground along an oblique normal. Where nothing tells which DOFs a node has, two coefficients
    // that make a direction are taken for one.
    bool is_of_one_node(const DofTerms &row) const {
        const Place a = place(row[0].dof), b = place(row[1].dof);
        if (a.node >= 0 && b.node >= 0) return a.node == b.node;
        return std::abs(std::hypot(row[0].coefficient, row[1].coefficient) - 1) < balanced;
    }

    const Model &m_;
    std::vector<Finding> findings_;
};

} // namespace

std::vector<Finding> row_audit(const Model &model) {
    return RowAudit(model).run();
}

bool touches_ground(const Model &model) {
    const auto rows = model.given_gap_rows();
    for (std::int64_t i = 0; i < model.n_pairs(); ++i) {
        const auto &row = rows[Contact::normal_row(i)];
        if (model.translations().empty() && row.size() == 1) return true;
        for (const Translation &t : model.translations()) {
            double moved = 0, size = 0;
            for (const DofTerm &g : row)
                if (t.holds(g.dof)) moved += g.coefficient, size += std::abs(g.coefficient);
            if (std::abs(moved) > balanced * size) return true;
        }
    }
    return false;
}

} // namespace plm
