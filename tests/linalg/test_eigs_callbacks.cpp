// The eigensolver amid callbacks and threads: ARPACK's hidden state must never be shared.
#include "linalg/eigs.hpp"
#include "support.hpp"
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
    return values_of(k, *plm::make_factor(k, plm::FactorKind::positive_definite));
}

/// A factor that passes on to another and does something in the middle of ARPACK's iteration.
class Intruder : public plm::Factor {
  public:
    Intruder(const SparseMatrix &k) : inner_(plm::make_factor(k, plm::FactorKind::positive_definite)) {}
    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        ++calls;
        inner_->solve(x, nrhs, ldx);
        if (calls == act_at) act(x);
    }
    std::int64_t negative_eigenvalues() const override { return 0; }
    double reciprocal_condition() const override { return 1; }
    std::int64_t factor_nonzeros() const override { return -1; }
    mutable int calls = 0;
    int act_at = 5;
    std::function<void(double *)> act = [](double *) {};

  private:
    std::unique_ptr<plm::Factor> inner_;
};

void a_second_problem_inside_a_callback_is_refused_and_harmless(void **) {
    const SparseMatrix k = membrane(side, side - 1), other = membrane(side, side + 5);
    const vector<double> reference = plain_values(k);
    Outcome inner;
    Intruder factor(k);
    factor.act = [&](double *) { inner = outcome_of([&] { plain_values(other); }); };
    const vector<double> disturbed = values_of(k, factor);
    const vector<double> after = plain_values(k); // the lock is free again
    assert_int_equal(inner.status, PLM_ERR_STATE);
    assert_true(disturbed == reference);
    assert_true(after == reference);
}

void an_exception_in_the_solver_passes_through_and_frees_the_lock(void **) {
    const SparseMatrix k = membrane(side, side - 1);
    const vector<double> reference = plain_values(k);
    Intruder factor(k);
    factor.act = [](double *) { throw plm::Error(PLM_ERR_CALLBACK, "host").library_code(9); };
    const auto o = outcome_of([&] { values_of(k, factor); });
    Intruder poisoned(k);
    poisoned.act = [](double *x) { x[0] = std::nan(""); };
    const auto nan = outcome_of([&] { values_of(k, poisoned); });
    const vector<double> after = plain_values(k);
    assert_int_equal(o.status, PLM_ERR_CALLBACK);
    assert_int_equal(o.code, 9);
    assert_int_equal(nan.status, PLM_ERR_EIGENSOLVER);
    assert_true(after == reference);
}

void cancelling_stops_between_operations(void **) {
    const SparseMatrix k = membrane(side, side - 1);
    int polls = 0;
    plm::EigsOptions options;
    options.cancelled = [&] { return ++polls == 10; };
    const auto o =
        outcome_of([&] { values_of(k, *plm::make_factor(k, plm::FactorKind::positive_definite), options); });
    const vector<double> reference = plain_values(k);
    assert_int_equal(o.status, PLM_CANCELLED);
    assert_int_equal(o.reason, PLM_REASON_CANCELLED);
    assert_int_equal(polls, 10);
    assert_int_equal(reference.size(), wanted);
}

void too_few_restarts_are_made_up_for_or_reported_with_arpacks_code(void **) {
    const SparseMatrix k = membrane(60, 60);
    const auto factor = plm::make_factor(k, plm::FactorKind::positive_definite);
    plm::EigsOptions options;
    options.max_restarts = 1; // too few at first; the retry takes more Lanczos vectors
    const auto retried = outcome_of([&] { values_of(k, *factor, options); });
    options.tolerance = 1e-300; // out of reach
    const auto hopeless = outcome_of([&] { values_of(k, *factor, options); });
    assert_int_equal(retried.status, PLM_OK);
    assert_int_equal(hopeless.status, PLM_ERR_EIGENSOLVER);
    assert_int_equal(hopeless.code, 1);
}

void two_threads_at_once_get_the_right_values(void **) {
    const SparseMatrix a = membrane(side, side - 1), b = membrane(side + 4, side);
    const vector<double> exact_a = plain_values(a), exact_b = plain_values(b);
    int wrong[2] = {0, 0};
    const auto work = [](const SparseMatrix &k, const vector<double> &exact, int *bad) {
        for (int round = 0; round < 20; ++round) {
            vector<double> values;
            const auto o = outcome_of([&] { values = plain_values(k); });
            bool same = o.status == PLM_OK && values.size() == exact.size();
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
        cmocka_unit_test(a_second_problem_inside_a_callback_is_refused_and_harmless),
        cmocka_unit_test(an_exception_in_the_solver_passes_through_and_frees_the_lock),
        cmocka_unit_test(cancelling_stops_between_operations),
        cmocka_unit_test(too_few_restarts_are_made_up_for_or_reported_with_arpacks_code),
        cmocka_unit_test(two_threads_at_once_get_the_right_values),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
