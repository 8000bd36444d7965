#include "mpi/exchange.hpp"
#include <algorithm>
#include <numeric>

namespace plm::mpi {
namespace {

constexpr int tag = 1;

/// MPI counts in int: a message carries this many numbers at most.
void require_countable(std::int64_t rows) {
    if (rows > INT_MAX / Exchange::width)
        throw Error(status::memory, "too many DOFs are shared between two ranks; use more ranks");
}

} // namespace

/// Rows by partner; within one in the order given, which both partners know.
Exchange::Side Exchange::side(const std::vector<int> &rank, const std::vector<std::int64_t> &row, int size) {
    Side s;
    s.start.push_back(0);
    std::vector<std::int64_t> count(static_cast<std::size_t>(size) + 1, 0);
    for (int r : rank) ++count[static_cast<std::size_t>(r) + 1];
    for (int r = 0; r < size; ++r) {
        require_countable(count[static_cast<std::size_t>(r) + 1]);
        if (count[static_cast<std::size_t>(r) + 1] == 0) continue;
        s.rank.push_back(r);
        s.start.push_back(s.start.back() + count[static_cast<std::size_t>(r) + 1]);
    }
    std::partial_sum(count.begin(), count.end(), count.begin());
    s.row.resize(row.size());
    for (std::size_t k = 0; k < row.size(); ++k)
        s.row[static_cast<std::size_t>(count[static_cast<std::size_t>(rank[k])]++)] = row[k];
    return s;
}

void Exchange::make_buffers() {
    for (Side *s : {&send_, &receive_}) s->buffer.resize(s->row.size() * width);
    requests_.resize(send_.rank.size() + receive_.rank.size());
}

Exchange Exchange::pull(Team &team, const Rows &rows, const std::vector<std::int64_t> &needed) {
    const std::vector<int> owner = rows.owners_of(team, needed);
    std::vector<int> asker;
    const std::vector<std::int64_t> asked = deliver(team, needed, owner, &asker);
    Exchange plan;
    team.together([&] {
        std::vector<std::int64_t> mine, place(needed.size());
        for (std::int64_t dof : asked) mine.push_back(rows.local(dof));
        std::iota(place.begin(), place.end(), 0);
        plan.send_ = side(asker, mine, team.size());
        plan.receive_ = side(owner, place, team.size());
        plan.make_buffers();
    });
    return plan;
}

Exchange Exchange::push(Team &team, const Rows &rows, const std::vector<std::int64_t> &held) {
    const std::vector<int> owner = rows.owners_of(team, held);
    std::vector<int> sender;
    const std::vector<std::int64_t> coming = deliver(team, held, owner, &sender);
    Exchange plan;
    team.together([&] {
        std::vector<std::int64_t> mine, place(held.size());
        for (std::int64_t dof : coming) mine.push_back(rows.local(dof));
        std::iota(place.begin(), place.end(), 0);
        plan.send_ = side(owner, place, team.size());
        plan.receive_ = side(sender, mine, team.size());
        plan.make_buffers();
    });
    return plan;
}

void Exchange::run(Team &team, std::int64_t cols, const double *from, std::int64_t ld_from, double *to,
                   std::int64_t ld_to) {
    MPI_Request *request = requests_.data();
    const auto message = [&](Side &s, std::size_t p, auto transfer) {
        const std::int64_t rows = s.start[p + 1] - s.start[p];
        transfer(s.buffer.data() + s.start[p] * width, static_cast<int>(rows * cols), s.rank[p]);
    };
    for (std::size_t p = 0; p < receive_.rank.size(); ++p)
        message(receive_, p, [&](double *buffer, int n, int rank) {
            require_mpi(MPI_Irecv(buffer, n, MPI_DOUBLE, rank, tag, team.comm(), request++), "MPI_Irecv");
        });
    for (std::size_t p = 0; p < send_.rank.size(); ++p) {
        double *buffer = send_.buffer.data() + send_.start[p] * width;
        for (std::int64_t j = 0; j < cols; ++j)
            for (std::int64_t k = send_.start[p]; k < send_.start[p + 1]; ++k)
                *buffer++ = from[send_.row[static_cast<std::size_t>(k)] + j * ld_from];
        message(send_, p, [&](double *b, int n, int rank) {
            require_mpi(MPI_Isend(b, n, MPI_DOUBLE, rank, tag, team.comm(), request++), "MPI_Isend");
        });
    }
    require_mpi(MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE),
                "MPI_Waitall");
    for (std::size_t p = 0; p < receive_.rank.size(); ++p) {
        const double *buffer = receive_.buffer.data() + receive_.start[p] * width;
        for (std::int64_t j = 0; j < cols; ++j)
            for (std::int64_t k = receive_.start[p]; k < receive_.start[p + 1]; ++k)
                to[receive_.row[static_cast<std::size_t>(k)] + j * ld_to] = *buffer++;
    }
}

} // namespace plm::mpi
