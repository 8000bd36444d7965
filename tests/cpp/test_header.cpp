// What plm.hpp adds to plm.h: ownership, exceptions, containers and callbacks.
#include <plm/plm.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#if __cplusplus >= 202002L
#include <span>
#endif

namespace {

int failures = 0;
#define CHECK(condition)                                                                                     \
    ((condition) ? void() : (std::printf("%s:%d: %s\n", __FILE__, __LINE__, #condition), void(++failures)))

/// The exception of type E that f throws; counts a failure when it throws none.
template <class E = plm::Error, class F> E caught(F f) {
    try {
        f();
    } catch (const E &e) {
        return e;
    }
    std::printf("nothing was thrown\n");
    std::exit(1);
}

constexpr std::int64_t n = 3;

/// Three masses in a row, the first held by a spring, the last beside a stop; built.
void fill(plm::Model &model) {
    const std::vector<std::int32_t> col_ptr{0, 2, 4, 5}, row{0, 1, 1, 2, 2};
    const std::array<double, 5> k{200, -100, 200, -100, 100};
    model.set_mass(plm::triplets({0, 1, 2}, {0, 1, 2}, {1.0, 1.0, 1.0}));
    model.set_stiffness(plm::csc(col_ptr, row, k).lower());
    model.set_rayleigh_damping(0, 2e-3);
    model.add_ground_contacts({2, -1, -1}, {1, 0, 0}, {50.0});
    model.set_excitation(1, {0.0, 0.0, 1.0});
}
plm::Model built(const plm::Context &context) {
    plm::Model model(context, n);
    fill(model);
    model.build();
    return model;
}
plm::Basis basis_of(const plm::Model &model) {
    plm::Sampler sampler(model);
    sampler.set("mode", 1).run();
    plm::Basis basis(model);
    basis.set_sampler(sampler);
    basis.build();
    return basis;
}

static_assert(!std::is_copy_constructible_v<plm::Model> && std::is_nothrow_move_constructible_v<plm::Model>);
static_assert(!std::is_copy_constructible_v<plm::Branch> && std::is_nothrow_move_assignable_v<plm::Branch>);
static_assert(std::is_nothrow_copy_constructible_v<plm::Error>);

void the_run() {
    plm::Hbm hbm(basis_of(built(plm::Context()))); // all parents are gone
    const plm::Branch curve = hbm.set("n_harmonics", 3).sweep();
    CHECK(curve.status() == PLM_OK && curve.size() > 10);
    const plm::Peak peak = hbm.find_peak(curve, 2);
    const plm::Branch again = hbm.solve(peak.frequency_hz, curve, curve.size() / 2);
    CHECK(std::abs(again.amplitude(2)[0] / peak.amplitude - 1) < 1e-3);
    const plm::ErrorEstimate error = hbm.estimate_error(peak.branch, 0, 2);
    CHECK(error.amplitude.sum() ==
          error.amplitude.basis + error.amplitude.contact + error.amplitude.harmonics);
    CHECK(error.amplitude.harmonics != 0 && std::abs(error.amplitude.basis) < 0.01 * peak.amplitude);
    CHECK(peak.branch.contact(0, 16).force.values.size() == 16);
    CHECK(curve.get<std::vector<double>>("frequency_hz") == curve.frequency_hz());
    CHECK(curve.get<std::string>("end_text").size() > 3 && curve.get<int>("n_harmonics") == 3);
    CHECK(hbm.get<std::string>("direction") == "down" && hbm.get<double>("force_scale") == 1);
    CHECK(hbm.set("tolerance", 1e-8f).get_double("tolerance") == static_cast<double>(1e-8f));
}

void bases() {
    const plm::Model model = built(plm::Context());
    plm::Basis full(model), basis = basis_of(model);
    full.set("kind", "full").set("frequency_max_hz", 3.0).build();
    plm::Sampler sampler(model);
    sampler.set("mode", 1);
    sampler.add_dominant_mode(PLM_SYSTEM_SLIDING, 1);
    sampler.run();
    CHECK(sampler.get_int("n_dominant") == 2);
    basis.set_sampler(sampler);
    basis.set_parent(full);
    basis.build();
    const plm::Dense<double> p = basis.vectors();
    CHECK(p.rows == n && p.cols == basis.get_int("size"));
    CHECK(basis.residual(std::vector<double>(p.column(0), p.column(0) + n)) < 1e-10);
    basis.clear_parent();
    plm::Basis small(model);
    small.set("kind", "pod").set("pod_size", 1).set_parent(basis);
    plm::Hbm hbm(basis);
    std::vector<plm::Branch> curves;
    curves.push_back(hbm.set("n_harmonics", 3).sweep());
    small.set_responses(curves);
    small.set_responses({curves[0], curves[0]});
    small.build();
    CHECK(small.get_int("size") == 1);
    CHECK(model.audit().size() > 3 && !model.audit()[0].text.empty());
    const plm::Modes given = model.modes(PLM_SYSTEM_GIVEN, 2, {1}),
                     sliding = model.modes(PLM_SYSTEM_SLIDING, 2);
    CHECK(std::abs(given.frequency_hz[1] - sliding.frequency_hz[1]) < 1e-9 && given.shape(0, 0) != 0);
}

void studies() {
    const plm::Model model = built(plm::Context());
    plm::Study study(model);
    {
        plm::Basis basis = basis_of(model);
        basis.set("n_harmonics", 3);
        plm::Hbm hbm(basis);
        hbm.set("n_harmonics", 3);
        plm::Transient motion(model, basis);
        motion.set("settled", 1e-8).set("periods", 2000);
        study.set("repeats", 1).set("curve_tolerance", 1e-5);
        study.set_output(2);
        study.set_force_levels({0.5, 1.0});
        CHECK(study.add_response("three harmonics", hbm) == 0);
        CHECK(study.add_compressed("compressed", hbm, 2) == 1);
        CHECK(study.add_refined("refined", hbm, 1e-2) == 2);
        CHECK(study.add_marching("marching", motion, 3) == 3);
        hbm.set("n_harmonics", 9);
        basis.set("kind", "full");
        study.set_reference(hbm);
        hbm.set("n_harmonics", 1);
        CHECK(caught([&] { study.add_response("refined", hbm); }).argument() == "name");
    } // options were copied: the handles they came from are gone
    CHECK(caught([&] { study.outcome(0); }).status() == PLM_ERR_STATE);
    CHECK(study.run() == PLM_OK);
    CHECK(study.name(2) == "refined" && study.name(plm::Study::reference) == "reference");
    CHECK(study.outcome(0) == "reached the end of its range");
    CHECK(study.curve(0).get_int("n_harmonics") == 3);
    CHECK(study.curve(plm::Study::reference, 1).get_int("n_harmonics") == 9);
    // harmonics 4 to 9 are worth something, and all bases hold a chain of three masses well
    const auto error = study.get<std::vector<double>>("amplitude_error");
    CHECK(error.size() == 4 && error[0] > 1e-7 && error[0] < 0.05 && error[2] < 0.05);
    CHECK(study.get_int_array("basis_size")[1] == 2);
    const plm::StudyPoints low = study.points(0, 0), high = study.points(0, 1), marched = study.points(3);
    CHECK(low.frequency_hz.size() == low.amplitude.size() && high.amplitude[0] > low.amplitude[0]);
    CHECK(marched.frequency_hz.size() == 3 && marched.frequency_hz[0] > marched.frequency_hz[2]);
    CHECK(caught([&] { study.curve(3); }).function() == "plm_study_get_curve");
    CHECK(caught([&] { study.points(4); }).argument() == "index");
    CHECK(caught([&] { study.write("no/such/parent"); }).argument() == "folder");
    study.reset_reference(); // with the three harmonics of the first method
    CHECK(study.run() == PLM_OK && study.curve(plm::Study::reference).get_int("n_harmonics") == 3);
}

void containers() {
    const plm::Context context;
    plm::Model model(context, n);
    double raw[] = {1, 2, 3};
    model.set_preload(raw);
    model.set_preload(std::array<double, 3>{1, 2, 3});
    model.set_preload({raw, 3});
    model.set_preload(nullptr);
    model.set_modal_damping({0.01, 0.02});
    model.set_structural_damping(0.01);
    model.set_damping(plm::triplets({0}, {0}, {1.0}));
    model.fix_dofs({1}, 1);
    model.fix_dofs(std::vector<std::int64_t>{0});
    model.set_elimination_order({2, 0, 1});
    CHECK(caught([&] { model.set_elimination_order({0}); }).argument() == "n");
    const std::vector<std::int64_t> a{1, 2, -1}, b{2, 0, -1};
    model.add_node_pairs(a, b, {1, 0, 0}, {PLM_AUTO_STIFFNESS});
    const std::vector<std::int64_t> start{0, 1}, dof{1};
    model.add_gap_rows(start, dof, {1.0}, {50.0});
    const std::vector<std::int64_t> col_ptr{1, 2, 3, 4}, row{1, 2, 3}; // counting from 1
    model.set_mass(plm::csr(col_ptr, row, raw).base(1).borrowed());
    model.set_excitation(2, raw, raw);
    model.set_excitation(2, nullptr);
#if __cplusplus >= 202002L
    model.set_preload(std::span<const double>(raw));
    model.fix_dofs(std::span<std::int64_t>());
#endif
    CHECK(model.get_int("n_pairs") == 2);
    CHECK(plm::keys(PLM_KIND_SAMPLER).size() > 20 && plm::keys(PLM_KIND_HBM)[0].name == "n_harmonics");
    CHECK(plm::keys(99).empty());
    CHECK(plm::version()[0] >= 0 && !plm::build_info().empty() && !plm::status_text(PLM_ERR_KEY).empty());
}

void refusals() {
    plm::Context context;
    plm::Model model(context, n);
    plm::Error e = caught([&] { model.set("space_tolerence", 1e-3); });
    CHECK(e.status() == PLM_ERR_KEY && e.function() == "plm_model_set_double" && e.argument() == "key");
    CHECK(std::string(e.what()).find("space_tolerance") != std::string::npos); // the nearest is named
    e = caught([&] { model.fix_dofs({0, 7}); });
    CHECK(e.status() == PLM_ERR_ARGUMENT && e.function() == "plm_model_fix_dofs_i32" &&
          e.argument() == "dof" && e.index() == 1);
    e = caught([&] { model.set_mass(plm::triplets({0, 1}, {0, 1}, {1.0, NAN})); });
    CHECK(e.status() == PLM_ERR_MATRIX && e.index() == 1);
    e = caught([&] { model.set_preload({1.0}); });
    CHECK(e.status() == PLM_ERR_ARGUMENT && e.function() == "plm_model_set_preload");
    e = caught([&] { model.add_ground_contacts({0, -1}, {1, 0, 0}, {1.0}); }); // found by the header itself
    CHECK(e.status() == PLM_ERR_ARGUMENT && e.argument() == "dof" &&
          e.function() == "plm_model_add_ground_contacts_i32");
    e = caught([&] { model.add_gap_rows({0, 1}, std::vector<std::int64_t>{0}, {1.0}, {1.0}); });
    CHECK(e.argument() == "dof");
    e = caught([&] { model.build(); });
    CHECK(e.status() == PLM_ERR_STATE && e.function() == "plm_model_build");
    e = caught([&] { plm::Sampler(model).run(); });
    CHECK(e.status() == PLM_ERR_STATE && e.function() == "plm_sampler_run");
    e = caught([&] { plm::Model(context, -1); });
    CHECK(e.status() == PLM_ERR_ARGUMENT && e.argument() == "n_dof");
    const plm::Model taken = std::move(model);
    e = caught([&] { model.build(); }); // NOLINT: that is the point
    CHECK(e.status() == PLM_ERR_HANDLE);
    plm::Context other = std::move(context);
    CHECK(caught([&] { plm::Model(context, 1); }).status() == PLM_ERR_HANDLE); // NOLINT
    const plm::Model elsewhere = built(plm::Context());
    e = caught([&] { basis_of(taken.c_handle() ? elsewhere : taken).set_sampler(plm::Sampler(taken)); });
    CHECK(e.status() == PLM_ERR_HANDLE && e.argument() == "sampler");
}

struct OfTheHost {
    int what;
};

void callbacks() {
    plm::Context context;
    int logged = 0, progressed = 0;
    context.on_log([&](int, std::string_view text) { logged += !text.empty(); });
    context.on_progress([&](std::string_view stage, double fraction) {
        progressed += !stage.empty() && fraction >= 0 && fraction <= 1;
    });
    const plm::Model model = built(context);
    const plm::Basis basis = basis_of(model);
    plm::Hbm hbm(basis);
    hbm.sweep();
    CHECK(progressed > 3 && logged > 0);

    for (int k : {1, 2, 5}) { // thrown in the k-th call, through a build, a run or a sweep
        int calls = 0;
        context.on_progress([&](std::string_view, double) {
            if (++calls == k) throw OfTheHost{k};
        });
        CHECK(caught<OfTheHost>([&] { plm::Hbm(basis).sweep(); }).what == k);
        CHECK(calls == k); // it was cancelled at once
    }
    context.on_progress(
        [](std::string_view stage, double fraction) { return stage == "sweep" && fraction > 0.3; });
    const plm::Branch part = hbm.sweep();
    CHECK(part.status() == PLM_CANCELLED && part.size() > 0);
    context.on_progress([&](std::string_view, double) { return true; });
    CHECK(caught<plm::Cancelled>([&] { plm::Sampler(model).set("mode", 1).run(); }).status() ==
          PLM_CANCELLED);
    context.on_log([](int, std::string_view) { throw OfTheHost{42}; });
    context.on_progress([](std::string_view, double) {});
    CHECK(caught<OfTheHost>([&] { basis_of(built(context)); }).what == 42);
    context.silence();
    CHECK(plm::Hbm(basis).sweep().status() == PLM_OK); // still usable
}

/// Dense Cholesky of the lower triangle.
class DenseCholesky : public plm::Factorization {
  public:
    DenseCholesky(const plm::LowerTriangle &a, int *alive, bool fails)
        : size_(a.n), l_(static_cast<std::size_t>(a.n * a.n)), alive_(alive), fails_(fails) {
        for (std::int64_t j = 0; j < size_; ++j)
            for (std::int64_t p = a.col_ptr[j]; p < a.col_ptr[j + 1]; ++p) at(a.row[p], j) = a.value[p];
        for (std::int64_t j = 0; j < size_; ++j) {
            for (std::int64_t k = 0; k < j; ++k)
                for (std::int64_t i = j; i < size_; ++i) at(i, j) -= at(i, k) * at(j, k) * at(k, k);
            for (std::int64_t i = j + 1; i < size_; ++i) at(i, j) /= at(j, j); // L D L'
        }
        ++*alive_;
    }
    ~DenseCholesky() override { --*alive_; }
    void solve(double *x, std::int64_t n_rhs, std::int64_t ld) override {
        if (fails_) throw OfTheHost{7};
        for (std::int64_t c = 0; c < n_rhs; ++c) solve(x + c * ld);
    }
    std::int64_t negative_eigenvalues() override { // L D L': as many as D has negative entries
        std::int64_t count = more;
        for (std::int64_t j = 0; j < size_; ++j) count += at(j, j) < 0;
        return count;
    }
    static inline std::int64_t more = 0; // a wrong count

  private:
    double &at(std::int64_t i, std::int64_t j) { return l_[static_cast<std::size_t>(i + j * size_)]; }
    void solve(double *x) {
        for (std::int64_t i = 0; i < size_; ++i)
            for (std::int64_t j = 0; j < i; ++j) x[i] -= at(i, j) * x[j];
        for (std::int64_t i = 0; i < size_; ++i) x[i] /= at(i, i);
        for (std::int64_t i = size_; i-- > 0;)
            for (std::int64_t j = i + 1; j < size_; ++j) x[i] -= at(j, i) * x[j];
    }
    std::int64_t size_;
    std::vector<double> l_;
    int *alive_;
    bool fails_;
};

void solver_of_the_host() {
    int alive = 0;
    {
        plm::Context context;
        const double hz = built(context).modes(PLM_SYSTEM_OPEN, 1).frequency_hz[0];
        context.set_solver(
            [&](const plm::LowerTriangle &a) { return std::make_unique<DenseCholesky>(a, &alive, false); });
        const plm::Model model = built(context);
        CHECK(alive > 0);
        CHECK(std::abs(model.modes(PLM_SYSTEM_OPEN, 1).frequency_hz[0] / hz - 1) < 1e-10);
        plm::Sampler(model).run();
        DenseCholesky::more = -1; // the modes found must agree with the count
        CHECK(caught<plm::Error>([&] { plm::Sampler(built(context)).run(); }).status() ==
              PLM_ERR_EIGENSOLVER);
        DenseCholesky::more = 0;
        context.set_solver(
            [&](const plm::LowerTriangle &a) { return std::make_unique<DenseCholesky>(a, &alive, true); });
        CHECK(caught<OfTheHost>([&] { built(context).modes(PLM_SYSTEM_OPEN, 1); }).what == 7);
        context.set_solver(
            [&](const plm::LowerTriangle &) -> std::unique_ptr<plm::Factorization> { throw OfTheHost{8}; });
        CHECK(caught<OfTheHost>([&] { built(context); }).what == 8);
        context.reset_solver();
        built(context);
    }
    CHECK(alive == 0);
}

void outcomes() {
    plm::Context context;
    plm_status status = PLM_OK;
    std::string said;
    context.on_outcome([&](plm_status s, std::string_view text) { status = s, said = text; });
    plm::Hbm hbm(basis_of(built(context)));
    CHECK(said.empty());
    const plm::Branch curve = hbm.set("max_points", 3).sweep();
    CHECK(curve.status() == PLM_TRUNCATED && status == PLM_TRUNCATED && curve.size() == 3);
    CHECK(said.find("plm_hbm_sweep: max_points reached; raise it") == 0);
    context.on_outcome([](plm_status, std::string_view) { throw OfTheHost{9}; });
    CHECK(caught<OfTheHost>([&] { hbm.sweep(); }).what == 9);
}

std::int64_t blocks = 0;
void memory_of_the_host() {
    {
        const plm::Context context(
            [](std::int64_t bytes, void *) { return ++blocks, std::malloc(static_cast<std::size_t>(bytes)); },
            [](void *block, void *) { blocks -= block != nullptr, std::free(block); }, nullptr);
        built(context);
        const plm::Model model = built(context);
        CHECK(blocks > 0);
    }
    CHECK(blocks == 0);
}

// One coordinate of two masses, T = (0.5, 1), and the way back.
void superelements() {
    plm::Context context;
    context.set_threads(2);
    context.set_effort(20);
    CHECK(caught([&] { context.set_effort(-1); }).status() == PLM_ERR_ARGUMENT);
    CHECK(caught([&] { context.set_threads(0); }).status() == PLM_ERR_ARGUMENT);
    plm::Model model(context, 1);
    const std::vector<double> m{1.25}, k{5000}, row{1};
    bool fails = false;
    model.set_dense_matrix(PLM_MASS, m);
    model.set_dense_matrix(PLM_STIFFNESS, k, PLM_UPPER);
    model.add_dense_gap_rows(row, k, {1e-5});
    model.set_excitation(1, row);
    model.set_rayleigh_damping(0, 5e-4);
    model.set_recovery(2, [&](const plm::Recovery &r) {
        if (fails) throw std::runtime_error("of the host");
        for (std::int64_t j = 0; j < r.n_columns; ++j)
            r.full[2 * j] = 0.5 * r.reduced[j], r.full[2 * j + 1] = r.reduced[j];
    });
    CHECK(caught([&] { model.set_dense_matrix(PLM_MASS, std::vector<double>(4)); }).status() ==
          PLM_ERR_ARGUMENT);
    model.build();
    const auto full = model.recover(std::vector<double>{2, 3});
    CHECK(full.rows == 2 && full.cols == 2 && full(0, 1) == 1.5 && full(1, 1) == 3);
    const auto r = model.compute_response(0, PLM_PEAK, 1e-2);
    const auto half = model.recover_amplitude(r.curve, 0), same = r.curve.amplitude(0);
    CHECK(half.size() == same.size() && std::abs(half[1] - 0.5 * same[1]) < 1e-12 * same[1]);
    fails = true;
    CHECK(std::string(caught<std::runtime_error>([&] { model.recover(row); }).what()) == "of the host");
}

} // namespace

int main() {
    the_run();
    outcomes();
    bases();
    studies();
    containers();
    refusals();
    callbacks();
    solver_of_the_host();
    memory_of_the_host();
    superelements();
    std::printf("%d failure(s)\n", failures);
    return failures != 0;
}
