// Pairs that act in more than one direction: rows belong to their pair.
#include "structure/matrix_input.hpp"
#include "structure/structure.hpp"
#include "support/caught.hpp"
#include "support/test.hpp"

namespace {

using Ints = plm::vector<std::int64_t>;

std::shared_ptr<const plm::MatrixInput> diagonal(double value) {
    plm::MatrixFormat f;
    f.n = f.nnz = 4;
    f.storage = plm::storage::triplets;
    const std::vector<std::int64_t> at{0, 1, 2, 3};
    const std::vector<double> values(4, value);
    return std::make_shared<plm::MatrixInput>(f, at.data(), at.data(), values.data());
}

// Four masses on springs, the last one held. Pair 0 between masses 0 and 1, along both; pair 1 at mass 2, its
// second direction at `last`.
plm::Structure two_pairs(std::int64_t last) {
    plm::StructureInput in;
    in.n_dof = 4;
    in.mass = diagonal(1), in.stiffness = diagonal(2);
    in.fixed = {3};
    in.gap_row = {0, 0, 1, 2, 3};
    in.gap_dof = {0, 1, 1, 2, last};
    in.gap_coefficient = {1, -1, 1, 1, 5};
    return plm::Structure(in, {2, 2}, 0, plm::Solver(), plm::Watch());
}

void rows_belong_to_their_pair(void **) {
    const plm::Structure s = two_pairs(0);
    const plm::GapRows &gap = s.gap_rows();
    assert_int_equal(gap.n_rows(), 4);
    assert_int_equal(gap.rows().size(), 4);
    assert_true(gap.dofs_of({0}) == (Ints{0, 1}) && gap.dofs_of({1}) == (Ints{0, 2}));
    assert_true(gap.dofs() == (Ints{0, 1, 2}));
    const double all[] = {1, 10, 100, 0};
    const plm::Matrix u = gap.of(s.restricted(all));
    assert_true(u(0, 0) == -9 && u(1, 0) == 10 && u(2, 0) == 100 && u(3, 0) == 5);
}

void a_row_that_nothing_moves_is_told_by_its_pair(void **) {
    const Caught c = caught([] { two_pairs(3); });
    assert_int_equal(c.status, plm::status::argument);
    assert_int_equal(c.index, 1);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(rows_belong_to_their_pair),
        cmocka_unit_test(a_row_that_nothing_moves_is_told_by_its_pair),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
