#include "mpi/team.hpp"
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace plm::mpi {
namespace {

void copy_text(char *to, std::size_t room, const char *from) {
    std::strncpy(to, from, room - 1);
    to[room - 1] = '\0';
}

/// Naps that grow to a millisecond: steps that follow each other are heard within microseconds, and a long
/// wait costs nothing. Blocking calls of MPI keep a core busy all the time, which the brain needs itself.
void wait_asleep(MPI_Request &request) {
    long nap = 0;
    for (int polls = 0;; ++polls) {
        int done = 0;
        require_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
        if (done) return;
        if (polls < 200) continue;
        nap = std::min(nap + nap / 2 + 1000, 1000000L);
        const timespec pause{0, nap};
        nanosleep(&pause, nullptr);
    }
}

constexpr std::size_t most_at_once = std::size_t(1) << 30; // counts of MPI are int

} // namespace

void require_mpi(int code, const char *what) {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw Error(status::internal, format("%s failed: %s", what, text)).library_code(code);
}

void Team::start(MPI_Comm host, const Verdict &mine) {
    MPI_Comm_rank(host, &rank_);
    MPI_Comm_size(host, &size_);
    comm_ = host;
    try {
        agree(mine);
    } catch (...) {
        comm_ = MPI_COMM_NULL;
        throw;
    }
    comm_ = MPI_COMM_NULL;
    require_mpi(MPI_Comm_dup(host, &comm_), "MPI_Comm_dup");
    MPI_Comm_set_errhandler(comm_, MPI_ERRORS_RETURN); // the host's handler may end the process
}

void Team::close() {
    if (comm_ != MPI_COMM_NULL) MPI_Comm_free(&comm_);
}

void Team::hear(void *data, std::size_t bytes) {
    for (std::size_t done = 0; done < bytes;) {
        const std::size_t part = std::min(bytes - done, most_at_once);
        MPI_Request request;
        require_mpi(MPI_Ibcast(static_cast<char *>(data) + done, static_cast<int>(part), MPI_BYTE, 0, comm_,
                               &request),
                    "MPI_Ibcast");
        wait_asleep(request);
        done += part;
    }
}

Verdict Team::describe_failure() noexcept {
    Verdict v;
    try {
        throw;
    } catch (const AgreedFailure &agreed) {
        return agreed.verdict();
    } catch (const Error &e) {
        v.status = e.status(), v.index = e.index(), v.library_code = e.library_code();
        copy_text(v.argument, sizeof v.argument, e.argument().c_str());
        copy_text(v.text, sizeof v.text, e.what());
    } catch (const std::bad_alloc &) {
        v.status = status::memory;
        copy_text(v.text, sizeof v.text, "out of memory; use more ranks or nodes with more memory");
    } catch (const std::exception &e) {
        v.status = status::internal;
        copy_text(v.text, sizeof v.text, e.what());
    } catch (...) {
        v.status = status::internal;
        copy_text(v.text, sizeof v.text, "an unknown exception; please report this");
    }
    return v;
}

void Team::agree(const Verdict &mine) {
    // The least status and, of its ranks, the first; the number of the meeting from both ends, which differ
    // where ranks have come here by different ways.
    const std::int64_t key =
        std::int64_t(std::min<Status>(mine.status, status::ok)) * (std::int64_t(1) << 32) + rank_;
    std::int64_t told[3] = {key, meetings_, -meetings_}, least[3] = {};
    ++meetings_;
    require_mpi(MPI_Allreduce(told, least, 3, MPI_INT64_T, MPI_MIN, comm_), "MPI_Allreduce");
    const bool parted = least[1] != -least[2];
    if (!parted && least[0] >= 0) return;
    Verdict all = mine;
    if (parted) {
        all = Verdict();
        all.status = status::internal;
        copy_text(all.text, sizeof all.text, "the ranks went different ways; please report this");
        throw AgreedFailure(all);
    }
    const int rank = static_cast<int>(least[0] & 0xffffffff);
    require_mpi(MPI_Bcast(&all, sizeof all, MPI_BYTE, rank, comm_), "MPI_Bcast");
    all.rank = rank;
    if (size_ > 1 && std::strncmp(all.text, "rank ", 5) != 0) {
        Verdict named = all;
        std::snprintf(named.text, sizeof named.text, "rank %d: %.*s", rank,
                      static_cast<int>(sizeof named.text) - 20, all.text);
        throw AgreedFailure(named);
    }
    throw AgreedFailure(all);
}

void Team::sum_to_brain(double *x, std::size_t n) {
    for (std::size_t done = 0; done < n;) {
        const int part = static_cast<int>(std::min(n - done, most_at_once / 8));
        double *here = x + done;
        require_mpi(is_brain() ? MPI_Reduce(MPI_IN_PLACE, here, part, MPI_DOUBLE, MPI_SUM, 0, comm_)
                               : MPI_Reduce(here, nullptr, part, MPI_DOUBLE, MPI_SUM, 0, comm_),
                    "MPI_Reduce");
        done += static_cast<std::size_t>(part);
    }
}

double Team::sum(double x) {
    double s = 0;
    require_mpi(MPI_Allreduce(&x, &s, 1, MPI_DOUBLE, MPI_SUM, comm_), "MPI_Allreduce");
    return s;
}
std::int64_t Team::sum(std::int64_t x) {
    std::int64_t s = 0;
    require_mpi(MPI_Allreduce(&x, &s, 1, MPI_INT64_T, MPI_SUM, comm_), "MPI_Allreduce");
    return s;
}
double Team::largest(double x) {
    double most = 0;
    require_mpi(MPI_Allreduce(&x, &most, 1, MPI_DOUBLE, MPI_MAX, comm_), "MPI_Allreduce");
    return most;
}

} // namespace plm::mpi
