#include "solver.hpp"
#include "dense.hpp"
#include <algorithm>
#include <cmath>
#include <ctime>

extern "C" {
#include "scene_model.h"
}

namespace extreme {
namespace {

void check_call(plm_context *ctx, plm_status status) {
    if (status >= 0) return;
    char text[1024] = "";
    std::int32_t reason = 0;
    plm_context_get_error_text(ctx, sizeof text, text, nullptr);
    plm_context_get_error_info(ctx, nullptr, &reason, nullptr, nullptr);
    throw Failure(status, reason, text);
}

// Of the processor, in seconds: what else the machine does does not count.
double now() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Triplets {
    std::vector<std::int64_t> row, column;
    std::vector<double> value;
    explicit Triplets(const std::vector<double> &dense, std::int64_t n) {
        for (std::int64_t i = 0; i < n; ++i)
            for (std::int64_t j = 0; j < n; ++j)
                if (dense[i * n + j] != 0 || i == j) {
                    row.push_back(i);
                    column.push_back(j);
                    value.push_back(dense[i * n + j]);
                }
    }
};

std::vector<double> diagonal(const std::vector<double> &d) {
    const std::size_t n = d.size();
    std::vector<double> a(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) a[i * n + i] = d[i];
    return a;
}

} // namespace

void Work::add(const Work &w) {
    points += w.points;
    iterations += w.iterations;
    failed_steps += w.failed_steps;
    seconds += w.seconds;
}

Curve::Curve(plm_context *ctx, plm_model *model, plm_basis *basis, plm_branch *branch)
    : ctx_(ctx), model_(model), basis_(basis), branch_(branch) {
    std::int64_t reason = 0, count = 0;
    check_call(ctx, plm_branch_get_int(branch, "end_reason", &reason));
    end_reason = static_cast<std::int32_t>(reason);
    char text[256] = "";
    check_call(ctx, plm_branch_get_string(branch, "end_text", sizeof text, text, nullptr));
    end_text = text;
    check_call(ctx, plm_branch_get_string(branch, "unknowns", sizeof text, text, nullptr));
    unknowns = text;
    check_call(ctx, plm_branch_get_array(branch, "frequency_hz", 0, nullptr, &count));
    omega.resize(count);
    check_call(ctx, plm_branch_get_array(branch, "frequency_hz", count, omega.data(), &count));
    for (double &w : omega) w *= 2 * M_PI;
    work.points = count;
    check_call(ctx, plm_branch_get_int(branch, "newton_iterations", &work.iterations));
    check_call(ctx, plm_branch_get_int(branch, "failed_steps", &work.failed_steps));
}

Curve::~Curve() {
    plm_branch_destroy(&branch_);
}

std::vector<double> Curve::amplitude(std::int64_t dof, std::int32_t measure, int harmonic) const {
    std::vector<double> a(size());
    std::int64_t count = 0;
    check_call(ctx_,
               plm_branch_get_amplitude(branch_, dof, measure, harmonic, work.points, a.data(), &count));
    return a;
}

std::vector<std::int32_t> Curve::bifurcations() const {
    std::int64_t count = 0;
    std::vector<std::int64_t> kind(size());
    check_call(ctx_, plm_branch_get_int_array(branch_, "bifurcation", work.points, kind.data(), &count));
    return {kind.begin(), kind.end()};
}

Setup setup_of(const scene &s) {
    Setup setup;
    setup.kind = "plm";
    setup.sampler = {{"system", s.dominant_system}, {"mode", s.dominant_mode}};
    return setup;
}

std::vector<double> Curve::state(std::size_t point, std::int64_t n) const {
    plm_transient *motion = nullptr;
    check_call(ctx_, plm_transient_create(model_, basis_, &motion));
    check_call(ctx_, plm_transient_start_at(motion, branch_, static_cast<std::int64_t>(point)));
    std::int64_t n_dof = 0;
    check_call(ctx_, plm_branch_get_int(branch_, "n_dof", &n_dof));
    std::vector<double> q(n_dof), v(n_dof);
    check_call(ctx_, plm_transient_get_state(motion, n_dof, q.data(), v.data()));
    plm_transient_destroy(&motion);
    std::vector<double> y(q.begin(), q.begin() + n);
    y.insert(y.end(), v.begin(), v.begin() + n);
    return y;
}

Solver::Solver(const exact::Structure &s, const Setup &setup) {
    build(s, diagonal(s.mass), setup);
}

Solver::Solver(const exact::Structure &s, const std::vector<double> &mass, const Setup &setup) {
    build(s, mass, setup);
}

Solver::Solver(const scene &s, const Setup &setup) {
    check(plm_context_create(PLM_API_VERSION, &ctx_));
    check(scene_to_model(ctx_, &s, &model_));
    finish(setup);
}

Solver::~Solver() {
    plm_context_destroy(&ctx_);
}

void Solver::check(plm_status status) const {
    check_call(ctx_, status);
}

void Solver::build(const exact::Structure &s, const std::vector<double> &mass, const Setup &setup) {
    check(plm_context_create(PLM_API_VERSION, &ctx_));
    check(plm_model_create(ctx_, s.n, &model_));
    const std::pair<int, const std::vector<double> *> matrices[] = {
        {PLM_MASS, &mass}, {PLM_STIFFNESS, &s.stiffness}, {PLM_DAMPING, &s.damping}};
    for (const auto &[which, dense] : matrices) {
        const Triplets t(*dense, s.n);
        check(plm_model_set_matrix_i64(model_, which, PLM_TRIPLETS, PLM_FULL, 0, PLM_COPY,
                                       static_cast<std::int64_t>(t.value.size()), t.row.data(),
                                       t.column.data(), t.value.data()));
    }
    std::vector<std::int64_t> pointer{0}, dof;
    std::vector<double> coefficient;
    for (int p = 0; p < s.z; ++p) {
        for (int j = 0; j < s.n; ++j)
            if (s.gap_rows[p * s.n + j] != 0) {
                dof.push_back(j);
                coefficient.push_back(s.gap_rows[p * s.n + j]);
            }
        pointer.push_back(static_cast<std::int64_t>(dof.size()));
    }
    check(plm_model_add_gap_rows_i64(model_, 0, s.z, pointer.data(), dof.data(), coefficient.data(),
                                     s.contact_stiffness.data(), s.gap.data()));
    const bool loaded = std::any_of(s.preload.begin(), s.preload.end(), [](double f) { return f != 0; });
    if (loaded) check(plm_model_set_preload(model_, s.n, s.preload.data()));
    check(plm_model_set_excitation(model_, 1, s.n, s.force.data(), nullptr));
    check(plm_model_build(model_));
    finish(setup);
}

void Solver::finish(const Setup &setup) {
    low_ = setup.low, high_ = setup.high;
    if (setup.kind == "plm" || setup.low == 0) {
        check(plm_sampler_create(model_, &sampler_));
        for (const auto &[key, value] : setup.sampler) {
            if (key == "system") {
                check(plm_sampler_set_string(sampler_, "system", value ? "sliding" : "open"));
            } else {
                check(plm_sampler_set_int(sampler_, key.c_str(), value));
            }
        }
        check(plm_sampler_run(sampler_));
    }
    check(plm_basis_create(model_, &basis_));
    if (sampler_) check(plm_basis_set_sampler(basis_, sampler_));
    check(plm_basis_set_string(basis_, "kind", setup.kind.c_str()));
    if (setup.low > 0) {
        check(plm_basis_set_double(basis_, "frequency_min_hz", setup.low / (2 * M_PI)));
        check(plm_basis_set_double(basis_, "frequency_max_hz", setup.high / (2 * M_PI)));
    }
    check(plm_basis_build(basis_));
    check(plm_hbm_create(basis_, &hbm_));
    if (setup.harmonics > 0) check(plm_hbm_set_int(hbm_, "n_harmonics", setup.harmonics));
    if (setup.sampled) {
        check(plm_hbm_set_string(hbm_, "aft", "sampled"));
        check(plm_hbm_set_int(hbm_, "max_points", 1000)); // it creeps where it fails
    }
    if (setup.upward) check(plm_hbm_set_string(hbm_, "direction", "up"));
    if (setup.force_scale != 1) check(plm_hbm_set_double(hbm_, "force_scale", setup.force_scale));
}

std::unique_ptr<Curve> Solver::sweep() {
    plm_branch *branch = nullptr;
    const double begin = now();
    const plm_status status = plm_hbm_sweep(hbm_, &branch);
    const double seconds = now() - begin;
    check(status);
    auto curve = std::make_unique<Curve>(ctx_, model_, basis_, branch);
    curve->work.seconds = seconds;
    const double first = curve->omega.front(), last = curve->omega.back();
    if (curve->end_reason == PLM_REASON_RANGE_END && std::abs(last - first) < 0.5 * (high_ - low_)) {
        curve->end_reason = PLM_REASON_NONE; // through a fold and out where it came in
        curve->end_text = "left the range where it had come in";
    }
    return curve;
}

std::unique_ptr<Curve> Solver::solve(double omega, const Curve *start, std::size_t point) {
    plm_branch *branch = nullptr;
    const double begin = now();
    const plm_status status = plm_hbm_solve(hbm_, omega / (2 * M_PI), start ? start->handle() : nullptr,
                                            start ? static_cast<std::int64_t>(point) : 0, &branch);
    const double seconds = now() - begin;
    check(status);
    auto curve = std::make_unique<Curve>(ctx_, model_, basis_, branch);
    curve->work.seconds = seconds;
    return curve;
}

std::pair<double, double> Solver::peak(const Curve &curve, std::int64_t dof, std::int32_t measure,
                                       int harmonic) {
    double frequency = 0, amplitude = 0;
    check(plm_hbm_find_peak(hbm_, curve.handle(), dof, measure, harmonic, &frequency, &amplitude, nullptr));
    return {2 * M_PI * frequency, amplitude};
}

std::int64_t Solver::basis_size() const {
    std::int64_t size = 0;
    check(plm_basis_get_int(basis_, "size", &size));
    return size;
}

double Solver::model_stiffness() const {
    double k = 0;
    check(plm_model_get_double(model_, "local_stiffness", &k));
    return k;
}

double Solver::window_low() const {
    double f = 0;
    check(plm_basis_get_double(basis_, "window_low_hz", &f));
    return 2 * M_PI * f;
}

double Solver::window_high() const {
    double f = 0;
    check(plm_basis_get_double(basis_, "window_high_hz", &f));
    return 2 * M_PI * f;
}

double local_stiffness(const exact::Structure &s) {
    std::vector<double> flexibility;
    for (int p = 0; p < s.z; ++p) {
        std::vector<Complex> k(s.stiffness.begin(), s.stiffness.end()), row(s.n);
        for (int j = 0; j < s.n; ++j) row[j] = s.gap_rows[p * s.n + j];
        const std::vector<Complex> q = solve_dense(std::move(k), row);
        double f = 0;
        for (int j = 0; j < s.n; ++j) f += s.gap_rows[p * s.n + j] * q[j].real();
        flexibility.push_back(f);
    }
    std::sort(flexibility.begin(), flexibility.end());
    const std::size_t z = flexibility.size();
    return 2 / (flexibility[(z - 1) / 2] + flexibility[z / 2]);
}

} // namespace extreme
