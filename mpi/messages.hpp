// Lists whose items go to other ranks, each to its own.
#pragma once
#include "mpi/team.hpp"
#include <climits>
#include <vector>

namespace plm::mpi {

/// Starts of runs from their lengths; throws where all of them together are more than MPI can count.
inline std::vector<int> run_starts(const std::vector<int> &count) {
    std::vector<int> start(count.size() + 1, 0);
    std::int64_t sum = 0;
    for (std::size_t r = 0; r < count.size(); ++r) {
        sum += count[r];
        if (sum > INT_MAX)
            throw Error(status::memory, "more than 2147483647 items on one rank; use more ranks");
        start[r + 1] = static_cast<int>(sum);
    }
    return start;
}

/// items[k] goes to rank to[k]. What comes, in the order of the senders; `from` (or null): the sender of
/// each. Collective; throws on all ranks alike.
template <class T>
std::vector<T> deliver(Team &team, const std::vector<T> &items, const std::vector<int> &to,
                       std::vector<int> *from = nullptr) {
    std::vector<int> send, receive, send_start, receive_start;
    std::vector<T> out, in;
    team.together([&] {
        send.assign(static_cast<std::size_t>(team.size()), 0), receive = send;
        for (int rank : to) ++send[static_cast<std::size_t>(rank)];
        send_start = run_starts(send);
        out.resize(items.size());
        std::vector<int> place = send_start;
        for (std::size_t k = 0; k < items.size(); ++k)
            out[static_cast<std::size_t>(place[static_cast<std::size_t>(to[k])]++)] = items[k];
    });
    require_mpi(MPI_Alltoall(send.data(), 1, MPI_INT, receive.data(), 1, MPI_INT, team.comm()),
                "MPI_Alltoall");
    team.together([&] {
        receive_start = run_starts(receive);
        in.resize(static_cast<std::size_t>(receive_start.back()));
        if (!from) return;
        from->resize(in.size());
        for (std::size_t r = 0; r < receive.size(); ++r)
            for (int k = receive_start[r]; k < receive_start[r + 1]; ++k)
                (*from)[static_cast<std::size_t>(k)] = static_cast<int>(r);
    });
    MPI_Datatype item;
    MPI_Type_contiguous(static_cast<int>(sizeof(T)), MPI_BYTE, &item);
    MPI_Type_commit(&item);
    const int code = MPI_Alltoallv(out.data(), send.data(), send_start.data(), item, in.data(),
                                   receive.data(), receive_start.data(), item, team.comm());
    MPI_Type_free(&item);
    require_mpi(code, "MPI_Alltoallv");
    return in;
}

} // namespace plm::mpi
