#include "mpi/rows.hpp"
#include <algorithm>

namespace plm::mpi {
namespace {

[[noreturn]] void owned_twice(std::int64_t dof, int one, int other) {
    throw Error(status::argument,
                format("DOF %lld (base 0) is owned by rank %d and by rank %d; each DOF has one owner",
                       static_cast<long long>(dof), one, other))
        .argument("dof")
        .index(dof);
}

} // namespace

Rows::Rows(Team &team, std::int64_t n_dof, const std::vector<std::int64_t> &owned) : n_dof_(n_dof) {
    std::vector<int> to, from;
    team.together([&] {
        part_ = (n_dof + team.size() - 1) / team.size();
        first_ = std::min(n_dof, part_ * team.rank());
        directory_.assign(static_cast<std::size_t>(std::min(part_, n_dof - first_)), -1);
        owned_ = owned;
        std::sort(owned_.begin(), owned_.end());
        for (std::int64_t dof : owned_) {
            to.push_back(keeper(dof));
            if (runs_.empty() || dof != runs_.back().first + runs_.back().length)
                runs_.push_back({dof, static_cast<std::int64_t>(to.size()) - 1, 0});
            ++runs_.back().length;
        }
    });
    const std::vector<std::int64_t> told = deliver(team, owned_, to, &from);
    team.together([&] {
        for (std::size_t k = 0; k < told.size(); ++k) {
            int &owner = directory_[static_cast<std::size_t>(told[k] - first_)];
            if (owner >= 0) owned_twice(told[k], owner, from[k]);
            owner = from[k];
        }
        const auto nobody = std::find(directory_.begin(), directory_.end(), -1);
        if (nobody == directory_.end()) return;
        const std::int64_t dof = first_ + (nobody - directory_.begin());
        throw Error(status::argument,
                    format("no rank owns DOF %lld (base 0); each DOF has one owner (plm_team_own_dofs_i64)",
                           static_cast<long long>(dof)))
            .argument("dof")
            .index(dof);
    });
}

std::int64_t Rows::local(std::int64_t dof) const {
    auto run = std::upper_bound(runs_.begin(), runs_.end(), dof,
                                [](std::int64_t d, const Run &r) { return d < r.first; });
    if (run == runs_.begin()) return -1;
    --run;
    const std::int64_t offset = dof - run->first;
    return offset < run->length ? run->place + offset : -1;
}

std::vector<int> Rows::owners_of(Team &team, const std::vector<std::int64_t> &dofs) const {
    struct Question {
        std::int64_t dof, place;
    };
    struct Answer {
        std::int64_t place;
        int owner;
    };
    std::vector<Question> asked;
    std::vector<int> to, asker;
    team.together([&] {
        for (std::size_t k = 0; k < dofs.size(); ++k) {
            asked.push_back({dofs[k], static_cast<std::int64_t>(k)});
            to.push_back(keeper(dofs[k]));
        }
    });
    const std::vector<Question> questions = deliver(team, asked, to, &asker);
    std::vector<Answer> found;
    team.together([&] {
        for (const Question &q : questions)
            found.push_back({q.place, directory_[static_cast<std::size_t>(q.dof - first_)]});
    });
    const std::vector<Answer> answers = deliver(team, found, asker);
    std::vector<int> owner;
    team.together([&] {
        owner.resize(dofs.size());
        for (const Answer &a : answers) owner[static_cast<std::size_t>(a.place)] = a.owner;
    });
    return owner;
}

} // namespace plm::mpi
