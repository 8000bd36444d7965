#include "mpi/entries.hpp"
#include <algorithm>

namespace plm::mpi {
namespace {

bool is_same_place(const Entry &a, const Entry &b) {
    return a.row == b.row && a.col == b.col;
}

/// visit(entry, whether its place has been visited), of two sorted lists as of one; at a place the first
/// list's come first.
template <class Visit>
void in_order(const std::vector<Entry> &first, const std::vector<Entry> &second, Visit visit) {
    const Entry *last = nullptr;
    auto a = first.begin(), b = second.begin();
    while (a != first.end() || b != second.end()) {
        const bool from_second = a == first.end() || (b != second.end() && stands_before(*b, *a));
        const Entry &e = from_second ? *b++ : *a++;
        visit(e, last && is_same_place(*last, e));
        last = &e;
    }
}

} // namespace

void sort_by_place(std::vector<Entry> &entries) {
    std::stable_sort(entries.begin(), entries.end(), stands_before);
}

std::vector<Entry> merged(const std::vector<Entry> &first, const std::vector<Entry> &second) {
    std::size_t places = 0;
    in_order(first, second, [&](const Entry &, bool again) { places += !again; });
    std::vector<Entry> sum;
    sum.reserve(places);
    in_order(first, second, [&](const Entry &e, bool again) {
        if (again)
            sum.back().value += e.value, sum.back().skew += e.skew;
        else
            sum.push_back(e);
    });
    return sum;
}

void EntryList::settle() {
    sort_by_place(fresh_);
    sum_ = merged(sum_, fresh_);
    fresh_.clear();
    fresh_.reserve(room());
}

std::vector<Entry> EntryList::take() {
    settle();
    fresh_ = {};
    return std::move(sum_);
}

} // namespace plm::mpi
