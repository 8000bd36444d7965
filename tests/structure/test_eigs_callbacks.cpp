// The eigensolver amid callbacks and threads: its state is its own.
#include "matrices.hpp"
#include "structure/eigs.hpp"
#include "structure/solver/make_factor.hpp"
#include <chrono>
#include <future>
#include <thread>

using namespace test;

namespace {

const std::int64_t side = 20, wanted = 6;

vector<double> values_of(const SparseMatrix &k, const plm::Factor &factor,
                         const plm::EigsOptions &options = {}) {
    return plm::lowest_eigenpairs(k, diagonal(vector<double>(k.cols, 1.0)), factor, 0, wanted, options)
        .values;
}
vector<double> plain_values(const SparseMatrix &k) {
    return values_of(k, *plm::make_factor(k));
}

/// A factor that passes on to another and does something in the middle of the iteration.
class Intruder : public plm::Factor {
  public:
    Intruder(const SparseMatrix &k) : inner_(plm::make_factor(k)) {}
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        ++calls;
        inner_->solve(x, nrhs, ldx);
        if (calls == act_at) act(x);
    }
    double reciprocal_condition() const override { return 1; }
    std::int64_t factor_nonzeros() const override { return -1; }
    bool calls_host() const override { return true; }
    mutable int calls = 0;
    int act_at = 5;
    std::function<void(double *)> act = [](double *) {};

  private:
    std::unique_ptr<plm::Factor> inner_;
};

/// By the method for solvers that call the host.
vector<double> undisturbed_values(const SparseMatrix &k) {
    return values_of(k, Intruder(k));
}

void a_second_problem_inside_a_callback_and_the_first_are_right(void **) {
    const SparseMatrix k = membrane(side, side - 1), other = membrane(side, side + 5);
    const vector<double> reference = undisturbed_values(k), other_reference = plain_values(other);
    vector<double> inner;
    Intruder factor(k);
    factor.act = [&](double *) { inner = plain_values(other); };
    const vector<double> disturbed = values_of(k, factor);
    assert_true(inner == other_reference);
    assert_true(disturbed == reference);
}

/// A host's callback that waits for another thread which solves a problem of its own: with a lock held across
/// callbacks this never ends.
void a_callback_may_wait_for_another_thread_that_solves(void **) {
    const SparseMatrix k = membrane(side, side - 1), other = membrane(side, side + 5);
    const vector<double> reference = undisturbed_values(k), other_reference = plain_values(other);
    std::promise<vector<double>> solved; // lives as long as a thread that never gets there
    bool in_time = false;
    Intruder factor(k);
    std::thread second;
    factor.act = [&](double *) {
        second = std::thread([&] { solved.set_value(plain_values(other)); });
        in_time = solved.get_future().wait_for(std::chrono::seconds(60)) == std::future_status::ready;
    };
    const vector<double> values = values_of(k, factor);
    second.join();
    assert_true(in_time);
    assert_true(values == reference);
}

void an_exception_in_the_solver_passes_through(void **) {
    const SparseMatrix k = membrane(side, side - 1);
    const vector<double> reference = undisturbed_values(k);
    Intruder factor(k);
    factor.act = [](double *) { throw plm::Error(plm::status::callback, "host").library_code(9); };
    const auto o = outcome_of([&] { values_of(k, factor); });
    Intruder poisoned(k);
    poisoned.act = [](double *x) { x[0] = std::nan(""); };
    const auto nan = outcome_of([&] { values_of(k, poisoned); });
    const vector<double> after = undisturbed_values(k);
    assert_int_equal(o.status, plm::status::callback);
    assert_int_equal(o.code, 9);
    assert_int_equal(nan.status, plm::status::eigensolver);
    assert_true(after == reference);
}

void cancelling_stops_between_operations(void **) {
    const SparseMatrix k = membrane(side, side - 1);
    int polls = 0;
    plm::EigsOptions options;
    options.cancelled = [&] { return ++polls == 10; };
    const auto o = outcome_of([&] { values_of(k, Intruder(k), options); });
    int at_once = 0;
    options.cancelled = [&] { return ++at_once == 1; }; // what takes an instant is asked for once, before
    const auto quick = outcome_of([&] { values_of(k, *plm::make_factor(k), options); });
    const vector<double> reference = plain_values(k);
    assert_int_equal(o.status, plm::status::cancelled);
    assert_int_equal(o.reason, plm::reason::cancelled);
    assert_int_equal(polls, 10);
    assert_int_equal(quick.status, plm::status::cancelled);
    assert_int_equal(reference.size(), wanted);
}

void too_few_restarts_are_made_up_for_or_reported(void **) {
    const SparseMatrix k = membrane(60, 60), m = diagonal(vector<double>(k.cols, 1.0));
    plm::EigsOptions options;
    options.max_restarts = 1; // too few at first; the retry takes more Lanczos vectors
    const auto retried = outcome_of([&] { values_of(k, *plm::make_factor(k), options); });
    // seen from far below all eigenvalues (0 < lambda < 8) are the same to six digits
    const double shift = -1e7;
    const auto far = plm::make_factor(plm::add(1, k, -shift, m));
    const auto hopeless = outcome_of([&] { plm::lowest_eigenpairs(k, m, *far, shift, wanted, options); });
    assert_int_equal(retried.status, plm::status::ok);
    assert_int_equal(hopeless.status, plm::status::eigensolver);
}

void two_threads_at_once_get_the_right_values(void **) {
    const SparseMatrix a = membrane(side, side - 1), b = membrane(side + 4, side);
    const vector<double> exact_a = plain_values(a), exact_b = plain_values(b);
    int wrong[2] = {0, 0};
    const auto work = [](const SparseMatrix &k, const vector<double> &exact, int *bad) {
        for (int round = 0; round < 20; ++round) {
            vector<double> values;
            const auto o = outcome_of([&] { values = plain_values(k); });
            bool same = o.status == plm::status::ok && values.size() == exact.size();
            for (std::size_t i = 0; same && i < exact.size(); ++i)
                same = std::fabs(values[i] - exact[i]) < 1e-11 * exact[i];
            *bad += !same;
        }
    };
    std::thread first([&] { work(a, exact_a, &wrong[0]); });
    std::thread second([&] { work(b, exact_b, &wrong[1]); });
    first.join();
    second.join();
    assert_int_equal(wrong[0] + wrong[1], 0);
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_second_problem_inside_a_callback_and_the_first_are_right),
        cmocka_unit_test(a_callback_may_wait_for_another_thread_that_solves),
        cmocka_unit_test(an_exception_in_the_solver_passes_through),
        cmocka_unit_test(cancelling_stops_between_operations),
        cmocka_unit_test(too_few_restarts_are_made_up_for_or_reported),
        cmocka_unit_test(two_threads_at_once_get_the_right_values),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
