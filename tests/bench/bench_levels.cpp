// What ten force levels in one call cost in curves: counted work and time of the processor, of one sweep at
// the highest level, of one in the middle, and of all of them as plm_hbm_sweep_levels follows them; and the
// peak of each against that of a sweep of it alone.
//     bench_levels [SCENE [quick|paper [no-preload] [check] [log] [exact|harmonics] [LEVEL ...]]]
// LEVEL: the highest one, 1 unless it is given. Not a test: prints Markdown.
#include "linalg/work.hpp"
#include "scene_basis.hpp"
#include "searches/hbm.hpp"
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace {

using BranchPtr = std::shared_ptr<const plm::Branch>;

constexpr int n_levels = 10;
constexpr double effort = 6e10; // flops: the default of a context

struct Log final : plm::Monitor {
    void log(int, const std::string &text) override {
        std::fprintf(stderr, "[%.2f s, %.3g Gflop] %s\n", static_cast<double>(std::clock()) / CLOCKS_PER_SEC,
                     1e-9 * static_cast<double>(plm::work_done()), text.c_str());
    }
    bool progress(const char *, double) override { return false; }
};

struct Swept {
    BranchPtr curve;
    double gflop = 0, seconds = 0;
};

struct Bench {
    std::shared_ptr<const plm::Basis> basis;
    plm::HbmOptions options;
    plm::Watch watch;
    std::int64_t dof = 0;

    plm::Hbm solver(double level) const {
        plm::HbmOptions o = options;
        o.force_scale = level;
        return plm::Hbm(basis, o, watch);
    }

    Swept sweep(double level, plm::LevelBefore *before) const {
        const std::int64_t work = plm::work_done();
        const std::clock_t begin = std::clock();
        Swept s;
        const plm::Effort limit(effort);
        s.curve = solver(level).sweep(nullptr, before);
        s.gflop = 1e-9 * static_cast<double>(plm::work_done() - work);
        s.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        return s;
    }

    plm::Peak peak(double level, const plm::Branch &curve) const {
        return solver(level).find_peak(curve, dof, plm::Measure::half_peak_to_peak, 0);
    }
};

void print_curve(const char *name, double level, const Swept &s) {
    std::printf("| %s | %.3g | %lld | %zu | %lld | %lld | %.3g | %.2f |\n", name, level,
                static_cast<long long>(s.curve->reduced().size()), s.curve->points().size(),
                static_cast<long long>(s.curve->newton_work.iterations),
                static_cast<long long>(s.curve->failed_steps), s.gflop, s.seconds);
    std::fflush(stdout);
}

void compare(const Bench &b, double level, const plm::Branch &curve) {
    const Swept alone = b.sweep(level, nullptr);
    print_curve("alone", level, alone);
    const plm::Peak here = b.peak(level, curve), there = b.peak(level, *alone.curve);
    std::printf(
        "peak %.10g Hz %.10g, differs from that of the level alone by %.1e, %.1e; ended with %d, %d\n",
        here.frequency_hz, here.amplitude, here.frequency_hz / there.frequency_hz - 1,
        here.amplitude / there.amplitude - 1, static_cast<int>(curve.end_reason),
        static_cast<int>(alone.curve->end_reason));
}

void run(const Bench &b, double highest, bool check) {
    std::printf("| curve | force | r | points | iterations | failed steps | Gflop | s |\n"
                "|---|--:|--:|--:|--:|--:|--:|--:|\n");
    const Swept first = b.sweep(highest, nullptr), middle = b.sweep(0.5 * highest, nullptr);
    print_curve("one sweep", highest, first);
    print_curve("one sweep", 0.5 * highest, middle);
    plm::LevelBefore before;
    double gflop = 0, seconds = 0;
    for (int k = n_levels; k > 0; --k) {
        const double level = highest * k / n_levels;
        const Swept s = b.sweep(level, &before);
        gflop += s.gflop, seconds += s.seconds;
        print_curve("of the levels", level, s);
        if (check) compare(b, level, *s.curve);
    }
    std::printf("\n%d levels: %.3g Gflop, %.2f s: by work %.2f of the highest curve and %.2f of the middle "
                "one, by time %.2f and %.2f.\n",
                n_levels, gflop, seconds, gflop / first.gflop, gflop / middle.gflop, seconds / first.seconds,
                seconds / middle.seconds);
}

} // namespace

int main(int n, char **argument) {
    const char *name = n > 1 ? argument[1] : "cracked_plate", *size = n > 2 ? argument[2] : "quick";
    bool with_preload = true, check = false;
    double highest = 1;
    Bench b;
    Log log;
    for (int i = 3; i < n; ++i) {
        const std::string word = argument[i];
        if (word == "no-preload") with_preload = false;
        if (word == "check") check = true;
        if (word == "log") b.watch = plm::Watch(&log);
        if (word == "exact") b.options.motion = plm::MotionKind::exact;
        if (word == "harmonics") b.options.motion = plm::MotionKind::harmonics;
        if (const double level = std::strtod(argument[i], nullptr); level > 0) highest = level;
    }
    const SceneBasis made(name, size, with_preload);
    if (!made.core) {
        std::fprintf(stderr, "no scene %s, %s\n", name, size);
        return 1;
    }
    b.basis = made.core;
    b.dof = made.host->output_dof;
    run(b, highest, check);
    return 0;
}
