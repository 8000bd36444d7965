// SCOTCH where malloc fails: std::bad_alloc or the order as ever, whichever allocation it is, and afterwards
// the order as ever again.
#include "solids.hpp"
#include "structure/solver/node_graph.hpp"
#include "structure/solver/scotch.hpp"

using namespace test;

// The C library's own, where it is glibc; this program's malloc counts down before it asks them.
extern "C" {
void *__libc_malloc(std::size_t bytes);
void *malloc(std::size_t bytes);
}

namespace {
long allocations = 0, until_failure = 0;
} // namespace

void *malloc(std::size_t bytes) {
    ++allocations;
    return until_failure > 0 && --until_failure == 0 ? nullptr : __libc_malloc(bytes);
}

namespace {

bool failed_once(const plm::NodeGraph &graph, long at, const vector<std::int64_t> &order) {
    until_failure = at;
    try {
        const bool same = plm::order_by_scotch(graph) == order;
        until_failure = 0;
        return !same;
    } catch (const std::bad_alloc &) {
        until_failure = 0;
    }
    return plm::order_by_scotch(graph) != order;
}

void every_allocation_may_fail(void **) {
    const plm::NodeGraph graph = plm::node_graph(solid(8, 8, 8));
    const vector<std::int64_t> order = plm::order_by_scotch(graph);
    assert_int_equal(order.size(), 512);
    allocations = 0;
    plm::order_by_scotch(graph);
    const long n = allocations;
    assert_true(n > 50);
    for (long at = 1; at <= n; ++at) assert_false(failed_once(graph, at, order));
}

} // namespace

int main() {
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_allocation_may_fail)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
