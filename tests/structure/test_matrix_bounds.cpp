// The host's arrays are read up to their ends and no further: each lies before a page that nobody may read.
#include "structure/matrix_input.hpp"
#include "support/caught.hpp"
#include "support/test.hpp"
#include <algorithm>
#include <sys/mman.h>
#include <unistd.h>

namespace {

// An array whose end is that of the readable memory.
template <class T> class Guarded {
  public:
    explicit Guarded(const std::vector<T> &values) {
        const std::size_t page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE)),
                          bytes = values.size() * sizeof(T);
        readable_ = (bytes + page - 1) / page * page, whole_ = readable_ + page;
        begin_ = static_cast<char *>(
            mmap(nullptr, whole_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
        mprotect(begin_ + readable_, page, PROT_NONE);
        std::copy(values.begin(), values.end(), reinterpret_cast<T *>(begin_ + readable_ - bytes));
        data_ = reinterpret_cast<const T *>(begin_ + readable_ - bytes);
    }
    ~Guarded() { munmap(begin_, whole_); }
    Guarded(const Guarded &) = delete;
    Guarded &operator=(const Guarded &) = delete;
    const T *data() const { return data_; }

  private:
    char *begin_;
    std::size_t readable_, whole_;
    const T *data_;
};

struct Case {
    std::int32_t storage, part;
    std::vector<int> a, b;
    std::vector<double> value;
    bool symmetric;
};

// Of size 3. What is met last, at the ends of all arrays, is in turn: a mirror image; an entry whose mirror
// image is missing in the last column; one whose column is at its end; entries out of order; a triangle.
const std::vector<Case> &cases() {
    static const std::vector<Case> all = {
        {plm::storage::csc,
         plm::part::full,
         {0, 2, 5, 7},
         {0, 1, 0, 1, 2, 1, 2},
         {4, -1, -1, 5, -2, -2, 6},
         true},
        {plm::storage::csc, plm::part::full, {0, 3, 5, 6}, {0, 1, 2, 0, 1, 2}, {4, -1, -3, -1, 5, 6}, false},
        {plm::storage::csc, plm::part::full, {0, 2, 4, 4}, {0, 2, 0, 1}, {4, -3, -1, 5}, false},
        {plm::storage::csc, plm::part::full, {0, 1, 3, 3}, {0, 1, 2}, {4, 5, -2}, false},
        {plm::storage::csc,
         plm::part::full,
         {0, 2, 5, 7},
         {1, 0, 2, 1, 0, 2, 1},
         {-1, 4, -2, 5, -1, 6, -2},
         true},
        {plm::storage::csc, plm::part::lower, {0, 2, 4, 5}, {0, 1, 1, 2, 2}, {4, -1, 5, -2, 6}, true},
        {plm::storage::triplets,
         plm::part::full,
         {0, 0, 1, 1, 1, 2, 2},
         {0, 1, 0, 1, 2, 1, 2},
         {4, -1, -1, 5, -2, -2, 6},
         true},
    };
    return all;
}

template <class Index> bool is_read_within_bounds(const Case &c, std::int32_t storage, Index base) {
    std::vector<Index> a(c.a.begin(), c.a.end()), b(c.b.begin(), c.b.end());
    for (Index &x : a) x += base;
    for (Index &x : b) x += base;
    const Guarded<Index> pointers(a), numbers(b);
    const Guarded<double> values(c.value);
    plm::MatrixFormat f;
    f.n = 3, f.nnz = static_cast<std::int64_t>(c.value.size());
    f.storage = storage, f.part = c.part, f.index_base = static_cast<std::int32_t>(base), f.copy = false;
    plm::SparseMatrix read;
    const Caught out = caught(
        [&] { read = plm::MatrixInput(f, pointers.data(), numbers.data(), values.data()).to_sparse(); });
    return c.symmetric ? out.status == plm::status::ok && read.nnz() == 7 : out.status == plm::status::matrix;
}

void arrays_are_read_up_to_their_ends(void **) {
    for (const Case &c : cases())
        for (int base : {0, 1}) {
            assert_true(is_read_within_bounds<std::int32_t>(c, c.storage, base));
            assert_true(is_read_within_bounds<std::int64_t>(c, c.storage, base));
            if (c.storage != plm::storage::csc || c.part != plm::part::full) continue;
            assert_true(is_read_within_bounds<std::int32_t>(c, plm::storage::csr, base));
        }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {cmocka_unit_test(arrays_are_read_up_to_their_ends)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
