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
    return call<ModelHandle>("plm_model_set_excitation", model, [&](ModelHandle &m) {
        return change_loads(m, [&](plm::ModelInput &input) {
            if (!is_given(harmonic, real, imag)) {
                input.excitation.erase(harmonic);
                return;
            }
            plm::HarmonicLoad load;
            load.real = copied_load("real", n, real, input.n_dof);
            if (imag) load.imag = copied_load("imag", n, imag, input.n_dof);
            std::swap(input.excitation[harmonic], load);
        });
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
                    bad_argument("force", i,
                                 plm::format("force[%lld] is %g; contact presses, so that it must be >= 0, or "
                                             "PLM_KEEP_GAP for a pair that keeps its gap",
                                             static_cast<long long>(i), force[i]));
            input.rest_forces.force.assign(force, force + n);
        });
    });
}
