// What can be asked without a context: version, status texts, the key table.
#include "capi/barrier.hpp"
#include "capi/keys.hpp"
#include "linalg/blas_host.hpp"
#include "linalg/dft.hpp"
#include "orbits/make_transient.hpp"
#include "orbits/transient.hpp"
#include "structure/solver/make_factor.hpp"
#include "study/study.hpp"

#ifndef PLM_VERSION_MAJOR // the build system passes the project's version
#define PLM_VERSION_MAJOR 0
#define PLM_VERSION_MINOR 1
#define PLM_VERSION_PATCH 0
#endif

using namespace plm;
using namespace plm::capi;

const char *plm::capi::status_words(plm_status status) {
    switch (status) {
    case PLM_OK:
        return "done";
    case PLM_NOT_CONVERGED:
        return "ended early because no corrector converged; results are valid as far as they go, see "
               "end_reason";
    case PLM_TRUNCATED:
        return "the branch ended at the allowed number of points; raise max_points";
    case PLM_CANCELLED:
        return "cancelled by the progress callback";
    case PLM_WARNING:
        return "done, but something should be looked at; see the text of the context or the handle's warning";
    case PLM_ERR_HANDLE:
        return "the handle is NULL, stale, foreign or of the wrong kind";
    case PLM_ERR_ARGUMENT:
        return "an argument is out of its range, NaN, NULL or of the wrong size";
    case PLM_ERR_KEY:
        return "no option or result has this name";
    case PLM_ERR_STATE:
        return "called too early, too late, or from inside a callback";
    case PLM_ERR_BUSY:
        return "another thread is inside a call of this context; give each thread a context of its own, or "
               "let the "
               "threads take turns";
    case PLM_ERR_MEMORY:
        return "an allocation failed";
    case PLM_ERR_NOT_BUILT:
        return "this part was left out of the build";
    case PLM_ERR_MATRIX:
        return "a matrix is not symmetric, or has a NaN, Inf, duplicate or out-of-range index";
    case PLM_ERR_NOT_POSITIVE_DEFINITE:
        return "a matrix that must be positive definite is not";
    case PLM_ERR_SINGULAR:
        return "a linear system has no unique solution";
    case PLM_ERR_EIGENSOLVER:
        return "ARPACK, the Lanczos method or LAPACK did not deliver the eigenpairs";
    case PLM_ERR_CONVERGENCE:
        return "an iteration did not converge and there is no partial result";
    case PLM_ERR_CALLBACK:
        return "a callback of the host reported a failure";
    case PLM_ERR_INTERNAL:
        return "a defect of libplm; please report the error text";
    default:
        return nullptr;
    }
}

namespace {

// A kind or key index from outside.
const std::vector<Key> &table(std::int32_t kind) {
    require_range(kind, PLM_KIND_MODEL, PLM_KIND_STUDY, "kind");
    return keys_of(static_cast<Kind>(kind));
}
const Key &row(std::int32_t kind, std::int32_t index) {
    const std::vector<Key> &keys = table(kind);
    require_range(index, 0, static_cast<std::int64_t>(keys.size()) - 1, "index");
    return keys[static_cast<std::size_t>(index)];
}

} // namespace

plm_status plm_status_text(plm_status status, std::int64_t capacity, char *buffer, std::int64_t *needed) {
    return call_free([&] {
        const char *words = status_words(status);
        return put_text(words ? words : format("unknown status %d", status), capacity, buffer, needed);
    });
}

plm_status plm_version(std::int32_t *major, std::int32_t *minor, std::int32_t *patch) {
    return call_free([&] {
        for (const std::int32_t *output : {major, minor, patch}) require_pointer(output, "output");
        *major = PLM_VERSION_MAJOR, *minor = PLM_VERSION_MINOR, *patch = PLM_VERSION_PATCH;
        return PLM_OK;
    });
}

plm_status plm_build_info(std::int64_t capacity, char *buffer, std::int64_t *needed) {
    return call_free([&] {
        const std::string factorization = factor_backends(), transform = dft_backend();
        const char *kernels = own_blas_kernels();
        const bool cholmod = factorization.find("CHOLMOD") != std::string::npos,
                   fftw = transform.find("FFTW") != std::string::npos;
        return put_text(
            format(
                "libplm %d.%d.%d; factorization: %s; eigensolver: ARPACK and Lanczos; Fourier transform: %s; "
                "BLAS: %s%s%s; components: model, sampler, basis, hbm%s%s; licence: %s%s%s%s",
                PLM_VERSION_MAJOR, PLM_VERSION_MINOR, PLM_VERSION_PATCH, factorization.c_str(),
                transform.c_str(), kernels ? "its own OpenBLAS (" : "the host's", kernels ? kernels : "",
                kernels ? ")" : "", transient_is_built() ? ", transient" : "",
                study_is_built() ? ", study" : "",
                cholmod || fftw ? "GPL 2 or later as a whole, for " : "BSD 3-clause, see NOTICE",
                cholmod ? "CHOLMOD" : "", cholmod && fftw ? " and " : "", fftw ? "FFTW" : ""),
            capacity, buffer, needed);
    });
}

plm_status plm_key_count(std::int32_t kind, std::int32_t *count) {
    return call_free([&] {
        require_pointer(count, "count");
        *count = static_cast<std::int32_t>(table(kind).size());
        return PLM_OK;
    });
}

plm_status plm_key_info(std::int32_t kind, std::int32_t index, std::int32_t *type, std::int32_t *is_option,
                        double *minimum, double *maximum) {
    return call_free([&] {
        const Key &key = row(kind, index);
        for (const void *output : {static_cast<const void *>(type), static_cast<const void *>(is_option),
                                   static_cast<const void *>(minimum), static_cast<const void *>(maximum)})
            require_pointer(output, "output");
        *type = key.type, *is_option = key.is_option, *minimum = key.minimum, *maximum = key.maximum;
        return PLM_OK;
    });
}

plm_status plm_key_text(std::int32_t kind, std::int32_t index, std::int32_t field, std::int64_t capacity,
                        char *buffer, std::int64_t *needed) {
    return call_free([&] {
        const Key &key = row(kind, index);
        require_range(field, PLM_KEY_NAME, PLM_KEY_CHOICES, "field");
        const std::string text = field == PLM_KEY_NAME          ? key.name
                                 : field == PLM_KEY_DESCRIPTION ? key.description
                                 : field == PLM_KEY_DEFAULT     ? default_text(static_cast<Kind>(kind), key)
                                                                : key.choices;
        return put_text(text, capacity, buffer, needed);
    });
}
