// Work shared out among threads: every piece once, the exception of a loop, nothing of the host's elsewhere.
#include "linalg/error.hpp"
#include "linalg/memory.hpp"
#include "linalg/parallel.hpp"
#include "linalg/work.hpp"
#include "support.hpp"
#include <atomic>
#include <chrono>
#include <csignal>
#include <pthread.h>
#include <thread>

using namespace test;

namespace {

constexpr std::int64_t pieces = 200;

void every_piece_is_done_once(void **) {
    for (std::int64_t threads : {1, 2, 3, 7}) {
        const plm::ThreadsScope scope(threads);
        std::vector<std::atomic<int>> done(pieces);
        std::atomic<int> nested{0};
        plm::parallel_for(pieces, [&](std::int64_t i) {
            ++done[static_cast<std::size_t>(i)];
            nested += threads > 1 && plm::threads_at_hand() != 1;
        });
        for (const auto &times : done) assert_int_equal(times.load(), 1);
        assert_int_equal(nested.load(), 0); // a piece shares nothing out again
        assert_int_equal(plm::threads_at_hand(), threads);
    }
    plm::parallel_for(0, [](std::int64_t) { std::abort(); });
}

// Two pieces wait for each other: they are on two threads at once, of which the second hears no signal.
void two_threads_work_at_once(void **) {
    const plm::ThreadsScope scope(2);
    std::atomic<int> here{0}, met{0}, hears{0};
    const std::thread::id mine = std::this_thread::get_id();
    plm::parallel_for(2, [&](std::int64_t) {
        ++here;
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (here < 2 && std::chrono::steady_clock::now() < until) std::this_thread::yield();
        met += here == 2;
        if (std::this_thread::get_id() == mine) return;
        sigset_t blocked;
        pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
        hears += sigismember(&blocked, SIGALRM) != 1;
    });
    assert_int_equal(here.load(), 2);
    assert_int_equal(met.load(), 2);
    assert_int_equal(hears.load(), 0);
    sigset_t blocked;
    pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
    assert_int_equal(sigismember(&blocked, SIGALRM), 0); // the host's mask is as it was
}

void the_exception_is_that_of_a_loop(void **) {
    for (int round = 0; round < 50; ++round) {
        const plm::ThreadsScope scope(3);
        const auto o = outcome_of([&] {
            plm::parallel_for(pieces, [](std::int64_t i) {
                if (i >= 20) throw plm::Error(plm::status::singular, "piece").index(i);
            });
        });
        assert_int_equal(o.status, plm::status::singular);
        assert_int_equal(o.index, 20);
    }
}

struct Stop final : plm::WorkListener {
    const std::thread::id mine = std::this_thread::get_id();
    std::atomic<int> calls{0}, elsewhere{0};
    bool goes_on() override {
        elsewhere += std::this_thread::get_id() != mine;
        return ++calls >= 2;
    }
};

// The host is heard on its own thread, and may stop all.
void the_listener_is_called_on_its_thread(void **) {
    Stop stop;
    const plm::ThreadsScope scope(2);
    const plm::WorkScope listening(&stop);
    std::atomic<std::int64_t> done{0};
    const auto o = outcome_of([&] {
        plm::parallel_for(1000000, [&](std::int64_t) {
            ++done;
            plm::worked(plm::piece_of_work);
        });
    });
    assert_int_equal(o.status, plm::status::cancelled);
    assert_int_equal(stop.elsewhere.load(), 0);
    assert_true(done < 1000000);
}

// An allocator of the host's is called by one thread.
void a_host_with_an_allocator_has_one_thread(void **) {
    static std::thread::id mine;
    static std::atomic<int> elsewhere;
    mine = std::this_thread::get_id(), elsewhere = 0;
    const plm::Allocator allocator{[](std::size_t bytes, void *) {
                                       elsewhere += std::this_thread::get_id() != mine;
                                       return std::malloc(bytes);
                                   },
                                   [](void *block, void *) { std::free(block); }, nullptr};
    const plm::AllocatorScope memory(&allocator);
    const plm::ThreadsScope scope(4);
    assert_int_equal(plm::threads_at_hand(), 1);
    plm::parallel_for(pieces, [](std::int64_t) { plm::vector<double> some(1000); });
    assert_int_equal(elsewhere.load(), 0);
}

// Also where a piece further on has failed before it.
void the_first_piece_that_fails_is_told_whichever_was_the_faster(void **) {
    const plm::ThreadsScope scope(2);
    std::atomic<bool> begun{false}, fails{false};
    const auto o = outcome_of([&] {
        plm::parallel_for(2, [&](std::int64_t i) {
            const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(30);
            (i == 0 ? begun : fails) = true;
            while (!(i == 0 ? fails : begun) && std::chrono::steady_clock::now() < until)
                std::this_thread::yield();
            if (i == 0) std::this_thread::sleep_for(std::chrono::milliseconds(50)); // the other is through
            throw plm::Error(plm::status::singular, "piece").index(i);
        });
    });
    assert_int_equal(o.status, plm::status::singular);
    assert_int_equal(o.index, 0);
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_piece_is_done_once),
        cmocka_unit_test(two_threads_work_at_once),
        cmocka_unit_test(the_exception_is_that_of_a_loop),
        cmocka_unit_test(the_listener_is_called_on_its_thread),
        cmocka_unit_test(a_host_with_an_allocator_has_one_thread),
        cmocka_unit_test(the_first_piece_that_fails_is_told_whichever_was_the_faster),
    };
    return cmocka_run_group_tests_name("parallel", tests, nullptr, nullptr);
}
