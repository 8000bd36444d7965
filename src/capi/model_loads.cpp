// What acts on a model: pre-load, excitation, walls that move. All of it may be changed after the build.
#include "capi/barrier.hpp"
#include "capi/model_input.hpp"

namespace plm::capi {
namespace {

vector<double> copied_load(const char *name, std::int64_t n, const double *force, std::int64_t n_dof) {
    if (n != n_dof)
        bad_argument("n", -1,
                     format("n is %lld where the model has %lld DOFs", static_cast<long long>(n),
                            static_cast<long long>(n_dof)));
    require_finite_array(force, n, name);
    return vector<double>(force, force + n);
}

// False: the harmonic is to be removed.
bool is_given(std::int32_t harmonic, const double *real, const double *imag) {
    require_range(harmonic, 0, 100000, "harmonic");
    if (!real && imag)
        bad_argument("real", -1, "real is NULL but imag is not; pass both, or none to remove the harmonic");
    if (real && harmonic == 0 && imag)
        bad_argument("imag", -1, "imag must be NULL for harmonic 0, which is static");
    return real != nullptr;
}

void require_n_pairs(std::int64_t n, std::int64_t n_pairs) {
    if (n != n_pairs)
        bad_argument(
            "n", -1,
            format("n is %lld, but the model has %lld contact pairs so far; add all pairs first, and "
                   "hand over one value a pair, in the order in which they were added",
                   static_cast<long long>(n), static_cast<long long>(n_pairs)));
}

HarmonicLoad copied_loads(std::int64_t n_dof, std::int64_t n, const double *real, const double *imag) {
    HarmonicLoad load;
    load.real = copied_load("real", n, real, n_dof);
    if (imag) load.imag = copied_load("imag", n, imag, n_dof);
    return load;
}

Outcome change_excitation(ModelHandle &m, LoadPart part, std::int64_t n, const double *real,
                          const double *imag) {
    return change_loads(m, [&](ModelInput &input) {
        if (!is_given(part.harmonic, real, imag)) {
            input.excitation.erase(part);
            return;
        }
        HarmonicLoad load = copied_loads(input.n_dof, n, real, imag);
        std::swap(input.excitation[part], load);
    });
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_set_preload(plm_model *model, std::int64_t n, const double *force) {
    return call<ModelHandle>("plm_model_set_preload", model, [&](ModelHandle &m) {
        return change_loads(m, [&](plm::ModelInput &input) {
            input.preload = force ? copied_load("force", n, force, input.n_dof) : plm::vector<double>();
        });
    });
}

plm_status plm_model_set_excitation(plm_model *model, std::int32_t harmonic, std::int64_t n,
                                    const double *real, const double *imag) {
    return call<ModelHandle>("plm_model_set_excitation", model,
                             [&](ModelHandle &m) { return change_excitation(m, {harmonic}, n, real, imag); });
}

plm_status plm_model_set_growing_excitation(plm_model *model, std::int32_t harmonic, std::int32_t power,
                                            std::int64_t n, const double *real, const double *imag) {
    return call<ModelHandle>("plm_model_set_growing_excitation", model, [&](ModelHandle &m) {
        require_range(power, 0, 2, "power");
        return change_excitation(m, {harmonic, power}, n, real, imag);
    });
}

plm_status plm_model_set_gap_motion(plm_model *model, std::int32_t harmonic, std::int64_t n,
                                    const double *real, const double *imag) {
    return call<ModelHandle>("plm_model_set_gap_motion", model, [&](ModelHandle &m) {
        return change_loads(m, [&](plm::ModelInput &input) {
            plm::Contact &contact = input.contact;
            if (!is_given(harmonic, real, imag)) {
                contact.motion.erase(harmonic);
                return;
            }
            require_n_pairs(n, contact.n_pairs());
            plm::GapHarmonic part;
            require_finite_array(real, n, "real");
            part.real.assign(real, real + n);
            if (imag) {
                require_finite_array(imag, n, "imag");
                part.imag.assign(imag, imag + n);
            }
            std::swap(contact.motion[harmonic], part);
        });
    });
}

plm_status plm_model_set_rest_force(plm_model *model, std::int64_t n, const double *force) {
    return call<ModelHandle>("plm_model_set_rest_force", model, [&](ModelHandle &m) {
        return change_loads(m, [&](plm::ModelInput &input) {
            input.rest_forces.force.clear();
            if (!force) return;
            require_n_pairs(n, input.contact.n_pairs());
            require_finite_array(force, n, "force");
            for (std::int64_t i = 0; i < n; ++i)
                if (force[i] < 0 && force[i] != PLM_KEEP_GAP)
                    bad_argument(
                        "force", i,
                        plm::format("force[%lld] is %g; contact presses, so that it must be >= 0, or "
                                    "PLM_KEEP_GAP for a pair that keeps its gap",
                                    static_cast<long long>(i), force[i]));
            input.rest_forces.force.assign(force, force + n);
        });
    });
}

plm_status plm_model_set_base_motion(plm_model *model, std::int32_t quantity, std::int32_t harmonic,
                                     std::int64_t n, const double *real, const double *imag) {
    return call<ModelHandle>("plm_model_set_base_motion", model, [&](ModelHandle &m) {
        require_open(m);
        require_range(quantity, PLM_DISPLACEMENT, PLM_ACCELERATION, "quantity");
        require_range(harmonic, 1, 100000, "harmonic");
        plm::HarmonicLoads &motion = m.input.base_motion;
        plm::HarmonicLoad part;
        if (is_given(harmonic, real, imag)) part = copied_loads(m.input.n_dof, n, real, imag);
        for (std::int32_t q : {PLM_DISPLACEMENT, PLM_VELOCITY, PLM_ACCELERATION})
            motion.erase({harmonic, -q});
        if (real) motion[{harmonic, -quantity}] = std::move(part);
        return PLM_OK;
    });
}
