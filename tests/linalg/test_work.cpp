// What work may cost: counted alike on any number of threads, bounded by the innermost scope that is spent.
#include "linalg/parallel.hpp"
#include "linalg/work.hpp"
#include "support/test.hpp"
#include <cmath>

namespace {

void work_ends_where_it_is_spent(void **) {
    int pieces = 0;
    assert_true(std::isinf(plm::effort_left()));
    const bool all = plm::within(1000, [&] {
        for (; pieces < 100; ++pieces) plm::worked(100);
    });
    assert_false(all);
    assert_int_equal(pieces, 10); // the eleventh is one too many
    assert_true(std::isinf(plm::effort_left()));
    assert_true(plm::within(1000, [] { plm::worked(1000); }));
}

// The part of an answer that is given up leaves the rest what is left.
void an_inner_scope_gives_way_to_the_outer_one(void **) {
    int inner = 0, after = 0;
    const bool all = plm::within(1000, [&] {
        assert_false(plm::within(300, [&] {
            for (;; ++inner) plm::worked(100);
        }));
        assert_true(plm::effort_left() == 600); // what was one too many was worked, too
        const plm::Effort more(1e9);            // is not to be had in here
        for (;; ++after) plm::worked(100);
    });
    assert_false(all);
    assert_int_equal(inner, 3);
    assert_int_equal(after, 6);
}

void other_failures_pass(void **) {
    try {
        plm::within(1000, [] { throw plm::Error(plm::status::singular, "singular"); });
        fail();
    } catch (const plm::Error &e) {
        assert_int_equal(e.status(), plm::status::singular);
    }
}

// Helpers' pieces count as the owner's, whoever takes them, and are not given up half-way.
void threads_count_as_one(void **) {
    std::int64_t counted[2];
    for (int k = 0; k < 2; ++k) {
        const plm::ThreadsScope threads(k + 1);
        const std::int64_t before = plm::work_done();
        plm::parallel_for(50, [](std::int64_t i) { plm::worked(static_cast<double>(10 * i)); });
        counted[k] = plm::work_done() - before;
    }
    assert_int_equal(counted[0], 12250);
    assert_int_equal(counted[1], counted[0]);
    const plm::ThreadsScope threads(2);
    assert_false(plm::within(100, [] { plm::parallel_for(50, [](std::int64_t) { plm::worked(10); }); }));
    assert_true(plm::within(500, [] { plm::parallel_for(50, [](std::int64_t) { plm::worked(10); }); }));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(work_ends_where_it_is_spent),
        cmocka_unit_test(an_inner_scope_gives_way_to_the_outer_one),
        cmocka_unit_test(other_failures_pass),
        cmocka_unit_test(threads_count_as_one),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
