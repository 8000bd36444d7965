// Bases of kind "pod": what they keep of the parent (curve, orthonormality, damping, rest under pre-load),
// their size, and how good eight columns are for the cracked plate.
#include "capi/handles.hpp"
#include "linalg/lapack.hpp"
#include "motions/responses.hpp"
#include "orbits/periodicity.hpp"
#include "reduction/basis.hpp"
#include "sampling/small_models.hpp"
#include "searches/error_estimate.hpp"
#include "searches/hbm.hpp"
#include "support/test.hpp"
extern "C" {
#include "cracked_plate.h"
#include "scene_model.h"
}
#include <algorithm>
#include <vector>

using plm::Basis;
namespace basis_kinds = plm::basis_kinds;
using plm::BasisOptions;
using plm::HbmOptions;
using plm::Matrix;
using plm::Measure;

namespace {

using BasisPtr = std::shared_ptr<const Basis>;
using BranchPtr = std::shared_ptr<const plm::Branch>;

constexpr int n_chain = 12, watched = n_chain - 1;
constexpr Measure measure = Measure::half_peak_to_peak;

enum class DampingKind { rayleigh, modal, matrix };

exact::Structure structure(bool with_preload) {
    exact::Structure s = test::two_chains(n_chain, 4, 2, true);
    s.force.assign(s.n, 0.0);
    s.force[watched] = 0.05;
    s.preload.assign(s.n, 0.0);
    if (with_preload) {
        s.preload[watched] = 0.02;
        s.preload[2 * n_chain - 1] = -0.02;
    }
    s.damping.assign(s.n * s.n, 0.0); // not proportional: half of the masses are damped
    for (int i = 0; i < s.n; i += 2) s.damping[i * s.n + i] = 0.02;
    return s;
}
std::shared_ptr<const plm::Model> model_of(bool with_preload, DampingKind damping) {
    test::ModelExtras extras;
    if (damping == DampingKind::rayleigh) extras.beta = 0.3;
    if (damping == DampingKind::modal) extras.modal_ratio = {0.02, 0.03, 0.01};
    if (damping == DampingKind::matrix) extras.explicit_damping = true;
    return test::make_model(structure(with_preload), extras);
}

HbmOptions five_harmonics() {
    HbmOptions o;
    o.n_harmonics = 5;
    o.stability = plm::StabilityKind::off;
    o.bifurcations = false;
    return o;
}

struct Curve {
    BasisPtr basis;
    BranchPtr branch;
};
Curve curve_on(BasisPtr basis) {
    Curve c;
    c.branch = plm::Hbm(basis->reduced(), basis->window_min_hz(), basis->window_max_hz(), five_harmonics(),
                        plm::Watch())
                   .sweep();
    c.basis = std::move(basis);
    return c;
}
Curve parent_curve(std::shared_ptr<const plm::Model> model) {
    plm::SamplerOptions so;
    so.system = plm::LinearSystem::open;
    so.mode = 2;
    so.n_samples = 2;
    so.n_harmonics = 5; // those of the curve
    const auto sampler = std::make_shared<const plm::Sampler>(model, so, plm::Watch());
    return curve_on(
        std::make_shared<const Basis>(std::move(model), sampler, nullptr, BasisOptions(), plm::Watch()));
}
BasisPtr compressed(const Curve &parent, double tolerance, std::int64_t size = 0) {
    BasisOptions o;
    o.kind = &basis_kinds::pod;
    o.pod_tolerance = tolerance;
    o.pod_size = size;
    const plm::Responses responses = plm::responses_of({parent.branch});
    return std::make_shared<const Basis>(parent.basis->model(), nullptr, parent.basis, o, plm::Watch(),
                                         &responses);
}

// Largest difference of the amplitude at the parent's frequencies, over the peak. The curve folds: solutions
// on both are those that a cold start comes to.
double difference(const Curve &parent, const Basis &pod) {
    const auto solver_on = [](const Basis &basis) {
        return plm::Hbm(basis.reduced(), basis.window_min_hz(), basis.window_max_hz(), five_harmonics(),
                        plm::Watch());
    };
    const plm::Hbm hbm = solver_on(pod), own = solver_on(*parent.basis);
    double worst = 0, peak = 0;
    const std::int64_t n = static_cast<std::int64_t>(parent.branch->points().size());
    for (std::int64_t i = 0; i < n; i += 1 + n / 12) {
        const double hz = parent.branch->points()[i].omega / (2 * M_PI);
        const BranchPtr point = hbm.solve(hz, nullptr, 0), there = own.solve(hz, nullptr, 0);
        for (int dof : {watched, 0, n_chain}) {
            const double a = there->amplitude(0, dof, measure, 0);
            worst = std::max(worst, std::abs(point->amplitude(0, dof, measure, 0) - a));
            peak = std::max(peak, a);
        }
    }
    return worst / peak;
}

void without_tolerance_the_curve_is_the_parents(void **) {
    for (const DampingKind damping : {DampingKind::rayleigh, DampingKind::modal, DampingKind::matrix})
        for (const bool with_preload : {false, true}) {
            const Curve parent = parent_curve(model_of(with_preload, damping));
            assert_true(below(difference(parent, *compressed(parent, 0)), 1e-9));
        }
}

// A C that is diagonal in the parent's coordinates, but is no Rayleigh damping, stays what it is: with one
// mass there is nothing off the diagonal, with C = 0.07 K nothing either.
double difference_with_diagonal_matrix() {
    exact::Structure s = structure(false);
    for (int i = 0; i < s.n * s.n; ++i) s.damping[i] = 0.07 * s.stiffness[i];
    test::ModelExtras extras;
    extras.explicit_damping = true;
    const Curve parent = parent_curve(test::make_model(s, extras));
    return difference(parent, *compressed(parent, 0));
}
double difference_of_one_mass() {
    exact::Structure s = test::two_chains(1, 1, 2, true);
    s.force.assign(s.n, 0.0);
    s.force[0] = 0.05;
    s.damping.assign(s.n * s.n, 0.0);
    for (int i = 0; i < s.n; ++i) s.damping[i * s.n + i] = 0.1;
    test::ModelExtras extras;
    extras.explicit_damping = true;
    BasisOptions o;
    o.kind = &basis_kinds::full;
    o.frequency_min_hz = 0.05;
    o.frequency_max_hz = 0.4;
    const Curve parent = curve_on(
        std::make_shared<const Basis>(test::make_model(s, extras), nullptr, nullptr, o, plm::Watch()));
    const BasisPtr pod = compressed(parent, 0);
    double worst = 0;
    const plm::Hbm hbm(pod->reduced(), 0.05, 0.4, five_harmonics(), plm::Watch());
    for (const plm::BranchPoint &p : parent.branch->points()) {
        const std::int64_t i = &p - parent.branch->points().data();
        const double a = parent.branch->amplitude(i, 0, measure, 0);
        worst = std::max(
            worst,
            std::abs(hbm.solve(p.omega / (2 * M_PI), nullptr, 0)->amplitude(0, 0, measure, 0) / a - 1));
    }
    return worst;
}
void a_matrix_of_damping_that_happens_to_be_diagonal(void **) {
    assert_true(below(difference_with_diagonal_matrix(), 1e-9));
    assert_true(below(difference_of_one_mass(), 1e-7));
}

// The size asked for, never more than there is; the smaller the tolerance, the more columns and the smaller
// the error.
struct Sizes {
    std::vector<std::int64_t> by_size;
    std::vector<double> by_tolerance, errors;
    std::int64_t parent = 0, most = 0;
    bool singular_values = true;
};
Sizes sizes() {
    const Curve parent = parent_curve(model_of(true, DampingKind::rayleigh));
    Sizes s;
    s.parent = parent.basis->reduced()->size();
    for (std::int64_t n = 1; n <= 6; ++n) s.by_size.push_back(compressed(parent, 1e-5, n)->reduced()->size());
    s.most = compressed(parent, 1e-5, 1000)->reduced()->size();
    for (double tolerance : {1e-1, 1e-2, 1e-3, 1e-5, 1e-7}) {
        const BasisPtr pod = compressed(parent, tolerance);
        s.by_tolerance.push_back(static_cast<double>(pod->reduced()->size()));
        s.errors.push_back(difference(parent, *pod));
        const auto &values = pod->report().singular_values;
        s.singular_values =
            s.singular_values && values.front() == 1 && std::is_sorted(values.rbegin(), values.rend());
    }
    return s;
}
void the_size_is_what_was_asked_for(void **) {
    const Sizes s = sizes();
    for (std::int64_t n = 1; n <= 6; ++n) assert_int_equal(s.by_size[n - 1], n);
    assert_true(s.most > 6 && s.most <= s.parent);
    for (std::size_t k = 0; k < s.errors.size(); ++k)
        std::printf("    %d columns: %.1e\n", static_cast<int>(s.by_tolerance[k]), s.errors[k]);
    for (std::size_t k = 1; k < s.errors.size(); ++k)
        assert_true(s.by_tolerance[k] > s.by_tolerance[k - 1] && s.errors[k] < s.errors[k - 1]);
    assert_true(below(s.errors[3], 1e-3));
    assert_true(s.singular_values);
}

// P'^T M P' = I, P'^T K P' = diag(lambda), P'^T C P' is the damping, B P' the gaps; the same of P_0'.
double worst_of(const Matrix &got, const Matrix &want) {
    double worst = 0, largest = 0;
    for (std::int64_t j = 0; j < want.cols(); ++j)
        for (std::int64_t i = 0; i < want.rows(); ++i) {
            worst = std::max(worst, std::abs(got(i, j) - want(i, j)));
            largest = std::max(largest, std::abs(want(i, j)));
        }
    return largest > 0 ? worst / largest : worst;
}
Matrix projected(const plm::SparseMatrix &a, const Matrix &p) {
    Matrix ap(p.rows(), p.cols());
    for (std::int64_t j = 0; j < p.cols(); ++j) plm::multiply(a, p.col(j), ap.col(j));
    return plm::product('T', 'N', p, ap);
}
Matrix diagonal(const plm::vector<double> &d) {
    Matrix m(static_cast<std::int64_t>(d.size()), static_cast<std::int64_t>(d.size()));
    for (std::int64_t j = 0; j < m.cols(); ++j) m(j, j) = d[j];
    return m;
}
// Kerschen, Golinval, Vakakis & Bergman 2005 (Nonlinear Dynamics 41): of all bases of n vectors the proper
// orthogonal modes hold the most energy of the responses, and the proper orthogonal values tell how much.
struct Captured {
    double values, modes,
        coordinates; // share of the energy outside n vectors: by the singular values, found, of others
};
// Share of the motions outside the columns y, both in the coordinates of energy.
double outside(const Matrix &motions, const Matrix &y) {
    const Matrix u = plm::thin_svd(y).u;
    const Matrix inside = plm::product('T', 'N', u, motions);
    const double all = plm::norm2(motions.rows() * motions.cols(), motions.data());
    return 1 - std::pow(plm::norm2(inside.rows() * inside.cols(), inside.data()) / all, 2);
}
std::vector<Captured> captured() {
    BasisOptions full;
    full.kind = &basis_kinds::full;
    const Curve plm_curve = parent_curve(model_of(true, DampingKind::rayleigh));
    full.frequency_min_hz = plm_curve.basis->window_min_hz();
    full.frequency_max_hz = plm_curve.basis->window_max_hz();
    const Curve parent = curve_on(
        std::make_shared<const Basis>(plm_curve.basis->model(), nullptr, nullptr, full, plm::Watch()));
    const plm::Responses responses = plm::responses_of({parent.branch});
    const plm::ReducedModel &m = *parent.basis->reduced();
    Matrix motions = responses.dynamic;
    const auto to_energy =
        [&](Matrix &a) { // |a|^2 is then the energy: M = 1, K = diag(lambda) in these coordinates
            for (std::int64_t k = 0; k < a.cols(); ++k)
                for (std::int64_t j = 0; j < a.rows(); ++j)
                    a(j, k) *= std::sqrt(m.lambda[j] + responses.omega * responses.omega);
        };
    to_energy(motions);
    std::vector<Captured> all;
    for (std::int64_t n = 1; n <= 5; ++n) {
        const plm::Compressed pod = plm::compress(responses, 0, n);
        Matrix momentum(m.vectors.rows(), n), first(m.size(), n);
        for (std::int64_t j = 0; j < n; ++j)
            plm::multiply(m.model->matrices().mass, pod.reduced->vectors.formed().in_core().col(j),
                          momentum.col(j));
        Matrix y = plm::product('T', 'N', m.vectors.formed().in_core(), momentum);
        for (std::int64_t j = 0; j < n; ++j) first(j, j) = 1; // the lowest modes of the open structure
        to_energy(y);
        to_energy(first);
        double rest = 0, sum = 0;
        for (std::size_t k = 0; k < pod.singular_values.size(); ++k) {
            const double square = pod.singular_values[k] * pod.singular_values[k];
            sum += square;
            if (static_cast<std::int64_t>(k) >= n) rest += square;
        }
        all.push_back({rest / sum, outside(motions, y), outside(motions, first)});
    }
    return all;
}
void proper_orthogonal_modes_hold_the_most_energy(void **) {
    for (const Captured &c : captured()) {
        std::printf("    outside: %.3e, by the values %.3e, of as many open modes %.3e\n", c.modes, c.values,
                    c.coordinates);
        assert_true(below(std::abs(c.modes - c.values), 1e-9)); // rounding of 1 - 1
        assert_true(c.modes < 0.9 * c.coordinates);
    }
}

struct Projections {
    double mass = 1, stiffness = 1, damping = 1, mass_0 = 1, stiffness_0 = 1;
};
Projections projections(DampingKind damping, std::int64_t size) {
    const auto model = model_of(true, damping);
    const auto m = compressed(parent_curve(model), 1e-5, size)->reduced();
    const plm::vector<double> ones(m->size(), 1.0), ones_0(m->static_size(), 1.0);
    Projections p;
    p.mass = worst_of(projected(model->matrices().mass, m->vectors.formed().in_core()), diagonal(ones));
    p.stiffness =
        worst_of(projected(model->matrices().stiffness, m->vectors.formed().in_core()), diagonal(m->lambda));
    p.mass_0 =
        worst_of(projected(model->matrices().mass, m->static_vectors().formed().in_core()), diagonal(ones_0));
    p.stiffness_0 = worst_of(projected(model->matrices().stiffness, m->static_vectors().formed().in_core()),
                             diagonal(m->lambda_0));
    const Matrix c = m->damping.empty() ? diagonal(m->damping_diagonal) : m->damping;
    if (damping == DampingKind::matrix)
        p.damping = worst_of(projected(model->matrices().damping, m->vectors.formed().in_core()), c);
    if (damping == DampingKind::rayleigh) {
        Matrix wanted = diagonal(m->lambda);
        for (std::int64_t j = 0; j < m->size(); ++j) wanted(j, j) *= 0.3;
        p.damping = worst_of(c, wanted);
    }
    return p;
}
void the_columns_are_mass_normalised(void **) {
    for (const DampingKind damping : {DampingKind::rayleigh, DampingKind::matrix})
        for (std::int64_t size : {0, 3}) {
            const Projections p = projections(damping, size);
            assert_true(below(p.mass, 1e-10) && below(p.mass_0, 1e-10));
            assert_true(below(p.stiffness, 1e-9) && below(p.stiffness_0, 1e-9));
            assert_true(below(p.damping, 1e-9));
        }
}

// Motions in time live in the coordinates of P_0, which must hold P: multipliers and the exact flow of the
// same point on both bases.
struct InTime {
    double span = 1, multipliers = 1, defect = 1;
};
InTime in_time(bool with_preload, DampingKind damping, double tolerance) {
    const Curve parent = parent_curve(model_of(with_preload, damping));
    const BasisPtr pod = compressed(parent, tolerance);
    InTime t;
    t.span = 0;
    const plm::ReducedModel &m = *pod->reduced();
    Matrix momentum(m.vectors.rows(), m.vectors.cols());
    for (std::int64_t j = 0; j < m.size(); ++j)
        plm::multiply(m.model->matrices().mass, m.vectors.formed().in_core().col(j), momentum.col(j));
    const Matrix inside = plm::product('T', 'N', m.static_vectors().formed().in_core(), momentum);
    for (std::int64_t j = 0; j < m.size(); ++j)
        t.span = std::max(t.span, std::abs(plm::norm2(inside.rows(), inside.col(j)) - 1));
    HbmOptions o = five_harmonics();
    o.n_harmonics = 20;
    o.stability = plm::StabilityKind::floquet;
    const double hz = 0.5 * (pod->window_min_hz() + pod->window_max_hz());
    double largest[2] = {0, 0}, defect[2] = {0, 0};
    for (int k = 0; k < 2; ++k) {
        const Basis &b = k ? *pod : *parent.basis;
        const BranchPtr point = plm::Hbm(b.reduced(), b.window_min_hz(), b.window_max_hz(), o, plm::Watch())
                                    .solve(hz, nullptr, 0);
        for (const auto &mu : point->points()[0].multipliers) largest[k] = std::max(largest[k], std::abs(mu));
        defect[k] = plm::periodicity_defect(*point, 0);
    }
    t.multipliers = largest[0] > 0 ? std::abs(largest[1] / largest[0] - 1) : 1;
    t.defect = std::abs(defect[1] - defect[0]);
    std::printf("    largest multiplier %.6f and %.6f, defect %.1e and %.1e\n", largest[0], largest[1],
                defect[0], defect[1]);
    return t;
}
void motions_in_time_are_the_parents(void **) {
    for (const bool with_preload : {false, true})
        for (const DampingKind damping : {DampingKind::rayleigh, DampingKind::matrix}) {
            const InTime t = in_time(with_preload, damping, 1e-7);
            assert_true(below(t.span, 1e-9));
            assert_true(below(t.multipliers, 1e-4) && below(t.defect, 1e-5));
        }
}

// Rest under the pre-load: the displacement of a point at vanishing force.
double difference_at_rest() {
    const Curve parent = parent_curve(model_of(true, DampingKind::rayleigh));
    const BasisPtr pod = compressed(parent, 1e-5);
    HbmOptions o = five_harmonics();
    o.force_scale = 0;
    plm::Field q[2];
    for (int k = 0; k < 2; ++k) {
        const Basis &b = k ? *pod : *parent.basis;
        q[k] = plm::Hbm(b.reduced(), b.window_min_hz(), b.window_max_hz(), o, plm::Watch())
                   .solve(b.window_min_hz(), nullptr, 0)
                   ->field(0, 0.0);
    }
    double worst = 0, largest = 0;
    for (std::int64_t i = 0; i < q[0].rows(); ++i) {
        worst = std::max(worst, std::abs(q[1].at(i) - q[0].at(i)));
        largest = std::max(largest, std::abs(q[0].at(i)));
    }
    return largest > 0 ? worst / largest : 1;
}
void the_rest_under_preload_is_kept(void **) {
    assert_true(below(difference_at_rest(), 1e-3));
}

// Symmetric motion between two stops has no mean part, but P_0 holds P.
struct WithoutMean {
    std::int64_t r_0 = -1;
    double error = 1;
};
WithoutMean without_mean() {
    plm_context *c = nullptr;
    plm_model *model = nullptr;
    const std::int32_t zero[] = {0}, row_ptr[] = {0, 1, 2}, dof[] = {0, 0};
    const double one[] = {1}, damping[] = {0.2}, coefficient[] = {1, -1}, stop[] = {3, 3}, gap[] = {0.4, 0.4};
    plm_context_create(PLM_API_VERSION, &c);
    must(c, plm_model_create(c, 1, &model), "create");
    must(c,
         plm_model_set_matrix_i32(model, PLM_MASS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, zero, zero, one),
         "M");
    must(c,
         plm_model_set_matrix_i32(model, PLM_STIFFNESS, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, zero, zero,
                                  one),
         "K");
    must(c,
         plm_model_set_matrix_i32(model, PLM_DAMPING, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY, 1, zero, zero,
                                  damping),
         "C");
    must(c, plm_model_add_gap_rows_i32(model, 0, 2, row_ptr, dof, coefficient, stop, gap), "stops");
    must(c, plm_model_set_excitation(model, 1, 1, one, nullptr), "force");
    must(c, plm_model_build(model), "build");
    WithoutMean w;
    {
        BasisOptions o;
        o.kind = &basis_kinds::full;
        o.frequency_min_hz = 0.1;
        o.frequency_max_hz = 0.4;
        const Curve parent = curve_on(std::make_shared<const Basis>(
            plm::capi::find<plm::capi::ModelHandle>(model)->core, nullptr, nullptr, o, plm::Watch()));
        const BasisPtr pod = compressed(parent, 1e-5);
        w.r_0 = pod->reduced()->static_size();
        const Curve again = curve_on(pod);
        double top[2] = {0, 0};
        for (int k = 0; k < 2; ++k) {
            const plm::Branch &b = k ? *again.branch : *parent.branch;
            const Basis &basis = k ? *pod : *parent.basis;
            top[k] = plm::Hbm(basis.reduced(), 0.1, 0.4, five_harmonics(), plm::Watch())
                         .find_peak(b, 0, measure, 0)
                         .amplitude;
        }
        w.error = std::abs(top[1] / top[0] - 1);
    }
    plm_context_destroy(&c);
    return w;
}
void motions_without_a_mean_part(void **) {
    const WithoutMean w = without_mean();
    std::printf("    %d columns for the mean, peak off by %.1e\n", static_cast<int>(w.r_0), w.error);
    assert_int_equal(w.r_0, 1);
    assert_true(below(w.error, 1e-7));
}

// The cracked plate: eight columns.
struct Plate {
    double amplitude = 1, frequency = 1, estimated_amplitude = 1, estimated_frequency = 1;
    std::int64_t size = 0;
};
Plate plate_with_eight_columns() {
    Plate out;
    cracked_plate_params params;
    cracked_plate_quick(&params);
    params.with_preload = 1;
    scene *host = nullptr;
    plm_context *c = nullptr;
    plm_model *model = nullptr;
    if (cracked_plate_create(&params, &host) || plm_context_create(PLM_API_VERSION, &c)) return out;
    must(c, scene_to_model(c, host, &model), "model");
    {
        const auto core = plm::capi::find<plm::capi::ModelHandle>(model)->core;
        plm::SamplerOptions so;
        so.system = plm::LinearSystem::open;
        so.mode = host->dominant_mode;
        so.n_samples = 4;
        const auto sampler = std::make_shared<const plm::Sampler>(core, so, plm::Watch());
        const Curve parent =
            curve_on(std::make_shared<const Basis>(core, sampler, nullptr, BasisOptions(), plm::Watch()));
        const Curve truth = curve_on(plm::unreduced_basis(parent.basis, plm::Watch()));
        const Curve pod = curve_on(compressed(parent, 1e-5, 8));
        const auto peak = [&](const Curve &of) {
            return plm::Hbm(of.basis->reduced(), of.basis->window_min_hz(), of.basis->window_max_hz(),
                            five_harmonics(), plm::Watch())
                .find_peak(*of.branch, host->output_dof, measure, 0);
        };
        const plm::Peak right = peak(truth), got = peak(pod);
        const plm::ErrorEstimate e =
            plm::ErrorEstimator(truth.basis->reduced(), *got.branch, five_harmonics())
                .estimate(0, host->output_dof, measure, 0);
        out.size = pod.basis->reduced()->size();
        out.amplitude = right.amplitude / got.amplitude - 1;
        out.frequency = right.frequency_hz / got.frequency_hz - 1;
        out.estimated_amplitude = (e.amplitude.basis + e.amplitude.contact) / got.amplitude;
        out.estimated_frequency = (e.frequency_hz.basis + e.frequency_hz.contact) / got.frequency_hz;
    }
    plm_context_destroy(&c);
    scene_destroy(&host);
    return out;
}
void eight_columns_for_the_cracked_plate(void **) {
    const Plate p = plate_with_eight_columns();
    std::printf("    amplitude %.2e, estimated %.2e; frequency %.1e, estimated %.1e\n", p.amplitude,
                p.estimated_amplitude, p.frequency, p.estimated_frequency);
    assert_int_equal(p.size, 8);
    assert_true(below(std::abs(p.amplitude), 2e-4) && below(std::abs(p.frequency), 1e-6));
    assert_true(close_to(p.estimated_amplitude, p.amplitude, 0.2));
    assert_true(below(std::abs(p.estimated_frequency), 1e-6));
}

} // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(without_tolerance_the_curve_is_the_parents),
        cmocka_unit_test(a_matrix_of_damping_that_happens_to_be_diagonal),
        cmocka_unit_test(the_size_is_what_was_asked_for),
        cmocka_unit_test(proper_orthogonal_modes_hold_the_most_energy),
        cmocka_unit_test(the_columns_are_mass_normalised),
        cmocka_unit_test(motions_in_time_are_the_parents),
        cmocka_unit_test(the_rest_under_preload_is_kept),
        cmocka_unit_test(motions_without_a_mean_part),
        cmocka_unit_test(eight_columns_for_the_cracked_plate),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
