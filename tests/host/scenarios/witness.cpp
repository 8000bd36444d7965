#include "witness.hpp"
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace scenarios {

double processor_seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

Witness::Witness(Tally &tally, Random &random, const Limits &limits)
    : tally_(tally), random_(random), limits_(limits), scenario_began_(processor_seconds()) {}

void Witness::report(const char *what, const char *detail) {
    ++tally_.findings;
    std::printf("seed %llu: %s: %s %s\n", static_cast<unsigned long long>(tally_.seed), tally_.call, what,
                detail);
}

void Witness::begin(const char *call) {
    std::snprintf(tally_.call, sizeof tally_.call, "%s", call);
    call_began_ = heard_ = processor_seconds();
    asked_to_stop_ = -1;
}

plm_status Witness::end(plm_status status) {
    end_silence();
    check_stop();
    ++tally_.calls;
    if (status == PLM_CANCELLED) ++tally_.cancelled;
    ++(status == PLM_OK ? tally_.done : status > 0 ? tally_.outcomes : tally_.failures);
    if (status < PLM_ERR_INTERNAL || status > PLM_WARNING)
        report("returned a status that plm.h does not know");
    if (status < 0) read_failure(status);
    return status;
}

// A failure has a text that waits on the context, unless the handle was none of its own.
void Witness::read_failure(plm_status status) {
    char text[400] = "";
    std::int64_t needed = 0;
    if (!context_ || plm_context_get_error_text(context_, sizeof text, text, &needed) != PLM_OK) return;
    if (status == PLM_ERR_INTERNAL) report("PLM_ERR_INTERNAL:", text);
    if (needed <= 1 && status != PLM_ERR_HANDLE && status != PLM_ERR_MEMORY) report("failed without a text");
}

void Witness::end_silence() {
    const double now = processor_seconds(), silence = now - heard_;
    heard_ = now;
    if (silence > tally_.longest_silence) {
        tally_.longest_silence = silence;
        std::memcpy(tally_.silent_call, tally_.call, sizeof tally_.call);
    }
    char seconds[80];
    std::snprintf(seconds, sizeof seconds, "%.2f s of the processor's time", silence);
    if (silence > limits_.silence * limits_.slowness) report("no progress call for", seconds);
}

void Witness::check_stop() {
    if (asked_to_stop_ < 0) return;
    const double went_on = processor_seconds() - asked_to_stop_;
    if (went_on <= limits_.silence * limits_.slowness) return;
    char seconds[80];
    std::snprintf(seconds, sizeof seconds, "%.2f s", went_on);
    report("went on after a request to stop for", seconds);
}

void Witness::expect_finite(const double *values, std::size_t n, const char *what) {
    for (std::size_t i = 0; i < n; ++i) {
        if (std::isfinite(values[i])) continue;
        char detail[200];
        std::snprintf(detail, sizeof detail, "%s: entry %zu of %zu is %g", what, i, n, values[i]);
        return report("PLM_OK with a number that is none:", detail);
    }
}

bool Witness::out_of_time() const {
    return processor_seconds() - scenario_began_ > limits_.scenario * limits_.slowness;
}

void Witness::cancel_after(std::int64_t calls) {
    cancel_at_ = calls > 0 ? progress_calls_ + calls : 0;
}

std::int32_t Witness::on_progress(plm_context *context, const char *stage, double fraction, void *user) {
    return static_cast<Witness *>(user)->progress(context, stage, fraction);
}

std::int32_t Witness::progress(plm_context *context, const char *stage, double fraction) {
    ++progress_calls_;
    end_silence();
    if (!(fraction >= 0 && fraction <= 1)) {
        char detail[120];
        std::snprintf(detail, sizeof detail, "%g in stage \"%s\"", fraction, stage);
        report("a progress that is no fraction:", detail);
    }
    if (random_.chance(0.01)) call_from_inside(context);
    const bool late = processor_seconds() - call_began_ > limits_.call * limits_.slowness;
    if (!late && !(cancel_at_ > 0 && progress_calls_ >= cancel_at_)) return 0;
    if (asked_to_stop_ < 0) asked_to_stop_ = processor_seconds();
    return 1;
}

void Witness::call_from_inside(plm_context *context) {
    std::int64_t n = 0;
    const plm_status read = model_ ? plm_model_get_int(model_, "n_dof", &n) : PLM_ERR_STATE;
    if (read != PLM_ERR_STATE && read != PLM_ERR_HANDLE)
        report("a call from inside a callback was not refused");
    if (plm_context_destroy(&context) != PLM_ERR_STATE) report("a callback could destroy its context");
}

void *Memory::allocate(std::int64_t bytes, void *user) {
    Memory &memory = *static_cast<Memory *>(user);
    if (++memory.count_ == memory.fail_at_ || bytes > (std::int64_t(1) << 31)) return nullptr;
    return std::malloc(static_cast<std::size_t>(bytes));
}

void Memory::release(void *block, void *) {
    std::free(block);
}

} // namespace scenarios
