// Independent pieces of work on several threads, with the digits of one thread.
#pragma once
#include <cstdint>

namespace plm {

/// How many threads work on this one may use, itself among them, for the life of the scope.
class ThreadsScope {
  public:
    explicit ThreadsScope(std::int64_t count);
    ~ThreadsScope();
    ThreadsScope(const ThreadsScope &) = delete;
    ThreadsScope &operator=(const ThreadsScope &) = delete;

  private:
    std::int64_t previous_;
};

/// The number of pieces that parallel_for() would work on at once, here and now. 1 outside of any scope,
/// inside of a piece, and where an allocator is active: the host's is called on the host's thread alone, and
/// a count of memory counts one.
std::int64_t threads_at_hand();

/// A function of i, elsewhere.
struct Piecework {
    void (*call)(const void *body, std::int64_t i);
    const void *body;
};
void share_out(std::int64_t count, Piecework work);

/// body(i) for i = 0 .. count - 1, each once, this thread taking part; back when all are done, and no thread
/// is left. What a piece computes must follow from i alone. Then so do all results, and the exception: that
/// of the lowest i, at which a loop would have stopped; pieces above it may have run. A piece must call
/// nothing of the host's: no Watch, no factor that calls_host(); worked() is heard from this thread only.
/// Where threads cannot be had there are fewer.
template <class Body> void parallel_for(std::int64_t count, const Body &body) {
    share_out(count, {[](const void *b, std::int64_t i) { (*static_cast<const Body *>(b))(i); }, &body});
}

/// What threads are worth: they are made for each parallel_for().
constexpr double worth_threads = 1e7; // flops, half a millisecond or so

/// The same where all pieces together are worth threads; else a loop, with the same digits.
template <class Body> void parallel_for(std::int64_t count, double flops, const Body &body) {
    if (flops > worth_threads) return parallel_for(count, body);
    for (std::int64_t i = 0; i < count; ++i) body(i);
}

} // namespace plm
