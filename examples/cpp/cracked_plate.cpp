// cracked_plate.cpp: the forced response of a plate whose crack opens and closes, from C++.
//
//     cracked_plate_cpp [paper]
//
// The model comes from the host's brick code (examples/scenes): the quick plate of 15 contact pairs, or that
// of the paper with 90. Printed: what the sampler found, the peak from the piecewise-linear modes, and the
// peak without any reduction.
#include <cmath>
#include <cstdio>
#include <memory>
#include <plm/plm.hpp>
#include <scene.h>
#include <stdexcept>
#include <string>

namespace {

struct DestroyScene {
    void operator()(scene *s) const { scene_destroy(&s); }
};
using Scene = std::unique_ptr<scene, DestroyScene>;

Scene make_scene(const char *size) {
    scene *s = nullptr;
    if (const int code = scene_create("cracked_plate", size, 0, &s))
        throw std::runtime_error(scene_error_text(code));
    return Scene(s);
}

// A host's plain arrays go in as {pointer, size}; vectors and other containers as they are.
plm::Model make_model(const plm::Context &context, const scene &s) {
    const plm::View<std::int64_t> col_ptr(s.col_ptr, s.n_dof + 1), row(s.row, s.nnz);
    plm::Model model(context, s.n_dof);
    model.set_mass(plm::csc(col_ptr, row, {s.m, s.nnz}).borrowed()); // no copy: the scene outlives the build
    model.set_stiffness(plm::csc(col_ptr, row, {s.k, s.nnz}).borrowed());
    model.fix_dofs(plm::View<std::int64_t>(s.fixed, s.n_fixed));
    model.set_rayleigh_damping(s.mass_damping, s.stiffness_damping);
    model.add_node_pairs(plm::View<std::int64_t>(s.dof_a, 3 * s.n_pairs),
                         plm::View<std::int64_t>(s.dof_b, 3 * s.n_pairs), {s.normal, 3 * s.n_pairs},
                         {s.contact_stiffness, s.n_pairs}, {s.gap, s.n_pairs});
    model.set_excitation(1, {s.force, s.n_dof});
    model.build();
    return model;
}

// The evolution of the contact area along the mode that dominates the response.
plm::Sampler make_sampler(const plm::Model &model, const scene &s) {
    plm::Sampler sampler(model);
    sampler.set("system", s.dominant_system == SCENE_SLIDING ? "sliding" : "open");
    sampler.set("mode", s.dominant_mode).set("n_samples", 10).run();
    return sampler;
}

double peak_of(const plm::Basis &basis, std::int64_t dof, const char *name) {
    plm::Hbm hbm(basis);
    // Five on both sides, so that they differ by the reduction alone, and the unreduced curve takes a second.
    // Of the paper's plate under pre-load five leave 9.5 % of the peak; the default takes as many as needed.
    hbm.set("n_harmonics", 5);
    const plm::Branch curve = hbm.sweep();
    const plm::Peak peak = hbm.find_peak(curve, dof);
    std::printf("%-22s %4lld columns, %3lld points: peak %.5f mm at %.3f Hz\n", name,
                static_cast<long long>(basis.get_int("size")), static_cast<long long>(curve.size()),
                peak.amplitude, peak.frequency_hz);
    return peak.amplitude;
}

int run(const char *size) {
    const Scene s = make_scene(size);
    plm::Context context;
    context.on_outcome([](plm_status, std::string_view text) { // silent unless something should be looked at
        std::fprintf(stderr, "%.*s\n", static_cast<int>(text.size()), text.data());
    });
    const plm::Model model = make_model(context, *s);
    const plm::Sampler sampler = make_sampler(model, *s);
    std::printf(
        "%lld DOFs, %lld contact pairs; dominant mode at %.3f Hz, %lld samples, bilinear frequency %.3f Hz\n",
        static_cast<long long>(model.n_dof()), static_cast<long long>(s->n_pairs),
        sampler.get_double("dominant_frequency_hz"), static_cast<long long>(sampler.get_int("n_selected")),
        sampler.get_double("blf_hz"));

    plm::Basis modes(model), full(model);
    for (plm::Basis *basis : {&modes, &full}) basis->set_sampler(sampler);
    modes.set("n_harmonics", 5).build();
    full.set("kind", "full").set("n_harmonics", 5).build();
    const double reduced = peak_of(modes, s->output_dof, "piecewise-linear modes");
    const double reference = peak_of(full, s->output_dof, "unreduced");
    const double error = std::abs(reduced / reference - 1);
    std::printf("error of the reduction at the peak: %.2f %%\n", 100 * error);
    return error < 0.05 ? 0 : 1;
}

} // namespace

int main(int argc, char **argv) {
    try {
        return run(argc > 1 ? argv[1] : "quick");
    } catch (const plm::Error &e) {
        std::fprintf(stderr, "%s (status %d, argument %s, index %lld)\n", e.what(),
                     static_cast<int>(e.status()), e.argument().c_str(), static_cast<long long>(e.index()));
    } catch (const std::exception &e) {
        std::fprintf(stderr, "%s\n", e.what());
    }
    return 2;
}
