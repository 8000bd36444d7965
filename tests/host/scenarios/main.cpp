// scenarios [--seed FIRST] [--count N] [--seconds S] [--slowness F] [--here]
//
// Draws scenarios from seeds FIRST, FIRST + 1, ... (a fresh one by the clock when it is not given) until N
// are done or S seconds of the processor are spent. Each runs in a process of its own, which a crash or an
// endless loop ends alone; the command that repeats it is printed. --here: in this process, for a debugger.
// Exit code 1 when anything was found.
#include "scenario.hpp"
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace scenarios;

namespace {

struct Command {
    std::uint64_t seed = 0;
    long count = 1000000000;
    double seconds = 1e9;
    Limits limits;
    bool seeded = false, here = false;
};

constexpr double hanging = 20; // s of the processor for one scenario

Command read_command(int argc, char **argv) {
    Command c;
    for (int i = 1; i < argc; ++i) {
        const auto is = [&](const char *name) { return std::strcmp(argv[i], name) == 0; };
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (is("--here")) {
            c.here = true;
            continue;
        }
        if (is("--seed")) c.seed = std::strtoull(value, nullptr, 10), c.seeded = true;
        if (is("--count")) c.count = std::atol(value);
        if (is("--seconds")) c.seconds = std::atof(value);
        if (is("--slowness")) c.limits.slowness = std::atof(value);
        ++i;
    }
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    if (!c.seeded) // room for a day of scenarios between two seconds
        c.seed = static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::seconds>(now).count()) *
                 100000;
    return c;
}

// The children's own; a limit of the processor's time ends what runs on for ever.
int run_apart(Tally &tally, std::uint64_t seed, const Limits &limits, double &seconds) {
    std::fflush(stdout);
    const pid_t child = fork();
    if (child < 0) return -1;
    if (child == 0) {
        const auto most = static_cast<rlim_t>(hanging * limits.slowness);
        const rlimit limit = {most, most + 2};
        setrlimit(RLIMIT_CPU, &limit);
        Scenario(tally, seed, limits).run();
        std::fflush(stdout);
        _exit(0);
    }
    int how = 0;
    rusage used;
    wait4(child, &how, 0, &used);
    const auto of = [](const timeval &t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    seconds += of(used.ru_utime) + of(used.ru_stime);
    return how;
}

void repeat_by(const char *program, const Tally &tally, const Limits &limits) {
    std::printf("    repeat: %s --here --slowness %g --seed %llu\n", program, limits.slowness,
                static_cast<unsigned long long>(tally.seed));
}

bool ended_badly(const char *program, const Tally &tally, const Limits &limits, int how) {
    if (how == 0) return false;
    const int signal = WIFSIGNALED(how) ? WTERMSIG(how) : 0;
    const char *what = signal == SIGXCPU || signal == SIGKILL ? "HANGS" : "CRASHES";
    std::printf("seed %llu: %s (signal %d, exit code %d) in %s\n",
                static_cast<unsigned long long>(tally.seed), what, signal,
                WIFEXITED(how) ? WEXITSTATUS(how) : 0, tally.call);
    repeat_by(program, tally, limits);
    return true;
}

} // namespace

int main(int argc, char **argv) {
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    const Command command = read_command(argc, argv);
    void *shared = mmap(nullptr, sizeof(Tally), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) return 2;
    Tally &tally = *static_cast<Tally *>(shared);
    if (command.here) {
        Scenario(tally, command.seed, command.limits).run();
        std::printf("%ld calls, %ld findings\n", tally.calls, tally.findings);
        return tally.findings > 0;
    }
    std::printf("scenarios from seed %llu on\n", static_cast<unsigned long long>(command.seed));
    double seconds = 0;
    long bad = 0, done = 0;
    for (; done < command.count && seconds < command.seconds; ++done) {
        const long before = tally.findings;
        const int how =
            run_apart(tally, command.seed + static_cast<std::uint64_t>(done), command.limits, seconds);
        if (ended_badly(argv[0], tally, command.limits, how))
            ++bad;
        else if (tally.findings > before)
            ++bad, repeat_by(argv[0], tally, command.limits);
    }
    std::printf("%ld scenarios, %ld calls: %ld done, %ld with an outcome (%ld cancelled), %ld refused or "
                "failed; longest "
                "silence %.2f s in %s; %.0f s of the processor; %ld scenarios went wrong\n",
                done, tally.calls, tally.done, tally.outcomes, tally.cancelled, tally.failures,
                tally.longest_silence, tally.silent_call, seconds, bad);
    return bad > 0;
}
