// Every format reads to the same matrix; every wrong entry is refused with its position.
#include "structure/matrix_input.hpp"
#include "support/caught.hpp"
#include "support/test.hpp"
#include <limits>

using plm::MatrixFormat;
using plm::MatrixInput;
using plm::SparseMatrix;

namespace {

// The matrix of all tests: [4 -1 0; -1 5 -2; 0 -2 6]
template <class Index> struct Sample {
    std::int32_t storage, part, base;
    std::vector<Index> a, b;
    std::vector<double> v;

    MatrixFormat layout(bool copy = true) const {
        MatrixFormat f;
        f.n = 3, f.nnz = static_cast<std::int64_t>(v.size());
        f.storage = storage, f.part = part, f.index_base = base, f.copy = copy;
        return f;
    }
    MatrixInput input(bool copy = true) const {
        return MatrixInput(layout(copy), a.data(), b.data(), v.data());
    }
    Caught check() const {
        return caught([&] { input().check(); });
    }
};

template <class Index> Sample<Index> full(std::int32_t storage, std::int32_t base) {
    Sample<Index> s{storage,      plm::part::full,       base,
                    {0, 2, 5, 7}, {0, 1, 2, 0, 1, 1, 2}, {4, -1, -2, -1, 5, -2, 6}};
    if (storage == plm::storage::triplets) s.a = {0, 1, 2, 0, 1, 1, 2}, s.b = {0, 0, 1, 1, 1, 2, 2};
    for (Index &x : s.a) x += base;
    for (Index &x : s.b) x += base;
    return s;
}

// One triangle; as compressed rows it is the other one of the compressed columns.
template <class Index> Sample<Index> triangle(std::int32_t storage, std::int32_t part, std::int32_t base) {
    const bool lower_by_columns = (part == plm::part::lower) == (storage == plm::storage::csc);
    Sample<Index> s{storage, part, base, {}, {}, {}};
    if (storage == plm::storage::triplets) {
        s.a = {0, 1, 1, 2, 2}, s.b = {0, 0, 1, 1, 2}, s.v = {4, -1, 5, -2, 6};
        if (part == plm::part::upper) s.a.swap(s.b);
    } else if (lower_by_columns) {
        s.a = {0, 2, 4, 5}, s.b = {0, 1, 1, 2, 2}, s.v = {4, -1, 5, -2, 6};
    } else {
        s.a = {0, 1, 3, 5}, s.b = {0, 0, 1, 1, 2}, s.v = {4, -1, 5, -2, 6};
    }
    for (Index &x : s.a) x += base;
    for (Index &x : s.b) x += base;
    return s;
}

bool is_the_matrix(const SparseMatrix &m) {
    const double want[3][3] = {{4, -1, 0}, {-1, 5, -2}, {0, -2, 6}};
    const plm::Matrix d = to_dense(m);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (d(i, j) != want[i][j]) return false;
    return m.nnz() == 7;
}

template <class Index> bool all_formats_equal() {
    for (std::int32_t storage : {plm::storage::csc, plm::storage::triplets, plm::storage::csr})
        for (std::int32_t base : {0, 1})
            for (bool copy : {true, false}) {
                const Sample<Index> f = full<Index>(storage, base);
                f.input(copy).check();
                if (!is_the_matrix(f.input(copy).to_sparse())) return false;
                for (std::int32_t part : {plm::part::lower, plm::part::upper}) {
                    const Sample<Index> t = triangle<Index>(storage, part, base);
                    t.input(copy).check();
                    if (!is_the_matrix(t.input(copy).to_sparse())) return false;
                }
            }
    return true;
}

bool is(const Caught &c, const char *argument, std::int64_t index, const char *text) {
    if (c.status != plm::status::matrix || c.argument != argument || c.index != index)
        std::printf("    status %d, argument %s, index %lld: %s\n", c.status, c.argument.c_str(),
                    static_cast<long long>(c.index), c.text.c_str());
    return c.status == plm::status::matrix && c.argument == argument && c.index == index && c.says(text);
}

void formats_agree(void **) {
    assert_true(all_formats_equal<std::int32_t>());
    assert_true(all_formats_equal<std::int64_t>());
}

void triplets_are_summed(void **) {
    Sample<std::int32_t> s = triangle<std::int32_t>(plm::storage::triplets, plm::part::lower, 0);
    s.v[0] = 1;
    s.a.push_back(0), s.b.push_back(0), s.v.push_back(3);
    assert_true(is_the_matrix(s.input().to_sparse()));
}

void copies_do_not_follow_the_caller(void **) {
    Sample<std::int32_t> s = full<std::int32_t>(plm::storage::csc, 0);
    const MatrixInput copied = s.input(true);
    s.v.assign(7, 0.0), s.b.assign(7, 9);
    assert_true(is_the_matrix(copied.to_sparse()));
}

void borrowed_arrays_are_checked_again(void **) {
    Sample<std::int32_t> s = full<std::int32_t>(plm::storage::csc, 0);
    const MatrixInput borrowed = s.input(false);
    s.b[3] = 77;
    assert_true(is(caught([&] { borrowed.to_sparse(); }), "b", 3, "b[3] = 77"));
}

void wrong_pointers_are_named(void **) {
    Sample<std::int64_t> s = full<std::int64_t>(plm::storage::csc, 1);
    s.a[0] = 0;
    assert_true(is(s.check(), "a", 0, "index base 1"));
    s = full<std::int64_t>(plm::storage::csc, 1), s.a[2] = 1;
    assert_true(is(s.check(), "a", 2, "must not decrease"));
    s = full<std::int64_t>(plm::storage::csr, 1), s.a[3] = 7;
    assert_true(is(s.check(), "a", 3, "nnz + index_base = 8"));
    s = full<std::int64_t>(plm::storage::csr, 1), s.a[1] = 1000;
    assert_true(is(s.check(), "a", 1, "row pointers"));
}

void wrong_numbers_are_named(void **) {
    Sample<std::int32_t> s = full<std::int32_t>(plm::storage::csc, 1);
    s.b[4] = 4;
    assert_true(is(s.check(), "b", 4, "1..3"));
    s = full<std::int32_t>(plm::storage::csc, 1), s.b[4] = 0;
    assert_true(is(s.check(), "b", 4, "row number"));
    s = full<std::int32_t>(plm::storage::triplets, 0), s.a[2] = -1;
    assert_true(is(s.check(), "a", 2, "row number"));
    s = full<std::int32_t>(plm::storage::triplets, 0), s.b[6] = 3;
    assert_true(is(s.check(), "b", 6, "column number"));
}

void duplicates_nan_and_wrong_triangle_are_named(void **) {
    Sample<std::int32_t> s = full<std::int32_t>(plm::storage::csc, 1);
    s.b[4] = 1;
    assert_true(is(s.check(), "b", 4, "given twice"));
    s = full<std::int32_t>(plm::storage::csc, 0),
    s.b = {1, 1, 0, 0, 1, 2, 2}; // with its mirror image, and a diagonal
    assert_true(is(s.check(), "b", 1, "given twice"));
    s = full<std::int32_t>(plm::storage::csr, 0), s.b = {0, 1, 0, 1, 2, 2, 2}, s.v[4] = s.v[5] = 0;
    assert_true(is(s.check(), "b", 6, "given twice"));
    s = full<std::int32_t>(plm::storage::csc, 1), s.v[5] = std::numeric_limits<double>::quiet_NaN();
    assert_true(is(s.check(), "value", 5, "row 2, column 3 (counted from 1)"));
    s = full<std::int32_t>(plm::storage::csc, 0), s.part = plm::part::lower;
    assert_true(is(s.check(), "b", 3, "lower triangle"));
    s = full<std::int32_t>(plm::storage::csc, 0), s.part = plm::part::upper;
    assert_true(is(s.check(), "b", 1, "upper triangle"));
}

void asymmetry_names_both_places(void **) {
    Sample<std::int32_t> s = full<std::int32_t>(plm::storage::csc, 1);
    s.v[5] = -2.001;
    const Caught c = s.check();
    assert_int_equal(c.status, plm::status::matrix);
    assert_true(c.index == 5 || c.index == 4 || c.index == 2);
    assert_true(c.says("not symmetric") && c.says("-2.001"));
    s.v[5] = -2 - 1e-9; // rounding of an assembly
    assert_int_equal(s.check().status, plm::status::ok);
    const plm::Matrix d = to_dense(s.input().to_sparse());
    assert_true(d(1, 2) == d(2, 1));
}

void negative_diagonal_is_refused(void **) {
    Sample<std::int32_t> s = full<std::int32_t>(plm::storage::csc, 1);
    s.v[3] = -1, s.v[4] = -5;
    assert_true(is(s.check(), "value", 4, "negative (-5)"));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(formats_agree),
        cmocka_unit_test(triplets_are_summed),
        cmocka_unit_test(copies_do_not_follow_the_caller),
        cmocka_unit_test(borrowed_arrays_are_checked_again),
        cmocka_unit_test(wrong_pointers_are_named),
        cmocka_unit_test(wrong_numbers_are_named),
        cmocka_unit_test(duplicates_nan_and_wrong_triangle_are_named),
        cmocka_unit_test(asymmetry_names_both_places),
        cmocka_unit_test(negative_diagonal_is_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
