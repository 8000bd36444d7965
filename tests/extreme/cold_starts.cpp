#include "cold_starts.hpp"
#include "scene.h"
#include <cmath>
#include <cstdio>
#include <functional>

namespace extreme {
namespace {

using SceneOwner = std::unique_ptr<scene, std::function<void(scene *)>>;

SceneOwner make_scene(const char *name, bool preload) {
    scene *s = nullptr;
    if (scene_create(name, "quick", preload, &s)) throw std::runtime_error("no scene");
    return SceneOwner(s, [](scene *p) { scene_destroy(&p); });
}

} // namespace

ColdStarts cold_starts(double ratio) {
    const SceneOwner plate = make_scene("cracked_plate", true);
    const Setup setup = setup_of(*plate);
    const double local = Solver(*plate, setup).model_stiffness();
    for (std::int64_t i = 0; i < plate->n_pairs; ++i) plate->contact_stiffness[i] = ratio * local;
    Solver solver(*plate, setup);
    ColdStarts result;
    result.ratio = ratio;
    for (int i = 0; i < 25; ++i) {
        const double omega = solver.window_low() + (solver.window_high() - solver.window_low()) * i / 24;
        try {
            result.work.add(solver.solve(omega)->work);
            ++result.converged;
        } catch (const Failure &) {
            char text[32];
            std::snprintf(text, sizeof text, " %.6f", omega / (2 * M_PI));
            result.failing += text;
        }
    }
    return result;
}

std::vector<std::pair<std::string, bool>> scene_cases() {
    std::vector<std::pair<std::string, bool>> cases;
    for (int i = 0; i < scene_count(); ++i) {
        cases.push_back({scene_name(i), false});
        if (make_scene(scene_name(i), true)->preload) cases.push_back({scene_name(i), true});
    }
    return cases;
}

SceneSweep sweep_scene(const std::string &name, bool preload) {
    const SceneOwner s = make_scene(name.c_str(), preload);
    SceneSweep sweep;
    sweep.name = name + (preload ? ", pre-load" : "");
    sweep.n_dof = s->n_dof, sweep.n_pairs = s->n_pairs;
    try {
        Solver solver(*s, setup_of(*s));
        const auto curve = solver.sweep();
        sweep.outcome = curve->end_text, sweep.reason = curve->end_reason, sweep.work = curve->work;
    } catch (const Failure &f) {
        sweep.outcome = f.what(), sweep.reason = f.reason;
    }
    return sweep;
}

} // namespace extreme
