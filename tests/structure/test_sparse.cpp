// Sparse matrices against their dense images.
#include "matrices.hpp"

using namespace test;

namespace {

SparseMatrix random_sparse(std::int64_t rows, std::int64_t cols, int entries, std::uint64_t seed) {
    Random random(seed);
    vector<std::int64_t> i, j;
    vector<double> v;
    for (int e = 0; e < entries; ++e) {
        i.push_back(static_cast<std::int64_t>((random() + 1) / 2 * static_cast<double>(rows)));
        j.push_back(static_cast<std::int64_t>((random() + 1) / 2 * static_cast<double>(cols)));
        v.push_back(random());
    }
    return plm::from_triplets(rows, cols, i, j, v);
}

bool well_formed(const SparseMatrix &a) {
    if (static_cast<std::int64_t>(a.ptr.size()) != a.cols + 1 || a.ptr.back() != a.nnz()) return false;
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j] + 1; p < a.ptr[j + 1]; ++p)
            if (a.idx[p - 1] >= a.idx[p]) return false;
    return true;
}

void triplets_are_sorted_and_duplicates_summed(void **) {
    const SparseMatrix a = plm::from_triplets(3, 2, {2, 0, 2, 1}, {0, 0, 0, 1}, {1, 2, 3, 4});
    assert_int_equal(a.nnz(), 3);
    assert_true(well_formed(a));
    const Matrix d = plm::to_dense(a);
    assert_true(d(0, 0) == 2 && d(2, 0) == 4 && d(1, 1) == 4);
    const auto o = outcome_of([] { plm::from_triplets(3, 2, {0, 3}, {0, 0}, {1, 1}); });
    assert_int_equal(o.status, plm::status::argument);
    assert_int_equal(o.index, 1);
}

void transpose_and_sum_match_dense(void **) {
    const SparseMatrix a = random_sparse(30, 20, 100, 1), b = random_sparse(30, 20, 100, 2);
    const SparseMatrix t = plm::transpose(a), s = plm::add(2, a, -3, b);
    assert_true(well_formed(t) && well_formed(s));
    assert_true(max_difference(plm::to_dense(t), plm::to_dense(a).transposed()) == 0);
    Matrix expected = plm::to_dense(a);
    const Matrix db = plm::to_dense(b);
    for (int i = 0; i < 600; ++i) expected.data()[i] = 2 * expected.data()[i] - 3 * db.data()[i];
    assert_true(max_difference(plm::to_dense(s), expected) < 1e-15);
}

void stored_zeros_go_where_they_are_many(void **) {
    // a mass matrix of two translations with the pattern of their stiffness; DOF 3 has none
    const vector<std::int64_t> i = {0, 1, 2, 0, 1, 2, 0, 1, 2, 3}, j = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3};
    const SparseMatrix m = plm::from_triplets(4, 4, i, j, {2, 0, 1, 0, 2, 0, 1, 0, 2, 0}),
                       s = plm::without_zeros(m);
    assert_true(well_formed(s));
    assert_int_equal(s.nnz(), 6);
    assert_true(max_difference(plm::to_dense(s), plm::to_dense(m)) == 0);
    const SparseMatrix few = plm::from_triplets(4, 4, i, j, {2, 0, 1, 0, 2, 3, 1, 3, 2, 1});
    assert_int_equal(plm::without_zeros(few).nnz(), 10);
    SparseMatrix full = plm::from_triplets(64, 64, {}, {}, {});
    for (int k = 0; k < 64; ++k) {
        full.ptr[k + 1] = 64 * (k + 1);
        for (int l = 0; l < 64; ++l) full.idx.push_back(l), full.val.push_back(k == l);
    }
    assert_int_equal(plm::without_zeros(full).nnz(), 64 * 64);
}

void submatrix_drops_and_permutes(void **) {
    const SparseMatrix a = random_sparse(6, 5, 25, 3);
    const vector<std::int64_t> rows = {3, -1, 0, 2, -1, 1}, cols = {-1, 2, 0, -1, 1};
    const SparseMatrix s = plm::submatrix(a, rows, 4, cols, 3);
    assert_true(well_formed(s));
    const Matrix d = plm::to_dense(s), full = plm::to_dense(a);
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 5; ++j)
            if (rows[i] >= 0 && cols[j] >= 0) assert_true(d(rows[i], cols[j]) == full(i, j));
}

void block_products_match_dense_for_any_number_of_columns(void **) {
    const SparseMatrix a = random_sparse(40, 25, 150, 4);
    const Matrix d = plm::to_dense(a);
    for (std::int64_t n : {0, 1, 2, 7, 8, 9, 20}) {
        const Matrix x = random_matrix(25, n, 5), y = random_matrix(40, n, 6);
        assert_true(max_difference(plm::multiply(a, x), plm::product('N', 'N', d, x)) < 1e-13);
        assert_true(max_difference(plm::multiply_transposed(a, y), plm::product('T', 'N', d, y)) < 1e-13);
    }
    const auto o = outcome_of([&] { plm::multiply(a, Matrix(3, 3)); });
    assert_int_equal(o.status, plm::status::internal);
}

void norm_and_trace_match_their_definitions(void **) {
    const SparseMatrix a = plm::from_triplets(2, 2, {0, 0, 1}, {0, 1, 1}, {1, -5, 3});
    assert_true(plm::norm_inf(a) == 6);
    assert_true(plm::trace(a) == 4);
    assert_true(plm::norm_inf(plm::from_triplets(0, 0, {}, {}, {})) == 0);
}

/// All entries of a dense matrix.
SparseMatrix with_all_entries(const Matrix &d) {
    vector<std::int64_t> i, j;
    vector<double> v(d.data(), d.data() + d.rows() * d.cols());
    for (std::int64_t column = 0; column < d.cols(); ++column)
        for (std::int64_t row = 0; row < d.rows(); ++row) i.push_back(row), j.push_back(column);
    return plm::from_triplets(d.rows(), d.cols(), i, j, v);
}

// Superelements: BLAS multiplies what stores every entry, with the same result.
void matrices_that_store_every_entry_are_dense(void **) {
    const Matrix d = random_matrix(70, 90, 1);
    const SparseMatrix a = with_all_entries(d);
    SparseMatrix one_less = a;
    --one_less.ptr.back(), one_less.idx.pop_back(), one_less.val.pop_back();
    assert_true(plm::is_dense(a) && !plm::is_dense(one_less) &&
                !plm::is_dense(with_all_entries(random_matrix(9, 9, 2))));
    for (std::int64_t columns : {1, 13}) {
        const Matrix x = random_matrix(90, columns, 3), y = random_matrix(70, columns, 4);
        assert_true(max_difference(plm::multiply(a, x), plm::product('N', 'N', d, x)) < 1e-13);
        assert_true(max_difference(plm::multiply_transposed(a, y), plm::product('T', 'N', d, y)) < 1e-13);
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(triplets_are_sorted_and_duplicates_summed),
        cmocka_unit_test(transpose_and_sum_match_dense),
        cmocka_unit_test(stored_zeros_go_where_they_are_many),
        cmocka_unit_test(submatrix_drops_and_permutes),
        cmocka_unit_test(block_products_match_dense_for_any_number_of_columns),
        cmocka_unit_test(matrices_that_store_every_entry_are_dense),
        cmocka_unit_test(norm_and_trace_match_their_definitions),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
