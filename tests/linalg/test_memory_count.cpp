// The count of memory: what is held, the most held at once, who it forwards to, and that it falls back to
// zero.
#include "linalg/memory_count.hpp"
#include "support.hpp"
#include <thread>

using namespace test;

namespace {

struct Host {
    long made = 0, freed = 0, fail_at = -1;
};
void *host_allocate(std::size_t bytes, void *user) {
    auto &h = *static_cast<Host *>(user);
    if (h.made == h.fail_at) return nullptr;
    ++h.made;
    return std::malloc(bytes);
}
void host_release(void *block, void *user) {
    ++static_cast<Host *>(user)->freed;
    std::free(block);
}

// A block has at most this much around it: its header and the alignment.
constexpr std::int64_t around = 200;

void held_and_peak_follow_the_arrays(void **) {
    std::int64_t first = 0, both = 0, after = 0, peak = 0;
    {
        const plm::CountingScope scope;
        {
            vector<double> a(1000);
            first = scope.held();
            vector<double> b(500);
            both = scope.held();
        }
        after = scope.held();
        peak = scope.peak();
    }
    assert_true(first >= 8000 && first <= 8000 + around);
    assert_true(both >= 12000 && both <= 12000 + 2 * around);
    assert_int_equal(after, 0);
    assert_int_equal(peak, both);
}

void an_inner_scope_counts_its_own(void **) {
    std::int64_t inner_peak = 0, outer_before = 0, outer_after = 0;
    {
        const plm::CountingScope outer;
        vector<double> a(1000);
        outer_before = outer.held();
        {
            const plm::CountingScope inner;
            vector<double> b(100);
            inner_peak = inner.peak();
            outer_after = outer.held();
        }
    }
    assert_true(inner_peak >= 800 && inner_peak <= 800 + around);
    // the inner one forwards to the outer one
    assert_true(outer_after >= outer_before + 800 && outer_after <= outer_before + 800 + 2 * around);
}

void the_hosts_allocator_is_asked_and_gets_its_blocks_back(void **) {
    Host host;
    const plm::Allocator a{host_allocate, host_release, &host};
    vector<double> outlives;
    bool refused = false;
    {
        const plm::AllocatorScope hosts(&a);
        const plm::CountingScope scope;
        outlives.resize(100);
        host.fail_at = host.made;
        try {
            vector<double> none(100);
        } catch (const std::bad_alloc &) {
            refused = true;
        }
    }
    const long made = host.made, freed = host.freed;
    std::thread([moved = std::move(outlives)]() mutable { vector<double>().swap(moved); }).join();
    assert_true(refused);
    assert_int_equal(made, 1);
    assert_int_equal(freed, 0);
    assert_int_equal(host.freed, 1); // after the scope, on another thread
}

void foreign_memory_counts_while_it_is_held(void **) {
    std::int64_t during = 0, after = 0, peak = 0, late = 0;
    {
        const plm::CountingScope scope;
        {
            plm::ForeignMemory library;
            library.holds(3000, 5000);
            during = scope.held();
            library.holds(1000, 5000);
            late = scope.held();
        }
        after = scope.held();
        peak = scope.peak();
    }
    plm::ForeignMemory nobody; // without a scope there is nothing to count
    nobody.holds(1, 1);
    assert_int_equal(during, 3000);
    assert_int_equal(late, 1000);
    assert_int_equal(after, 0);
    assert_int_equal(peak, 5000);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(held_and_peak_follow_the_arrays),
        cmocka_unit_test(an_inner_scope_counts_its_own),
        cmocka_unit_test(the_hosts_allocator_is_asked_and_gets_its_blocks_back),
        cmocka_unit_test(foreign_memory_counts_while_it_is_held),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
