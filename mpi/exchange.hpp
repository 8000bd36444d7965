// A plan by which rows of tall columns go from rank to rank, made once and run for every block of columns.
#pragma once
#include "mpi/rows.hpp"

namespace plm::mpi {

class Exchange {
  public:
    /// Columns that go at once; the buffers are made for so many with the plan, so that running it cannot
    /// fail for want of memory.
    static constexpr std::int64_t width = 32;

    Exchange() = default;
    /// Collective. Owners send what is needed here: row k of the result is the DOF needed[k].
    static Exchange pull(Team &team, const Rows &rows, const std::vector<std::int64_t> &needed);
    /// Collective. Row k here is the DOF held[k], which goes to its owner: rows of the result are local rows.
    static Exchange push(Team &team, const Rows &rows, const std::vector<std::int64_t> &held);

    /// Collective; cols at most `width`. Both column-major with their leading dimensions.
    void run(Team &team, std::int64_t cols, const double *from, std::int64_t ld_from, double *to,
             std::int64_t ld_to);

  private:
    struct Side { // for each partner its rows
        std::vector<int> rank;
        std::vector<std::int64_t> start, row; // of a plan not made: empty, and nothing that could fail
        std::vector<double> buffer;
    };
    static Side side(const std::vector<int> &rank, const std::vector<std::int64_t> &row, int size);
    void make_buffers();

    Side send_, receive_;
    std::vector<MPI_Request> requests_;
};

} // namespace plm::mpi
