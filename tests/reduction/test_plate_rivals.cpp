// Bilinear modes (Saito and Epureanu 2011) and discontinuity vectors (Segalman 2007) on the cracked plate:
// what the papers state of them.
#include "capi/handles.hpp"
#include "linalg/lapack.hpp"
#include "motions/responses.hpp"
#include "reduction/basis.hpp"
#include "reduction/bilinear_modes.hpp"
#include "reduction/discontinuity.hpp"
#include "rival_cases.hpp"
#include "searches/hbm.hpp"
extern "C" {
#include "cracked_plate.h"
#include "scene_model.h"
}

using namespace rival;
namespace basis_kinds = plm::basis_kinds;
using plm::Matrix;

namespace {

struct Plate {
    plm_context *context = nullptr;
    plm_model *model = nullptr;
    scene *host = nullptr;
    std::shared_ptr<const plm::Sampler> sampler; // for the window
    std::shared_ptr<const plm::Basis> full;
    plm::Peak truth;
    explicit Plate(bool with_preload) {
        cracked_plate_params p;
        cracked_plate_quick(&p);
        p.with_preload = with_preload;
        if (cracked_plate_create(&p, &host) || plm_context_create(PLM_API_VERSION, &context)) return;
        must(context, scene_to_model(context, host, &model), "model");
        plm::SamplerOptions o;
        o.system = plm::LinearSystem::open;
        o.mode = host->dominant_mode;
        const auto core = plm::capi::find<plm::capi::ModelHandle>(model)->core;
        sampler = std::make_shared<const plm::Sampler>(core, o, plm::Watch());
        full = basis(kind(&basis_kinds::full));
        truth = peak(full->reduced());
    }
    ~Plate() {
        plm_context_destroy(&context);
        scene_destroy(&host);
    }
    std::shared_ptr<const plm::Basis> basis(const plm::BasisOptions &o) const {
        const auto core = plm::capi::find<plm::capi::ModelHandle>(model)->core;
        return std::make_shared<const plm::Basis>(core, sampler, nullptr, o, plm::Watch());
    }
    Window window() const { return {sampler->window().min_hz, sampler->window().max_hz}; }
    plm::Peak peak(const std::shared_ptr<const plm::ReducedModel> &reduced) const {
        return peak_on(reduced, window(), host->output_dof);
    }
    PeakError error(const std::shared_ptr<const plm::ReducedModel> &reduced) const {
        const PeakError e = error_of(peak(reduced), truth);
        std::printf("    %3d columns: error %.1e in frequency, %.1e in amplitude\n",
                    static_cast<int>(reduced->size()), e.frequency, e.amplitude);
        return e;
    }
    plm::SelectionRule rule(double below_factor) const {
        plm::SelectionRule r;
        r.min_hz = window().min_hz;
        r.max_hz = window().max_hz;
        r.below_factor = below_factor;
        return r;
    }
};

// Saito and Epureanu: a few bilinear modes give the resonance of a crack that opens and closes; as many modes
// of the open system do not.
void bilinear_modes_find_the_resonance_that_open_modes_miss(void **) {
    const Plate plate(false);
    const auto bilinear = plate.basis(kind(&basis_kinds::bilinear));
    const PeakError b = plate.error(bilinear->reduced()),
                    o = plate.error(span_of(*plate.full->space(), linear_modes(*plate.full->space(), false,
                                                                               bilinear->reduced()->size())));
    assert_true(below(b.frequency, 5e-6) && below(b.amplitude, 5e-5));
    assert_true(o.frequency > 5e-3 && o.amplitude > 0.05);
    assert_int_equal(bilinear->report().samples.size(), 2);
}

// Share of the motions of the whole curve (proper orthogonal modes of the unreduced solution) outside a span,
// M-norm.
double outside(const plm::ReducedModel &proper, const plm::Space &space, const Matrix &columns,
               std::int64_t which) {
    const Matrix y = plm::condition_columns(space, columns, 1e-8).coordinates.y;
    const Matrix c = gram(space.vectors, space.model->mass_times(plm::columns(proper.vectors, which, 1)));
    plm::vector<double> rest(c.data(), c.data() + c.rows());
    const double size = plm::norm2(c.rows(), rest.data());
    const Matrix eta = plm::product('T', 'N', y, c);
    plm::gemv('N', -1.0, y, eta.data(), 1.0, rest.data());
    return plm::norm2(c.rows(), rest.data()) / size;
}

// Saito and Epureanu: the space of the dominant proper orthogonal modes is well approximated by bilinear
// modes.
void proper_orthogonal_modes_lie_in_the_span_of_bilinear_modes(void **) {
    const Plate plate(false);
    plm::HbmOptions o;
    o.n_harmonics = 5;
    o.stability = plm::StabilityKind::off;
    const plm::Hbm hbm(plate.full->reduced(), plate.window().min_hz, plate.window().max_hz, o, plm::Watch());
    const plm::Responses motions = plm::responses_of({hbm.sweep()});
    plm::BasisOptions po = kind(&basis_kinds::pod);
    po.pod_size = 3;
    const plm::Basis proper(plate.full->model(), nullptr, plate.full, po, plm::Watch(), &motions);
    const plm::Space &space = *plate.full->space();
    const Matrix bilinear = plm::collect_bilinear_modes(space, plate.rule(1.1), plm::Watch()).columns,
                 open = linear_modes(space, false, bilinear.cols());
    for (std::int64_t k = 0; k < 3; ++k) {
        const double b = outside(*proper.reduced(), space, bilinear, k),
                     l = outside(*proper.reduced(), space, open, k);
        std::printf("    motion %d: %.1e outside the bilinear modes, %.1e outside as many open modes\n",
                    static_cast<int>(k) + 1, b, l);
        assert_true(below(b, 2e-3) && b < l);
        if (k == 2) assert_true(l > 0.1); // the opened crack stands wide where the sliding one is shut
    }
}

Matrix reference_modes(const plm::Space &space, const plm::PairStates &reference, std::int64_t n) {
    return plm::modes_of_contact_set(space, reference, infinite).vectors.columns(0, n);
}

// Segalman: linear modes with discontinuous vectors capture the dynamics with few of them. Here 15 jumps do
// what dozens of modes do not. The reference systems are the closed crack and the one partly closed at rest.
void discontinuity_vectors_replace_dozens_of_linear_modes(void **) {
    for (const bool with_preload : {false, true}) {
        const Plate plate(with_preload);
        const plm::Space &space = *plate.full->space();
        const plm::DiscontinuousModes d = plm::discontinuous_modes(space, plate.rule(1.1), 0, plm::Watch());
        const PeakError jumps = plate.error(span_of(space, d.columns)),
                        as_many = plate.error(
                            span_of(space, reference_modes(space, d.reference, d.columns.cols()))),
                        most = plate.error(span_of(space, reference_modes(space, d.reference, 50)));
        assert_int_equal(d.n_modes + 15, d.columns.cols());
        assert_true(d.columns.cols() < 30);
        assert_true(below(jumps.frequency, 3e-5) && below(jumps.amplitude, 1e-3));
        assert_true(as_many.frequency > 1e-3 && as_many.amplitude > 1e-2);
        assert_true(most.frequency > 10 * jumps.frequency && most.amplitude > 10 * jumps.amplitude);
    }
}

void the_softest_jumps_come_first(void **) {
    const Plate plate(false);
    const plm::Space &space = *plate.full->space();
    double before = 1;
    for (std::int64_t n : {1, 4, 8, 15}) {
        const plm::DiscontinuousModes d = plm::discontinuous_modes(space, plate.rule(1.1), n, plm::Watch());
        assert_int_equal(d.columns.cols(), d.n_modes + n);
        assert_true(std::is_sorted(d.energy.rbegin(), d.energy.rend()) && d.energy[0] == 1);
        const double error = plate.error(span_of(space, d.columns)).frequency;
        assert_true(below(error, before));
        before = error;
    }
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(bilinear_modes_find_the_resonance_that_open_modes_miss),
        cmocka_unit_test(proper_orthogonal_modes_lie_in_the_span_of_bilinear_modes),
        cmocka_unit_test(discontinuity_vectors_replace_dozens_of_linear_modes),
        cmocka_unit_test(the_softest_jumps_come_first),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
