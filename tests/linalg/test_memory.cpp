// The context allocator: alignment, origin of blocks, and what happens when it fails.
#include "linalg/lapack.hpp"
#include "support.hpp"
#include <cerrno>
#include <cstring>
#include <thread>

using namespace test;

namespace {

struct Counter {
    long made = 0, freed = 0;
    long fail_at = -1; // number of the allocation that fails
};

void *count_allocate(std::size_t bytes, void *user) {
    auto &c = *static_cast<Counter *>(user);
    if (c.made == c.fail_at) return nullptr;
    ++c.made;
    return std::malloc(bytes);
}
void count_release(void *block, void *user) {
    ++static_cast<Counter *>(user)->freed;
    std::free(block);
}
plm::Allocator counting(Counter &c) {
    return {count_allocate, count_release, &c};
}

void blocks_are_aligned_to_64_bytes(void **) {
    bool aligned = true;
    for (std::size_t bytes : {0u, 1u, 63u, 64u, 1000u}) {
        void *block = plm::allocate_block(bytes);
        aligned = aligned && reinterpret_cast<std::uintptr_t>(block) % 64 == 0;
        std::memset(block, 1, bytes);
        plm::release_block(block);
    }
    plm::release_block(nullptr);
    assert_true(aligned);
}

void a_block_returns_to_its_maker_on_any_thread_after_the_scope(void **) {
    Counter first, second;
    {
        vector<double> data;
        {
            const plm::Allocator a = counting(first);
            const plm::AllocatorScope scope(&a);
            data.resize(100);
            const plm::Allocator b = counting(second);
            const plm::AllocatorScope inner(&b);
            vector<int> other(3);
        }
        std::thread([moved = std::move(data)]() mutable { vector<double>().swap(moved); }).join();
    }
    assert_int_equal(first.made, 1);
    assert_int_equal(first.freed, 1);
    assert_int_equal(second.made, 1);
    assert_int_equal(second.freed, 1);
}

void other_threads_and_later_code_use_malloc(void **) {
    Counter c;
    const plm::Allocator a = counting(c);
    {
        const plm::AllocatorScope scope(&a);
        std::thread([] { vector<double> v(10); }).join();
    }
    { vector<double> v(10); }
    assert_int_equal(c.made, 0);
}

// Large pages are asked for; what the system answers is nothing of the host's.
void a_large_block_leaves_errno_alone(void **) {
    constexpr std::size_t bytes = std::size_t(48) << 20;
    errno = 7;
    auto *block = static_cast<char *>(plm::allocate_block(bytes));
    const int after = errno;
    block[0] = block[bytes - 1] = 1;
    plm::release_block(block);
    assert_int_equal(after, 7);
}

void absurd_sizes_are_refused(void **) {
    const auto huge = outcome_of([] { plm::release_block(plm::allocate_block(SIZE_MAX - 10)); });
    const auto negative = outcome_of([] { Matrix().reset(-1, 3); });
    const auto overflow = outcome_of([] { Matrix().reset(INT64_MAX / 2, 3); });
    assert_int_equal(huge.status, bad_alloc);
    assert_int_equal(negative.status, plm::status::internal);
    assert_int_equal(overflow.status, plm::status::internal);
}

/// Runs a task that allocates in many places with each of its allocations failing in turn.
void every_failing_allocation_is_bad_alloc_and_leaks_nothing(void **) {
    long wrong_status = 0, leaks = 0, rounds = 0;
    for (;; ++rounds) {
        Counter c;
        c.fail_at = rounds;
        const plm::Allocator a = counting(c);
        Outcome o;
        {
            const plm::AllocatorScope scope(&a);
            o = outcome_of([] {
                const Matrix k = random_definite_dense(12, 7);
                plm::symmetric_eigen_below(k.transposed(), 1.0);
                Matrix work = k, x = plm::thin_svd(k).u;
                plm::DenseCholesky cholesky;
                cholesky.factor(work);
                cholesky.solve(x.data(), x.cols(), x.rows());
            });
        }
        leaks += c.made != c.freed;
        if (o.status == plm::status::ok || rounds > 1000) break;
        wrong_status += o.status != bad_alloc;
    }
    assert_int_equal(wrong_status, 0);
    assert_int_equal(leaks, 0);
    assert_in_range(rounds, 10, 500);
}

void repeated_lu_of_one_size_allocates_nothing(void **) {
    Counter c;
    const plm::Allocator a = counting(c);
    long before = 0, after = 0;
    {
        const plm::AllocatorScope scope(&a);
        plm::RealLu lu;
        const Matrix original = random_matrix(60, 60, 1);
        Matrix work = original;
        vector<double> x(180, 1.0);
        for (int round = 0; round < 5; ++round) {
            work.reset(60, 60);
            std::copy_n(original.data(), 3600, work.data());
            lu.factor(work);
            lu.solve(x.data(), 3, 60);
            if (round == 1) before = c.made; // the first round swapped an empty matrix back
        }
        after = c.made;
    }
    assert_int_equal(before, after);
    assert_int_equal(c.made, c.freed);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_aligned_to_64_bytes),
        cmocka_unit_test(a_block_returns_to_its_maker_on_any_thread_after_the_scope),
        cmocka_unit_test(other_threads_and_later_code_use_malloc),
        cmocka_unit_test(a_large_block_leaves_errno_alone),
        cmocka_unit_test(absurd_sizes_are_refused),
        cmocka_unit_test(every_failing_allocation_is_bad_alloc_and_leaks_nothing),
        cmocka_unit_test(repeated_lu_of_one_size_allocates_nothing),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
