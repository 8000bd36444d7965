// The cracked plate with an isolated branch, from the host's arrays through the C API to the search: 150 x 60
// x 5 mm, crack at a quarter of the length, 7 of 13 rows deep, closed at rest by an even pressure on its end,
// Q = 500.
#include "capi/handles.hpp"
#include "hbm/isolated.hpp"
#include "support/test.hpp"
extern "C" {
#include "cracked_plate.h"
#include "scene_model.h"
}
#include <cmath>

namespace {

struct Plate {
    plm_context *context = nullptr;
    scene *host = nullptr;
    std::shared_ptr<const plm::ReducedModel> reduced;
    ~Plate() {
        plm_context_destroy(&context);
        scene_destroy(&host);
    }
};

bool build(Plate &plate) {
    cracked_plate_params p;
    cracked_plate_paper(&p);
    p.nx = 24, p.ny = 13, p.nz = 1;
    p.crack_position = 37.5;
    p.crack_rows = 7;
    p.contact_stiffness = -1;
    p.quality_factor = 500;
    p.quality_frequency_hz = 1500;
    p.with_preload = 1;
    p.n_loads = 0;
    p.end_compression = 92;
    plm_model *model = nullptr;
    plm_sampler *sampler = nullptr;
    plm_basis *basis = nullptr;
    if (cracked_plate_create(&p, &plate.host) || plm_context_create(PLM_API_VERSION, &plate.context))
        return false;
    plm_context *c = plate.context;
    must(c, scene_to_model(c, plate.host, &model), "model");
    must(c, plm_sampler_create(model, &sampler), "sampler");
    must(c, plm_sampler_set_string(sampler, "system", "open"), "system");
    must(c, plm_sampler_set_int(sampler, "mode", 3), "mode");
    must(c, plm_sampler_set_int(sampler, "n_samples", 6), "n_samples");
    must(c, plm_sampler_run(sampler), "sampler run");
    must(c, plm_basis_create(model, &basis), "basis");
    must(c, plm_basis_set_sampler(basis, sampler), "basis sampler");
    must(c, plm_basis_build(basis), "basis build");
    plate.reduced = plm::capi::find<plm::capi::BasisHandle>(basis)->core->reduced();
    return true;
}

double highest(const plm::Branch &b, std::int64_t dof, double &at) {
    double best = 0;
    for (std::size_t i = 0; i < b.points().size(); ++i) {
        const double a = b.amplitude(static_cast<std::int64_t>(i), dof, plm::Measure::half_peak_to_peak, 0);
        if (a > best) best = a, at = b.points()[i].omega / (2 * M_PI);
    }
    return best;
}

struct Found {
    bool built = false, closed = false, tracked = false;
    std::size_t count = 0, merged = 9;
    double main = 0, main_hz = 0, top = 0, top_hz = 0, birth = 0, merge = 0, seconds = 0, above = 0,
           above_hz = 0;
};
Found find() {
    Found f;
    Plate plate;
    f.built = build(plate);
    if (!f.built) return f;
    plm::HbmOptions o;
    o.n_harmonics = 5;
    o.frequency_min_hz = 1250;
    o.frequency_max_hz = 2100;
    o.force_scale = 0.5;
    const std::int64_t dof = plate.host->output_dof;
    const auto main = plm::Hbm(plate.reduced, 0, 0, o, plm::Watch()).sweep();
    const auto all = plm::find_isolated(plate.reduced, o, *main, 0, plm::Watch());
    f.main = highest(*main, dof, f.main_hz);
    f.seconds = all.seconds;
    f.count = all.branches.size();
    if (f.count != 1) return f;
    const plm::IsolatedBranch &i = all.branches[0];
    f.closed = i.closed, f.tracked = i.tracked;
    f.birth = i.birth_force, f.merge = i.merge_force;
    f.top = highest(*i.branch, dof, f.top_hz);
    o.force_scale = 1.005 * f.merge;
    f.above = highest(*plm::Hbm(plate.reduced, 0, 0, o, plm::Watch()).sweep(), dof, f.above_hz);
    return f;
}
void the_plates_isola_is_found(void **) {
    const Found f = find();
    std::printf(
        "    0.5 N: main peak %.2e mm at %.1f Hz, isola %.2e mm at %.1f Hz, exists for %.4f < F < %.4f N; "
        "%.2f s\n    above the merger: main peak %.2e mm at %.1f Hz\n",
        f.main, f.main_hz, f.top, f.top_hz, f.birth, f.merge, f.seconds, f.above, f.above_hz);
    assert_true(f.built);
    assert_int_equal(f.count, 1);
    assert_true(f.closed && f.tracked);
    assert_true(f.top > 3 * f.main && f.top_hz < 0.95 * f.main_hz);
    assert_true(close_to(f.birth, 0.1598, 0.02)); // of the Craig-Bampton model of the scene, H = 5
    assert_true(close_to(f.merge, 0.844, 0.02));
    assert_true(f.above > 3 * f.main); // the main branch has swallowed it
}

} // namespace

int main() {
    const CMUnitTest tests[] = {cmocka_unit_test(the_plates_isola_is_found)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
