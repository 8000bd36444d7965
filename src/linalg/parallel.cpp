#include "linalg/parallel.hpp"
#include "linalg/blas_host.hpp"
#include "linalg/memory.hpp"
#include "linalg/work.hpp"
#include <algorithm>
#include <atomic>
#include <cfenv>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>
#if defined(__unix__) || defined(__APPLE__)
#include <csignal>
#endif

namespace plm {
namespace {

// initial-exec: as in memory.cpp
[[gnu::tls_model("initial-exec")]] thread_local std::int64_t allowed = 1;

/// Threads made meanwhile receive no signal of the host's: its handlers run on its own threads.
class SignalsBlocked {
  public:
#if defined(__unix__) || defined(__APPLE__)
    SignalsBlocked() {
        sigset_t all;
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~SignalsBlocked() {
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

  private:
    sigset_t before_;
#endif
};

/// The pieces of one parallel_for(), handed out in their order.
class Pieces {
  public:
    Pieces(std::int64_t count, Piecework work) : count_(count), work_(work) {}

    void work() {
        const ThreadsScope one(1);
        const WorkCount mine;
        while (!failed_) {
            const std::int64_t i = next_++;
            if (i >= count_) break;
            try {
                work_.call(work_.body, i);
            } catch (...) {
                keep(i, std::current_exception());
            }
        }
        done_ += mine.so_far();
    }

    /// On a thread of its own: no exception leaves it, and without a buffer for BLAS it does nothing.
    void help() noexcept {
        try {
            std::fesetenv(FE_DFL_ENV);
            const BlasBuffer buffer;
            work();
        } catch (...) { // no memory for the buffer: the others do the work
        }
    }

    void finish() const {
        if (error_) std::rethrow_exception(error_);
        add_work(done_);
    }

  private:
    // Whatever is below the piece that failed has begun, and is waited for: the lowest is the same every
    // time.
    void keep(std::int64_t i, std::exception_ptr error) {
        const std::lock_guard<std::mutex> lock(mutex_);
        failed_ = true;
        if (error_ && i > failed_piece_) return;
        failed_piece_ = i, error_ = std::move(error);
    }

    const std::int64_t count_;
    const Piecework work_;
    std::atomic<std::int64_t> next_{0}, done_{0};
    std::atomic<bool> failed_{false};
    std::mutex mutex_;
    std::int64_t failed_piece_ = 0;
    std::exception_ptr error_;
};

/// Threads that help, joined at the end of the scope.
class Helpers {
  public:
    Helpers(Pieces &pieces, std::int64_t count) {
        const SignalsBlocked blocked;
        try {
            threads_.reserve(static_cast<std::size_t>(count));
            while (static_cast<std::int64_t>(threads_.size()) < count)
                threads_.emplace_back([&pieces] { pieces.help(); });
        } catch (const std::system_error &) { // no more threads
        } catch (const std::bad_alloc &) {
        }
    }
    ~Helpers() {
        for (std::thread &t : threads_) t.join();
    }
    Helpers(const Helpers &) = delete;
    Helpers &operator=(const Helpers &) = delete;

  private:
    std::vector<std::thread> threads_;
};

} // namespace

ThreadsScope::ThreadsScope(std::int64_t count) : previous_(allowed) {
    allowed = count;
}
ThreadsScope::~ThreadsScope() {
    allowed = previous_;
}

std::int64_t threads_at_hand() {
    const Allocator *allocator = active_allocator();
    return allocator && allocator->allocate ? 1 : allowed;
}

void share_out(std::int64_t count, Piecework work) {
    const std::int64_t threads = std::min(count, threads_at_hand());
    if (threads <= 1) {
        for (std::int64_t i = 0; i < count; ++i) work.call(work.body, i);
        return;
    }
    Pieces pieces(count, work);
    {
        const Helpers helpers(pieces, threads - 1);
        pieces.work();
    }
    pieces.finish();
}

} // namespace plm
