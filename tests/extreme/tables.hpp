// The Markdown of docs/extreme.md.
#pragma once
#include "row.hpp"

namespace extreme {

struct GroupWork {
    std::string title;
    int n_rows = 0;
    Work work;
};

/// The row's case; a failing call becomes an outcome with its reason.
Measured run(const Row &row, bool sampled);
/// Ended as it has to, within its bound and its time.
bool holds(const Row &row, const Measured &m);

void print_introduction();
void print_row_head();
void print_row(const Row &row, const Measured &m, const Measured &sampled);
/// These two add their work, and return how many lines missed. quick: the two softer contacts.
int print_cold_starts(bool quick, std::vector<GroupWork> &works);
int print_scenes(std::vector<GroupWork> &works);
void print_work(const std::vector<GroupWork> &works);

} // namespace extreme
