// extreme [--quick] [--row NAME] [--list]: the page docs/extreme.md, the extreme cases in Markdown: one row
// per case with its outcome, error against an independent truth, and work, with the error of the sampled
// contact forces beside it; starts without a guess; Newton's work. Ends with 1 when anything misses its bound
// or ends otherwise than it has to. --quick: the rows of a minute without the sampled forces, which the
// sanitizers run, too.
#include "row.hpp"
#include "tables.hpp"
#include <cstdio>
#include <cstring>

namespace {

using namespace extreme;

struct Arguments {
    bool quick = false, list = false;
    const char *row = nullptr;
};

bool parse(int argc, char **argv, Arguments &a) {
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--quick")) {
            a.quick = true;
        } else if (!std::strcmp(argv[i], "--list")) {
            a.list = true;
        } else if (!std::strcmp(argv[i], "--row") && i + 1 < argc) {
            a.row = argv[++i];
        } else {
            std::fprintf(stderr, "usage: extreme [--quick] [--list] [--row NAME]\n");
            return false;
        }
    }
    return true;
}

struct Group {
    const char *title;
    std::vector<Row> rows;
};

std::vector<Group> all_groups() {
    return {{"Contact stiffness", stiffness_rows()},  {"Limits", limit_rows()},
            {"Structures", structure_rows()},         {"Nearly equal samples", basis_rows()},
            {"Harmonics on a surface", plate_rows()}, {"The literature's oscillator", standard_rows()},
            {"No answer", no_answer_rows()}};
}

bool chosen(const Arguments &a, const Row &row) {
    return (!a.quick || row.quick) && (!a.row || row.name.find(a.row) != std::string::npos);
}

int list(const Arguments &a) {
    for (const Group &group : all_groups())
        for (const Row &row : group.rows)
            if (chosen(a, row)) std::printf("%s\n", row.name.c_str());
    return 0;
}

} // namespace

int main(int argc, char **argv) {
    Arguments a;
    if (!parse(argc, argv, a)) return 2;
    if (a.list) return list(a);
    std::vector<GroupWork> works;
    int missed = 0, done = 0;
    print_introduction();
    print_row_head();
    for (const Group &group : all_groups()) {
        GroupWork work{group.title, 0, {}};
        for (const Row &row : group.rows) {
            if (!chosen(a, row)) continue;
            const Measured m = run(row, false);
            print_row(row, m, row.has_sampled && !a.quick ? run(row, true) : Measured());
            work.work.add(m.work);
            ++work.n_rows;
            missed += !holds(row, m);
        }
        if (work.n_rows > 0) works.push_back(work);
        done += work.n_rows;
    }
    if (!a.row) missed += print_cold_starts(a.quick, works);
    if (!a.row && !a.quick) missed += print_scenes(works);
    print_work(works);
    std::printf("\n%d rows; %d missed\n", done, missed);
    return missed || done == 0 ? 1 : 0;
}
