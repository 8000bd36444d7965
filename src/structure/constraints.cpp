#include "structure/constraints.hpp"
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

namespace plm {
namespace {

using Int = long long; // for printf
constexpr std::int64_t none = -1;

// Of a row in work: size is what its coefficient was made of before terms cancelled.
struct Term {
    std::int64_t dof;
    double value, size;
};
using Row = vector<Term>; // by ascending DOF

Row::const_iterator find(const Row &row, std::int64_t dof) {
    const auto at = std::lower_bound(row.begin(), row.end(), dof,
                                     [](const Term &t, std::int64_t wanted) { return t.dof < wanted; });
    return at != row.end() && at->dof == dof ? at : row.end();
}

// The part of its terms that is left, at most.
double remainder(const Row &row) {
    double most = 0;
    for (const Term &t : row) most = std::max(most, std::abs(t.value) / t.size);
    return most;
}

class Elimination {
  public:
    Elimination(const ConstraintRows &rows, const vector<char> &fixed, const vector<char> &kept)
        : kept_(kept), by_row_(static_cast<std::size_t>(rows.n_rows())), rows_of_(fixed.size()),
          count_(fixed.size(), 0), scale_(fixed.size(), 1.0), dependent_of_(fixed.size(), none) {
        for (std::int64_t i = 0; i < rows.n_rows(); ++i) take(rows, i, fixed);
        named_ = count_;
        equilibrate();
    }

    EliminatedConstraints run() {
        while (!waiting_.empty()) {
            const auto [length, row] = waiting_.top();
            waiting_.pop();
            if (length == static_cast<std::int64_t>(of(row).size()) && !is_done(row)) finish(row);
        }
        substitute();
        return std::move(found_);
    }

  private:
    Row &of(std::int64_t row) { return by_row_[static_cast<std::size_t>(row)]; }
    vector<std::int64_t> &rows_of(std::int64_t dof) { return rows_of_[static_cast<std::size_t>(dof)]; }
    bool is_done(std::int64_t row) const { return done_[row]; }

    void take(const ConstraintRows &rows, std::int64_t i, const vector<char> &fixed) {
        Row &row = of(i);
        for (std::int64_t p = rows.ptr[i]; p < rows.ptr[i + 1]; ++p) {
            const double c = rows.coefficient[p];
            if (!fixed[rows.dof[p]] && c != 0) row.push_back({rows.dof[p], c, std::abs(c)});
        }
        std::sort(row.begin(), row.end(), [](const Term &a, const Term &b) { return a.dof < b.dof; });
        for (const Term &t : row) rows_of(t.dof).push_back(i), ++count_[t.dof];
        done_.push_back(0);
        wait_for(i);
    }

    void wait_for(std::int64_t row) { waiting_.emplace(static_cast<std::int64_t>(of(row).size()), row); }

    // Rotations come with other units than displacements: with these factors of the DOFs, and others of the
    // rows, the largest coefficients in rows and columns come near 1 (Ruiz 2001).
    void equilibrate() {
        vector<double> of_row(by_row_.size(), 1.0);
        for (int sweep = 0; sweep < 4; ++sweep) {
            vector<double> largest(scale_.size(), 0.0);
            for (std::size_t i = 0; i < by_row_.size(); ++i) {
                double most = 0;
                for (const Term &t : by_row_[i]) {
                    const double size = of_row[i] * std::abs(t.value) * scale_[t.dof];
                    most = std::max(most, size), largest[t.dof] = std::max(largest[t.dof], size);
                }
                if (most > 0) of_row[i] /= std::sqrt(most);
            }
            for (std::size_t j = 0; j < scale_.size(); ++j)
                if (largest[j] > 0) scale_[j] /= std::sqrt(largest[j]);
        }
    }

    void finish(std::int64_t row) {
        done_[row] = 1;
        const double left = remainder(of(row));
        if (left <= cancelled_as_printed) {
            ++found_.n_redundant;
            if (left > found_.largest_miss) found_.largest_miss = left, found_.missing_row = row;
            forget(row);
            return;
        }
        const Term pivot = choose(of(row));
        dependent_of_[pivot.dof] = static_cast<std::int64_t>(found_.dependent.size());
        found_.dependent.push_back({pivot.dof, row, {}});
        vector<std::int64_t> others;
        others.swap(rows_of(pivot.dof));
        for (std::int64_t other : others)
            if (!is_done(other)) subtract(row, pivot, other);
        for (const Term &t : of(row)) --count_[t.dof];
    }

    void forget(std::int64_t row) {
        for (const Term &t : of(row)) --count_[t.dof];
        of(row).clear();
    }

    // Nothing that has cancelled, nothing small beside the others, and of the rest what fills least; in the
    // end what few rows named from the start, and the mean rather than one of those it is taken of.
    Term choose(const Row &row) const {
        constexpr double not_small = 0.01;
        const auto scaled = [&](const Term &t) { return std::abs(t.value) * scale_[t.dof]; };
        const auto is_left = [](const Term &t) { return std::abs(t.value) > cancelled_as_printed * t.size; };
        double most = 0;
        for (const Term &t : row)
            if (is_left(t)) most = std::max(most, scaled(t));
        const auto is_small = [&](const Term &t) { return scaled(t) <= cancelled_as_printed * most; };
        const auto is_kept = [&](const Term &t) { return !kept_.empty() && kept_[t.dof]; };
        const bool all_kept = std::all_of(row.begin(), row.end(), [&](const Term &t) {
            return is_kept(t) || !is_left(t) || is_small(t); // rounding of what is zero must not give a DOF
        });
        const auto may_go = [&](const Term &t) {
            return is_left(t) && !is_small(t) && (all_kept || !is_kept(t));
        };
        const auto cost = [&](const Term &t) {
            const double size = std::abs(t.value);
            return std::make_tuple(static_cast<double>(count_[t.dof] - 1) / size, named_[t.dof], -size);
        };
        double largest = 0;
        for (const Term &t : row)
            if (may_go(t)) largest = std::max(largest, scaled(t));
        const Term *best = nullptr;
        for (const Term &t : row)
            if (may_go(t) && scaled(t) >= not_small * largest && (!best || cost(t) < cost(*best))) best = &t;
        return *best;
    }

    // other becomes other - (its part of the pivot) row, where it has one.
    void subtract(std::int64_t row, const Term &pivot, std::int64_t other) {
        const Row &from = of(row), old = of(other);
        const auto at = find(old, pivot.dof);
        if (at == old.end()) return;
        const double factor = at->value / pivot.value;
        Row merged;
        auto a = old.begin();
        auto b = from.begin();
        while (a != old.end() || b != from.end()) {
            const bool has_a = a != old.end() && (b == from.end() || a->dof <= b->dof),
                       has_b = b != from.end() && (a == old.end() || b->dof <= a->dof);
            Term t{has_a ? a->dof : b->dof, 0, 0};
            if (has_a) t.value = a->value, t.size = a->size, ++a;
            if (has_b)
                t.value -= factor * b->value, t.size = std::max(t.size, std::abs(factor) * b->size), ++b;
            const bool stays = t.dof != pivot.dof && std::abs(t.value) > cancelled_exactly * t.size;
            if (stays) merged.push_back(t);
            count_[t.dof] += static_cast<std::int64_t>(stays) - static_cast<std::int64_t>(has_a);
            if (stays && !has_a) rows_of(t.dof).push_back(other);
        }
        of(other) = std::move(merged);
        wait_for(other);
    }

    // The row of a dependent DOF names DOFs that stay and some that became dependent after it.
    void substitute() {
        std::int64_t entries = 0;
        for (std::size_t k = found_.dependent.size(); k-- > 0;) {
            EliminatedConstraints::Dependent &d = found_.dependent[k];
            DofTerms terms;
            double pivot = 1;
            for (const Term &t : of(d.row)) {
                const std::int64_t also = dependent_of_[t.dof];
                if (t.dof == d.dof)
                    pivot = t.value;
                else if (also == none)
                    terms.push_back({t.dof, t.value});
                else
                    for (const DofTerm &u : found_.dependent[static_cast<std::size_t>(also)].terms)
                        terms.push_back({u.dof, t.value * u.coefficient});
            }
            d.terms = summed(std::move(terms));
            for (DofTerm &t : d.terms) t.coefficient /= -pivot;
            entries += static_cast<std::int64_t>(d.terms.size());
            require_sparse(entries, d);
        }
    }

    static DofTerms summed(DofTerms terms) {
        std::stable_sort(terms.begin(), terms.end(),
                         [](const DofTerm &a, const DofTerm &b) { return a.dof < b.dof; });
        DofTerms sums;
        for (std::size_t i = 0; i < terms.size();) {
            DofTerm sum{terms[i].dof, 0};
            double size = 0;
            for (; i < terms.size() && terms[i].dof == sum.dof; ++i)
                sum.coefficient += terms[i].coefficient, size += std::abs(terms[i].coefficient);
            if (std::abs(sum.coefficient) > cancelled_exactly * size) sums.push_back(sum);
        }
        return sums;
    }

    static void require_sparse(std::int64_t entries, const EliminatedConstraints::Dependent &d) {
        constexpr std::int64_t most = 100'000'000;
        if (entries <= most) return;
        throw Error(
            status::memory,
            format("constraint row %lld (counted from 0, in the order they were added) leaves DOF %lld "
                   "as a sum of %lld others, and with it more than %lld coefficients in all: it couples "
                   "DOFs that are coupled to very many themselves; join such couplings at fewer nodes",
                   Int(d.row), Int(d.dof), Int(d.terms.size()), Int(most)))
            .argument("dof")
            .index(d.row);
    }

    const vector<char> &kept_;
    std::vector<Row> by_row_;
    std::vector<vector<std::int64_t>> rows_of_; // of a DOF; some may have lost it since
    vector<std::int64_t> count_;                // of rows still at work in which a DOF stands
    vector<std::int64_t> named_;                // of rows as they were given
    vector<double> scale_;
    vector<std::int64_t> dependent_of_;
    vector<char> done_;
    using Place = std::pair<std::int64_t, std::int64_t>; // length when it was put in, row
    std::priority_queue<Place, std::vector<Place>, std::greater<Place>> waiting_;
    EliminatedConstraints found_;
};

} // namespace

EliminatedConstraints eliminate(const ConstraintRows &rows, const vector<char> &fixed,
                                const vector<char> &kept) {
    if (rows.n_rows() == 0) return {};
    return Elimination(rows, fixed, kept).run();
}

} // namespace plm
