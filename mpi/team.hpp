// The ranks of a communicator that work as one: what they tell each other, and how they agree on whether a
// step went well. Whatever fails on one rank fails on all, with one status, and nobody is left waiting.
#pragma once
#include "linalg/error.hpp"
#include <cstddef>
#include <exception>
#include <mpi.h>
#include <new>

namespace plm::mpi {

/// What all ranks know of a step that failed.
struct Verdict {
    Status status = status::ok;
    int rank = -1; // that failed; of several with this status the first
    std::int64_t index = -1;
    std::int64_t library_code = 0;
    char argument[32] = "";
    char text[480] = "";
};

/// What agree() throws. It takes no memory but its own, so that it is the same on a rank that has none.
class AgreedFailure : public std::exception {
  public:
    explicit AgreedFailure(const Verdict &verdict) : verdict_(verdict) {}
    const char *what() const noexcept override { return verdict_.text; }
    const Verdict &verdict() const { return verdict_; }

  private:
    Verdict verdict_;
};

/// Throws where a code of MPI's is an error.
void require_mpi(int code, const char *what);

class Team {
  public:
    Team() = default;
    /// Collective: duplicates the communicator, so that no message of the host's meets one of the team's.
    /// mine: what has befallen this rank so far; with a failure on one there is no team on any.
    void start(MPI_Comm host, const Verdict &mine);
    Team(const Team &) = delete;
    Team &operator=(const Team &) = delete;
    /// Gives the communicator back. Collective, therefore no part of a destructor: ranks that leave a step by
    /// different ways destroy things at different times.
    void close();

    int rank() const { return rank_; }
    int size() const { return size_; }
    bool is_brain() const { return rank_ == 0; }
    MPI_Comm comm() const { return comm_; }

    /// From the brain to all. Those who wait sleep, as the brain may be at work for minutes.
    void hear(void *data, std::size_t bytes);

    /// Runs what this rank does alone and may fail at; then all agree. Throws on every rank where it failed
    /// on one.
    template <class Work> void together(Work work) {
        Verdict mine;
        try {
            work();
        } catch (...) {
            mine = describe_failure();
        }
        agree(mine);
    }
    /// All come here with what befell each; the worst is everybody's: AgreedFailure on all ranks alike.
    void agree(const Verdict &mine);
    /// Of the exception being handled. From a catch block alone.
    static Verdict describe_failure() noexcept;

    /// Sums of n numbers over the ranks, on the brain.
    void sum_to_brain(double *x, std::size_t n);
    double sum(double x);
    std::int64_t sum(std::int64_t x);
    double largest(double x);

  private:
    MPI_Comm comm_ = MPI_COMM_NULL;
    int rank_ = 0, size_ = 1;
    std::int64_t meetings_ =
        0; // agreements so far, the same number on all ranks or they have gone different ways
};

} // namespace plm::mpi
