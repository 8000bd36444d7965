// Entries of a symmetric matrix as the parts of a structure bring them, summed place by place.
#pragma once
#include <cstdint>
#include <vector>

namespace plm::mpi {

/// Part of an entry in the lower triangle, as one rank assembled it. Where a host gives both triangles each
/// half counts half, and `skew` holds half their difference, which must sum up to nothing. DOFs fit 32 bits,
/// as MUMPS's do.
struct Entry {
    std::int32_t row, col;
    double value, skew;
};

inline bool stands_before(const Entry &a, const Entry &b) {
    return a.row != b.row ? a.row < b.row : a.col < b.col;
}

/// By rows. Parts of one entry stay in their order.
void sort_by_place(std::vector<Entry> &entries);
/// Both are sorted, and `first` has each place once; so has the result: what b has of a place is added one
/// after the other.
std::vector<Entry> merged(const std::vector<Entry> &first, const std::vector<Entry> &second);

/// A growing sum: an element code brings each place several times, and only a part of it is kept so.
class EntryList {
  public:
    void add(const Entry &e) {
        if (fresh_.size() >= room()) settle();
        fresh_.push_back(e);
    }
    void clear() { sum_ = {}, fresh_ = {}; }
    /// Each place once, by rows; nothing is left here.
    std::vector<Entry> take();

  private:
    std::size_t room() const { return 65536 + sum_.size() / 4; }
    void settle();

    std::vector<Entry> sum_, fresh_;
};

} // namespace plm::mpi
