#include "structure/couplings.hpp"
#include "linalg/error.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>

namespace plm {
namespace {

constexpr int next(int axis) {
    return (axis + 1) % 3;
}
constexpr int last(int axis) {
    return (axis + 2) % 3;
}

} // namespace

void add_row(ConstraintRows &rows, const DofTerms &terms) {
    for (const DofTerm &t : terms)
        if (t.dof != no_dof && t.coefficient != 0)
            rows.dof.push_back(t.dof), rows.coefficient.push_back(t.coefficient);
    const auto end = static_cast<std::int64_t>(rows.dof.size());
    if (end > rows.ptr.back()) rows.ptr.push_back(end);
}

namespace {

// Generously, so that adding couplings one by one stays linear.
template <class T> void reserve_more(vector<T> &to, std::size_t more) {
    if (to.capacity() - to.size() < more) to.reserve(std::max(to.size() + more, 2 * to.capacity()));
}

} // namespace

void append(ConstraintRows &to, const ConstraintRows &rows) {
    reserve_more(to.dof, rows.dof.size());
    reserve_more(to.coefficient, rows.coefficient.size());
    reserve_more(to.ptr, rows.ptr.size());
    const std::int64_t before = to.ptr.back();
    to.dof.insert(to.dof.end(), rows.dof.begin(), rows.dof.end());
    to.coefficient.insert(to.coefficient.end(), rows.coefficient.begin(), rows.coefficient.end());
    for (std::int64_t i = 0; i < rows.n_rows(); ++i) to.ptr.push_back(before + rows.ptr[i + 1]);
}

// u = u_0 + theta_0 x r, theta = theta_0.
ConstraintRows rigid_link(const CoupledNode &reference, const vector<CoupledNode> &dependent) {
    ConstraintRows rows;
    const auto &of = reference.dof;
    for (const CoupledNode &node : dependent) {
        const Point r = difference(node.at, reference.at);
        for (int k = 0; k < 3; ++k)
            if (node.dof[k] != no_dof)
                add_row(rows, {{node.dof[k], 1},
                               {of[k], -1},
                               {of[3 + next(k)], -r[last(k)]},
                               {of[3 + last(k)], r[next(k)]}});
        for (int k = 3; k < 6; ++k)
            if (node.dof[k] != no_dof) add_row(rows, {{node.dof[k], 1}, {of[k], -1}});
    }
    return rows;
}

namespace {

// The rigid motion that fits best: about the centre of the weights its translation is the mean of those of
// the nodes, and its rotation T^-1 sum w r x u, with T = sum w (r^2 - r r^T).
class RigidFit {
  public:
    RigidFit(const vector<CoupledNode> &nodes, const vector<double> &weight)
        : nodes_(nodes), weight_(weight), turn_(3, 3) {
        for (double w : weight) total_ += w;
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (int k = 0; k < 3; ++k) centre_[k] += weight[i] / total_ * nodes[i].at[k];
        invert(moments());
    }

    void require_for(const CoupledNode &reference) const {
        const Point arm = difference(reference.at, centre_);
        for (const Point &axis : loose_) {
            for (int k = 0; k < 3; ++k)
                if (reference.dof[3 + k] != no_dof && std::abs(axis[k]) > along)
                    throw undetermined(axis, "which a rotation of the reference node is to follow: add a "
                                             "node beside them, or give the reference node 3 DOFs");
            const Point moves = cross(axis, arm);
            for (int k = 0; k < 3; ++k)
                if (reference.dof[k] != no_dof && std::abs(moves[k]) > standing_off())
                    throw undetermined(axis,
                                       format("which would move the reference node, %g beside them: add a "
                                              "node beside them, or move the reference node onto them",
                                              length(moves)));
        }
    }

    // Of the rotation about axis k, and of the translation along it at an arm from the centre.
    DofTerms rotation(int k) const {
        DofTerms terms;
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            for (int l = 0; l < 3; ++l) terms.push_back({nodes_[i].dof[l], turned(i, k, l)});
        return without_rounding(std::move(terms));
    }
    DofTerms translation(int k, const Point &reference) const {
        const Point arm = difference(reference, centre_);
        DofTerms terms;
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            for (int l = 0; l < 3; ++l)
                terms.push_back({nodes_[i].dof[l], (k == l ? weight_[i] / total_ : 0.0) +
                                                       turned(i, next(k), l) * arm[last(k)] -
                                                       turned(i, last(k), l) * arm[next(k)]});
        return without_rounding(std::move(terms));
    }

  private:
    // Nearer to a line than digits of printed coordinates tell is on it.
    static constexpr double on_line = 1e-5, along = 1e-6;

    Matrix moments() {
        Matrix t(3, 3);
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            const Point r = difference(nodes_[i].at, centre_);
            size_ = std::max(size_, length(r));
            far_ = std::max(far_, length(nodes_[i].at));
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l)
                    t(k, l) += weight_[i] * ((k == l ? dot(r, r) : 0.0) - r[k] * r[l]);
        }
        return t;
    }

    // Of the largest moment, and not in units of length: what is loose is the same in m and in mm.
    void invert(const Matrix &moments) {
        const SymmetricEigen e = symmetric_eigen(moments);
        const double noise = 1e-12 * far_;
        for (int j = 0; j < 3; ++j) {
            const Point axis{e.vectors(0, j), e.vectors(1, j), e.vectors(2, j)};
            if (size_ <= noise || e.values[j] <= on_line * on_line * e.values[2])
                loose_.push_back(axis);
            else
                for (int k = 0; k < 3; ++k)
                    for (int l = 0; l < 3; ++l) turn_(k, l) += axis[k] * axis[l] / e.values[j];
        }
    }

    double standing_off() const { return on_line * size_ + 1e-9 * far_; }

    // What unit motion of node i along l turns about k.
    double turned(std::size_t i, int k, int l) const {
        const Point r = difference(nodes_[i].at, centre_);
        return weight_[i] * (turn_(k, next(l)) * r[last(l)] - turn_(k, last(l)) * r[next(l)]);
    }

    static DofTerms without_rounding(DofTerms terms) {
        constexpr double rounding = 1e-15;
        double largest = 0;
        for (const DofTerm &t : terms) largest = std::max(largest, std::abs(t.coefficient));
        for (DofTerm &t : terms)
            if (std::abs(t.coefficient) <= rounding * largest) t.coefficient = 0;
        return terms;
    }

    Error undetermined(const Point &axis, const std::string &need) const {
        const std::string where =
            loose_.size() == 3 ? "all nodes of the coupling are at one point"
                               : format("the nodes of the coupling are on a line, along (%.4g, %.4g, %.4g)",
                                        axis[0], axis[1], axis[2]);
        return Error(status::argument, where + ": their motions do not tell the rotation about it, " + need)
            .argument("xyz");
    }

    const vector<CoupledNode> &nodes_;
    const vector<double> &weight_;
    double total_ = 0, size_ = 0, far_ = 0;
    Point centre_{};
    Matrix turn_;              // T^-1, without what is loose
    std::vector<Point> loose_; // axes of rotations that are not determined
};

} // namespace

ConstraintRows distributing_coupling(const CoupledNode &reference, const vector<CoupledNode> &nodes,
                                     const vector<double> &weight) {
    const RigidFit fit(nodes, weight);
    fit.require_for(reference);
    ConstraintRows rows;
    for (int k = 0; k < 6; ++k) {
        if (reference.dof[k] == no_dof) continue;
        DofTerms terms = k < 3 ? fit.translation(k, reference.at) : fit.rotation(k - 3);
        for (DofTerm &t : terms) t.coefficient = -t.coefficient;
        terms.push_back({reference.dof[k], 1});
        add_row(rows, terms);
    }
    return rows;
}

} // namespace plm
