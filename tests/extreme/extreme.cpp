// extreme [--quick] [--row NAME] [--list]: the table of extreme cases in Markdown, one row per case: outcome,
// error against an independent truth, and work, with the error of the sampled contact forces beside it. Ends
// with 1 when a row misses its tolerance or ends otherwise than at the end of its range.
#include "row.hpp"
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <cstdlib>

namespace {

using namespace extreme;

Measured run(const Row &row, bool sampled) {
    try {
        return row.measure(sampled);
    } catch (const Failure &f) {
        Measured m;
        m.reason = f.reason;
        m.outcome = f.what();
        return m;
    }
}

bool holds(const Row &row, const Measured &m) {
    const bool in_time = m.time_limit == 0 || m.work.seconds <= m.time_limit;
    return m.reason == PLM_REASON_RANGE_END && m.error <= row.tolerance && in_time;
}

void print_head() {
    std::printf("| case | parameters | outcome | error | against | tolerance | iterations a point | failed "
                "steps | points | time (s) | error, sampled | |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_error(double e) {
    if (e >= 1e299) {
        std::printf(" none |");
    } else {
        std::printf(" %.1e |", e);
    }
}

void print_row(const Row &row, const Measured &m, const Measured &sampled) {
    std::printf("| %s | %s | %s |", row.name.c_str(), row.parameters.c_str(), m.outcome.c_str());
    print_error(m.error);
    std::printf(" %s | %.0e | %.1f | %lld | %lld | %.3f |", row.truth.c_str(), row.tolerance,
                m.work.points ? static_cast<double>(m.work.iterations) / static_cast<double>(m.work.points) : 0.0,
                static_cast<long long>(m.work.failed_steps), static_cast<long long>(m.work.points),
                m.work.seconds);
    if (!row.has_sampled) {
        std::printf(" - |");
    } else if (sampled.reason != PLM_REASON_RANGE_END) {
        std::printf(" stopped |");
    } else {
        print_error(sampled.error);
    }
    std::printf(" %s |\n", holds(row, m) ? "" : "MISSED");
    std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
    bool quick = false, list = false;
    const char *one = nullptr;
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--quick")) {
            quick = true;
        } else if (!std::strcmp(argv[i], "--list")) {
            list = true;
        } else if (!std::strcmp(argv[i], "--row") && i + 1 < argc) {
            one = argv[++i];
        } else {
            std::fprintf(stderr, "usage: extreme [--quick] [--list] [--row NAME]\n");
            return 2;
        }
    }
    std::vector<Row> rows;
    for (const auto &group : {stiffness_rows(), limit_rows(), structure_rows(), basis_rows(), standard_rows()})
        rows.insert(rows.end(), group.begin(), group.end());
    Work work;
    int missed = 0, done = 0;
    if (!list) print_head();
    for (const Row &row : rows) {
        if ((quick && !row.quick) || (one && row.name.find(one) == std::string::npos)) continue;
        if (list) {
            std::printf("%s\n", row.name.c_str());
            continue;
        }
        const Measured m = run(row, false);
        const Measured sampled = row.has_sampled && !std::getenv("NOS") ? run(row, true) : Measured();
        print_row(row, m, sampled);
        work.add(m.work);
        missed += !holds(row, m);
        ++done;
    }
    if (list) return 0;
    std::printf("\n%d rows, %lld points, %.2f Newton iterations a point, %lld failed steps, %.2f s; %d missed\n",
                done, static_cast<long long>(work.points),
                static_cast<double>(work.iterations) / static_cast<double>(work.points ? work.points : 1),
                static_cast<long long>(work.failed_steps), work.seconds, missed);
    return missed || done == 0 ? 1 : 0;
}
