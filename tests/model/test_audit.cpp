// The audit states facts of a sound model and finds what is wrong with an unsound one.
#include "model/audit.hpp"
#include "spring_models.hpp"
#include "support/test.hpp"
#include <algorithm>

using plm::Finding;
using plm::ModelInput;

namespace {

ModelInput sound() {
    test::Dense k = test::free_chain(6, 1e4);
    k[0][0] += 1e4;
    ModelInput in = test::input(test::diagonal(6, 0.5), k);
    test::add_pair(in, {0, 0, 1, 0, 0, -1}, PLM_AUTO_STIFFNESS, 0.1);
    in.damping.beta = 1e-5;
    in.excitation[1].real = {0, 0, 0, 0, 0, 1};
    return in;
}

std::vector<Finding> findings(const ModelInput &in) {
    return plm::audit(*test::build(in));
}

const Finding *with(const std::vector<Finding> &list, const char *words) {
    const auto found = std::find_if(
        list.begin(), list.end(), [&](const Finding &f) { return f.text.find(words) != std::string::npos; });
    return found == list.end() ? nullptr : &*found;
}

bool warns(const ModelInput &in, const char *words, int severity) {
    const std::vector<Finding> list = findings(in);
    const Finding *f = with(list, words);
    if (!f || f->severity != severity)
        for (const Finding &x : list) std::printf("    %d %s\n", x.severity, x.text.c_str());
    return f && f->severity == severity;
}

void sound_model_has_facts_only(void **) {
    const std::vector<Finding> list = findings(sound());
    for (const Finding &f : list) {
        if (f.severity) std::printf("    %s\n", f.text.c_str());
        assert_int_equal(f.severity, 0);
    }
    assert_true(close_to(with(list, "direction x")->value, 1.0, 1e-14)); // DOFs 0 and 3
    assert_true(close_to(with(list, "of the local stiffness")->value, 10, 1e-9));
    assert_true(with(list, "no rigid-body mode") != nullptr);
}

void unsound_models_are_found_out(void **) {
    ModelInput in = sound();
    in.damping.beta = 0;
    assert_true(warns(in, "no damping", 1));
    in = sound(), in.excitation.clear();
    assert_true(warns(in, "no harmonic excitation", 1));
    in = sound(), in.initial_gap[0] = -0.1;
    assert_true(warns(in, "interference", 1));
    in = sound(), test::add_pair(in, {0, 0, 1, 0, 0, -1}, 1e4);
    assert_true(warns(in, "repeat", 2));
    in = sound(), in.contact_stiffness[0] = 1e9;
    assert_true(warns(in, "small loops", 1));
    in = sound(), in.contact_stiffness[0] = 1;
    assert_true(warns(in, "below 0.1", 1));
    in = sound(), in.gap_coefficient[1] = -0.5;
    assert_true(warns(in, "do not sum to zero", 1));
    in = sound(), in.mass = test::matrix(test::diagonal(6, 0.5e14));
    assert_true(warns(in, "units", 2));
    test::Dense m = test::diagonal(6, 0.5);
    m[4][4] = 0;
    in = sound(), in.mass = test::matrix(m);
    assert_true(warns(in, "no mass", 1));
    in = sound(), in.stiffness = test::matrix(test::free_chain(6, 1e4));
    assert_true(warns(in, "1 rigid-body modes", 0));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(sound_model_has_facts_only),
        cmocka_unit_test(unsound_models_are_found_out),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
