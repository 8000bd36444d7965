#include "tables.hpp"
#include "cold_starts.hpp"
#include <cstdio>

namespace extreme {
namespace {

// Times are promised of optimised builds without instruments.
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
constexpr bool times_count = true;
#else
constexpr bool times_count = false;
#endif

void print_error(double e) {
    if (e >= 1e299) {
        std::printf(" none |");
    } else {
        std::printf(" %.1e |", e);
    }
}

double per_point(const Work &w) {
    return w.points ? static_cast<double>(w.iterations) / static_cast<double>(w.points) : 0.0;
}

void print_work_cells(const Work &w) {
    std::printf(" %lld | %.1f | %lld | %.3f |", static_cast<long long>(w.points), per_point(w),
                static_cast<long long>(w.failed_steps), w.seconds);
}

} // namespace

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
    if (m.reason != row.end) return false;
    if (row.end != PLM_REASON_RANGE_END) return true;
    const bool in_time = !times_count || m.time_limit == 0 || m.work.seconds <= m.time_limit;
    return m.error <= row.tolerance && in_time;
}

void print_introduction() {
    std::printf(
        "# Extreme cases\n\n"
        "One row per case that a solver for structures with contact may stumble over. Every option has its "
        "default, unless\n"
        "the row is about that option or says so: curves of small models are exact motions, those of others "
        "are made by harmonic\n"
        "balance with as many harmonics as each point needs (`harmonic_tolerance` 5e-4). Structures of a few "
        "masses are solved\n"
        "unreduced (`kind` = `full`) so that the error is the solver's; rows that name a basis, the starts "
        "and the scenes have\n"
        "piecewise-linear modes. ctest runs `extreme --quick` (label `extreme`) and fails when a row misses "
        "its bound. To renew\n"
        "this page:\n\n"
        "    OPENBLAS_NUM_THREADS=1 build/release/tests/extreme/extreme > docs/extreme.md\n\n"
        "*Error against*: exact orbits are periodic orbits of the piecewise-linear flow by matrix "
        "exponentials and\n"
        "shooting (`tests/support/exact_flow.cpp`, shares no code with the library), at points spread over "
        "the curve and\n"
        "at its top: largest difference of the peak displacements over the DOFs, as a share of the largest "
        "of them.\n"
        "Linear answers are dense complex solves at every point of the curve. Why a bound stands where it "
        "stands is said\n"
        "at the row in `tests/extreme/`. *Unknowns*: `state`, the curve is made of exact motions; `modal`, "
        "`gaps` or `both`,\n"
        "of harmonic balance in reduced coordinates or contact gaps. *Sampled*: the same case by harmonic "
        "balance with `aft` =\n"
        "`sampled`, 256 samples; `stopped`: it did not reach the end of the range; `-`: it came out of it "
        "where it had gone in,\n"
        "or the row has no such case; `none`: at some point no exact orbit was found. Times are seconds of "
        "the processor, one\n"
        "thread (a machine of 2 cores, Debian 12, gcc 12, preset `release`), indicative only.\n\n"
        "Impacts of stiff contact (rows `impact`) last 2 %% of a period at 1e3 k_loc and 2e-5 at 1e9, where "
        "the stop is rigid for\n"
        "all that the curve shows. Exact motions have no harmonics to cut off and keep their accuracy. By "
        "harmonic balance\n"
        "(`motion` = `harmonics`) the velocity's jump takes harmonics that fall off as slowly as 1 / H: with "
        "the 40 to 60 that it\n"
        "takes there the peaks are 1e-3 to 1e-2 off at 1e3 and 7 to 10 %% from 1e5 on, and `harmonic_error`, "
        "up to 2e-2, does not\n"
        "show all of it. Where the stop stands on a DOF without mass (rows `bed`) there are no impacts.\n\n");
}

void print_row_head() {
    std::printf("| case | parameters | outcome | error | against | bound | points | iterations a point | "
                "failed steps | time (s) | unknowns | error, sampled | |\n");
    std::printf("|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const Row &row, const Measured &m, const Measured &sampled) {
    std::printf("| %s | %s | %s |", row.name.c_str(), row.parameters.c_str(), m.outcome.c_str());
    if (row.end == PLM_REASON_RANGE_END) {
        print_error(m.error);
        std::printf(" %s | %.0e |", row.truth.c_str(), row.tolerance);
    } else {
        std::printf(" - | %s | - |", row.truth.c_str());
    }
    print_work_cells(m.work);
    std::printf(" %s |", m.unknowns.empty() ? "-" : m.unknowns.c_str());
    if (!row.has_sampled || sampled.reason == PLM_REASON_NONE) {
        std::printf(" - |");
    } else if (sampled.reason != PLM_REASON_RANGE_END) {
        std::printf(" stopped |");
    } else {
        print_error(sampled.error);
    }
    std::printf(" %s |\n", holds(row, m) ? "" : "MISSED");
    std::fflush(stdout);
}

int print_cold_starts(bool quick, std::vector<GroupWork> &works) {
    std::printf(
        "\n## Starts without a guess\n\n25 frequencies over the window of the cracked plate (`quick` size, "
        "pre-load, piecewise-linear modes), each from nothing.\n\n"
        "| k_n / k_loc | converged | not at (Hz) | iterations a start | time (s) |\n"
        "|---|---|---|---|---|\n");
    GroupWork group{"Starts without a guess", 0, {}};
    int missed = 0;
    for (double ratio : {1, 10, 100, 1000}) {
        if (quick && ratio > 10) continue;
        const ColdStarts c = cold_starts(ratio);
        std::printf("| %g | %d of 25 |%s | %.1f | %.3f |\n", ratio, c.converged, c.failing.c_str(),
                    per_point(c.work), c.work.seconds);
        group.work.add(c.work);
        ++group.n_rows;
        std::fflush(stdout);
        missed += c.converged < 25;
    }
    works.push_back(group);
    return missed;
}

int print_scenes(std::vector<GroupWork> &works) {
    std::printf(
        "\n"
        "## The scenes of examples/scenes\n\n"
        "Default sweeps over the sampler's window, `quick` size; their accuracy is in the test "
        "`accuracy`.\n\n"
        "| scene | DOFs | pairs | outcome | points | iterations a point | failed steps | time (s) | |\n"
        "|---|---|---|---|---|---|---|---|---|\n");
    GroupWork group{"Scenes", 0, {}};
    int missed = 0;
    for (const auto &[name, preload] : scene_cases()) {
        const SceneSweep s = sweep_scene(name, preload);
        const bool good = s.reason == PLM_REASON_RANGE_END;
        std::printf("| %s | %lld | %lld | %s |", s.name.c_str(), static_cast<long long>(s.n_dof),
                    static_cast<long long>(s.n_pairs), s.outcome.c_str());
        print_work_cells(s.work);
        std::printf(" %s |\n", good ? "" : "MISSED");
        group.work.add(s.work);
        ++group.n_rows;
        std::fflush(stdout);
        missed += !good;
    }
    works.push_back(group);
    return missed;
}

void print_work(const std::vector<GroupWork> &works) {
    std::printf(
        "\n## Work\n\nNewton iterations and repeated continuation steps of all of the above, defaults on.\n\n"
        "| cases | rows | points | iterations a point | failed steps | time (s) "
        "|\n|---|---|---|---|---|---|\n");
    GroupWork all{"all", 0, {}};
    for (const GroupWork &w : works) {
        std::printf("| %s | %d |", w.title.c_str(), w.n_rows);
        print_work_cells(w.work);
        std::printf("\n");
        all.n_rows += w.n_rows;
        all.work.add(w.work);
    }
    std::printf("| all | %d |", all.n_rows);
    print_work_cells(all.work);
    std::printf("\n");
}

} // namespace extreme
