// The context allocator: alignment, origin of blocks, and what happens when it fails.
#include "linalg/lapack.hpp"
#include "support.hpp"
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

void absurd_sizes_are_refused(void **) {
    const auto huge = outcome_of([] { plm::release_block(plm::allocate_block(SIZE_MAX - 10)); });
    const auto negative = outcome_of([] { Matrix().reset(-1, 3); });
    const auto overflow = outcome_of([] { Matrix().reset(INT64_MAX / 2, 3); });
    assert_int_equal(huge.status, bad_alloc);
    assert_int_equal(negative.status, PLM_ERR_INTERNAL);
    assert_int_equal(overflow.status, PLM_ERR_INTERNAL);
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
        if (o.status == PLM_OK || rounds > 1000) break;
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

constexpr std::size_t large = std::size_t(1) << 20;

// A block of the same size, or a little less, is the one released before; a small one, or one of half the
// size, is not. Of the host's allocator and of malloc's alike all go back at the end.
void large_blocks_serve_again_and_are_given_back(void **) {
    Counter c;
    const plm::Allocator a = counting(c);
    {
        const plm::AllocatorScope scope(&a);
        const plm::SpareBlocksScope spare;
        void *first = plm::allocate_block(large);
        plm::release_block(first);
        void *small = plm::allocate_block(large / 2 - 1), *again = plm::allocate_block(large - 100);
        assert_ptr_equal(again, first);
        assert_int_equal(reinterpret_cast<std::uintptr_t>(again) % 64, 0);
        assert_ptr_not_equal(small, first);
        assert_int_equal(c.made, 2);
        plm::release_block(small);
        plm::release_block(again);
        void *tiny = plm::allocate_block(1000);
        plm::release_block(tiny);
        assert_int_equal(c.freed, 1);
    }
    assert_int_equal(c.made, c.freed);
}

void no_more_is_kept_than_the_limits_say(void **) {
    Counter c;
    const plm::Allocator a = counting(c);
    const plm::AllocatorScope scope(&a);
    {
        const plm::SpareBlocksScope spare;
        void *block[12];
        for (void *&b : block) b = plm::allocate_block(large);
        for (void *b : block) plm::release_block(b);
        assert_int_equal(c.made - c.freed, plm::SpareBlocksScope::most_blocks);
        void *huge = plm::allocate_block(plm::SpareBlocksScope::most_bytes);
        plm::release_block(huge); // fills it alone
        assert_int_equal(c.made - c.freed, 1);
    }
    assert_int_equal(c.made, c.freed);
}

// Each allocator gets its own blocks back, those made before the scope and after an inner one, too.
void allocators_do_not_get_each_others_blocks(void **) {
    Counter one, other;
    const plm::Allocator a = counting(one), b = counting(other);
    {
        const plm::AllocatorScope scope(&a);
        const plm::SpareBlocksScope spare;
        plm::release_block(plm::allocate_block(large));
        const plm::AllocatorScope inner(&b);
        void *others = plm::allocate_block(large);
        plm::release_block(others);
        assert_int_equal(other.freed, 1);
        const plm::SpareBlocksScope nested;
        plm::release_block(plm::allocate_block(large));
    }
    assert_int_equal(one.made, one.freed);
    assert_int_equal(other.made, other.freed);
    assert_int_equal(one.made, 1);
}

void spare_blocks_are_given_back_before_an_allocation_fails(void **) {
    struct Limited {
        std::size_t left = 3 * large, held = 0;
    } limited;
    struct Block {
        static void *allocate(std::size_t bytes, void *user) {
            auto &l = *static_cast<Limited *>(user);
            if (l.held + bytes > l.left) return nullptr;
            auto *raw = static_cast<std::size_t *>(std::malloc(bytes + 64));
            l.held += *raw = bytes;
            return raw + 8;
        }
        static void release(void *block, void *user) {
            std::size_t *raw = static_cast<std::size_t *>(block) - 8;
            static_cast<Limited *>(user)->held -= *raw;
            std::free(raw);
        }
    };
    const plm::Allocator a{Block::allocate, Block::release, &limited};
    const plm::AllocatorScope scope(&a);
    {
        const plm::SpareBlocksScope spare;
        plm::release_block(plm::allocate_block(large));
        void *most = plm::allocate_block(5 * large / 2);
        const Outcome too_much = outcome_of([] { plm::release_block(plm::allocate_block(large)); });
        assert_int_equal(too_much.status, bad_alloc);
        plm::release_block(most);
    }
    assert_int_equal(limited.held, 0);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(blocks_are_aligned_to_64_bytes),
        cmocka_unit_test(a_block_returns_to_its_maker_on_any_thread_after_the_scope),
        cmocka_unit_test(other_threads_and_later_code_use_malloc),
        cmocka_unit_test(absurd_sizes_are_refused),
        cmocka_unit_test(every_failing_allocation_is_bad_alloc_and_leaks_nothing),
        cmocka_unit_test(repeated_lu_of_one_size_allocates_nothing),
#ifndef __SANITIZE_ADDRESS__ // where none is kept
        cmocka_unit_test(large_blocks_serve_again_and_are_given_back),
        cmocka_unit_test(no_more_is_kept_than_the_limits_say),
#endif
        cmocka_unit_test(allocators_do_not_get_each_others_blocks),
        cmocka_unit_test(spare_blocks_are_given_back_before_an_allocation_fails),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
