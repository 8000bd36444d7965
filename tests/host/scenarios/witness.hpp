// What is looked at in every call of a scenario: the status, the text of a failure, numbers that are none,
// how long the host hears nothing, how soon a request to stop is obeyed.
#pragma once
#include "random.hpp"
#include <cstddef>
#include <plm/plm.h>
#include <vector>

namespace scenarios {

/// Lives in memory that the parent shares with the process that runs scenarios, and outlives its crashes.
struct Tally {
    std::uint64_t seed; // of the scenario at work
    char call[160];     // the call at work
    long scenarios, calls, done, outcomes, failures, cancelled, findings;
    double longest_silence; // s of the processor's time without a word from the library
    char silent_call[160];
};

/// Times of the processor, so that a busy machine changes nothing; `slowness` stretches them for instrumented
/// builds.
struct Limits {
    double slowness = 1;
    double call = 1.5;     // s after which a call is asked to stop
    double scenario = 3.5; // s after which a scenario begins nothing new
    double silence = 1.0;  // s without a progress call, also after a request to stop
};

double processor_seconds();

class Witness {
  public:
    Witness(Tally &tally, Random &random, const Limits &limits);
    Witness(const Witness &) = delete;

    // A call: begin(), the call, end() with what it returned.
    void begin(const char *call);
    plm_status end(plm_status status);
    /// Results of a call that returned PLM_OK: finite. what: the key or the output.
    void expect_finite(const double *values, std::size_t n, const char *what);
    /// Notes a defect; the scenario goes on.
    void report(const char *what, const char *detail = "");

    bool out_of_time() const;
    /// The k-th progress call from now asks to stop; 0: none does.
    void cancel_after(std::int64_t calls);
    /// Handles for calls from inside a callback.
    void use(plm_context *context, plm_model *model) { context_ = context, model_ = model; }

    static std::int32_t on_progress(plm_context *context, const char *stage, double fraction, void *user);

  private:
    std::int32_t progress(plm_context *context, const char *stage, double fraction);
    void call_from_inside(plm_context *context);
    void end_silence();
    void check_stop();
    void read_failure(plm_status status);

    Tally &tally_;
    Random &random_;
    Limits limits_;
    plm_context *context_ = nullptr;
    plm_model *model_ = nullptr;
    double scenario_began_, call_began_ = 0, heard_ = 0, asked_to_stop_ = -1;
    std::int64_t progress_calls_ = 0, cancel_at_ = 0;
};

#define CALL(witness, function) ((witness).begin(#function), (witness).end(function))

/// malloc that fails at one chosen allocation, and for more than 2 GiB.
class Memory {
  public:
    explicit Memory(std::int64_t fail_at) : fail_at_(fail_at) {}
    static void *allocate(std::int64_t bytes, void *user);
    static void release(void *block, void *user);

  private:
    std::int64_t fail_at_, count_ = 0;
};

} // namespace scenarios
