#include "structure/wide_rows.hpp"
#include <algorithm>
#include <cmath>
#include <utility>

namespace plm {
namespace {

// Of 20 nodes: the DOF that a sum gives then couples about as many as an element does.
constexpr std::int64_t group_size = 60;
// Shorter ones couple no more than their groups would.
constexpr std::int64_t widest_whole = 4 * group_size;

class Grouping {
  public:
    Grouping(const ConstraintRows &rows, std::int64_t n_dof) : n_dof_(n_dof) {
        for (std::int64_t i = 0; i < rows.n_rows(); ++i) {
            DofTerms row;
            for (std::int64_t p = rows.ptr[i]; p < rows.ptr[i + 1]; ++p)
                row.push_back({rows.dof[p], rows.coefficient[p]});
            std::sort(row.begin(), row.end());
            rows_.push_back(std::move(row));
            given_.push_back(i);
        }
    }

    // Of the sums' row again sums, while that makes them shorter.
    GroupedRows run() {
        while (pass()) {
        }
        GroupedRows out;
        for (const DofTerms &row : rows_) {
            for (const DofTerm &t : row)
                out.rows.dof.push_back(t.dof), out.rows.coefficient.push_back(t.coefficient);
            out.rows.ptr.push_back(static_cast<std::int64_t>(out.rows.dof.size()));
        }
        out.given = std::move(given_), out.within = std::move(within_);
        return out;
    }

  private:
    struct Share {
        std::int64_t group;
        std::size_t row;
        bool operator<(const Share &o) const { return group != o.group ? group < o.group : row < o.row; }
    };

    // The terms of which a wide row has many, not the few that outweigh them: of a mean, not the mean itself.
    static DofTerms small_terms(const DofTerms &row) {
        double sum = 0;
        for (const DofTerm &t : row) sum += t.coefficient * t.coefficient;
        DofTerms small;
        for (const DofTerm &t : row)
            if (static_cast<double>(widest_whole) * t.coefficient * t.coefficient <= sum) small.push_back(t);
        if (static_cast<std::int64_t>(small.size()) <= widest_whole) small.clear();
        return small;
    }

    // Groups are the same in all rows: the six of a coupling meet in the same few DOFs.
    bool pass() {
        std::vector<DofTerms> small;
        vector<std::int64_t> dofs;
        for (const DofTerms &row : rows_) {
            small.push_back(small_terms(row));
            for (const DofTerm &t : small.back()) dofs.push_back(t.dof);
        }
        std::sort(dofs.begin(), dofs.end());
        dofs.erase(std::unique(dofs.begin(), dofs.end()), dofs.end());
        const auto group_of = [&](const DofTerm &t) {
            return (std::lower_bound(dofs.begin(), dofs.end(), t.dof) - dofs.begin()) / group_size;
        };
        std::vector<std::pair<Share, DofTerms>> shares;
        std::size_t terms = 0;
        for (std::size_t i = 0; i < small.size(); ++i)
            for (const DofTerm &t : small[i]) {
                const Share at{group_of(t), i};
                if (shares.empty() || at.row != shares.back().first.row ||
                    at.group != shares.back().first.group)
                    shares.push_back({at, {}});
                shares.back().second.push_back(t);
                ++terms;
            }
        if (2 * shares.size() >= terms) return false; // none wide, or far apart in their numbers
        std::sort(shares.begin(), shares.end(),
                  [](const auto &a, const auto &b) { return a.first < b.first; });
        leave_out(small);
        for (auto &[at, share] : shares) put_in_sum(at.row, share);
        return true;
    }

    void leave_out(const std::vector<DofTerms> &small) {
        for (std::size_t i = 0; i < small.size(); ++i) {
            DofTerms rest;
            std::set_difference(rows_[i].begin(), rows_[i].end(), small[i].begin(), small[i].end(),
                                std::back_inserter(rest));
            rows_[i] = std::move(rest);
        }
    }

    // Of the size of the largest term, so that what follows from it keeps the scale of the matrices.
    void put_in_sum(std::size_t row, DofTerms &share) {
        double largest = 0;
        for (const DofTerm &t : share) largest = std::max(largest, std::abs(t.coefficient));
        const std::int64_t first = share.front().dof,
                           sum = n_dof_ + static_cast<std::int64_t>(within_.size());
        within_.push_back(first < n_dof_ ? first : within_[static_cast<std::size_t>(first - n_dof_)]);
        for (DofTerm &t : share) t.coefficient /= largest;
        share.push_back({sum, -1.0}); // the last one: it is new
        rows_[row].push_back({sum, largest});
        const std::int64_t given = given_[row];
        rows_.push_back(std::move(share)), given_.push_back(given);
    }

    std::int64_t n_dof_;
    std::vector<DofTerms> rows_; // by ascending DOF
    vector<std::int64_t> given_, within_;
};

} // namespace

GroupedRows in_groups(const ConstraintRows &rows, std::int64_t n_dof) {
    return Grouping(rows, n_dof).run();
}

} // namespace plm
