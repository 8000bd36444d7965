// The exported getters and setters by key, the same for every kind of handle.
#include "capi/barrier.hpp"
#include "capi/handles.hpp"
#include "capi/keys.hpp"

namespace capi = plm::capi;

#define PLM_SETTERS(noun, H)                                                                                 \
    plm_status plm_##noun##_set_int(plm_##noun *handle, const char *key, std::int64_t value) {               \
        return capi::call<capi::H>("plm_" #noun "_set_int", handle,                                          \
                                   [&](capi::H &h) { return capi::set_int(h, key, value); });                \
    }                                                                                                        \
    plm_status plm_##noun##_set_double(plm_##noun *handle, const char *key, double value) {                  \
        return capi::call<capi::H>("plm_" #noun "_set_double", handle,                                       \
                                   [&](capi::H &h) { return capi::set_double(h, key, value); });             \
    }                                                                                                        \
    plm_status plm_##noun##_set_string(plm_##noun *handle, const char *key, const char *value) {             \
        return capi::call<capi::H>("plm_" #noun "_set_string", handle,                                       \
                                   [&](capi::H &h) { return capi::set_string(h, key, value); });             \
    }

#define PLM_GETTERS(noun, H)                                                                                 \
    plm_status plm_##noun##_get_int(plm_##noun *handle, const char *key, std::int64_t *value) {              \
        return capi::call<capi::H>("plm_" #noun "_get_int", handle,                                          \
                                   [&](capi::H &h) { return capi::get_int(h, key, value); });                \
    }                                                                                                        \
    plm_status plm_##noun##_get_double(plm_##noun *handle, const char *key, double *value) {                 \
        return capi::call<capi::H>("plm_" #noun "_get_double", handle,                                       \
                                   [&](capi::H &h) { return capi::get_double(h, key, value); });             \
    }                                                                                                        \
    plm_status plm_##noun##_get_string(plm_##noun *handle, const char *key, std::int64_t capacity,           \
                                       char *buffer, std::int64_t *needed) {                                 \
        return capi::call<capi::H>("plm_" #noun "_get_string", handle, [&](capi::H &h) {                     \
            return capi::get_string(h, key, capacity, buffer, needed);                                       \
        });                                                                                                  \
    }

#define PLM_ARRAY_GETTERS(noun, H)                                                                           \
    plm_status plm_##noun##_get_array(plm_##noun *handle, const char *key, std::int64_t capacity,            \
                                      double *values, std::int64_t *count) {                                 \
        return capi::call<capi::H>("plm_" #noun "_get_array", handle, [&](capi::H &h) {                      \
            return capi::get_array(h, key, capacity, values, count);                                         \
        });                                                                                                  \
    }                                                                                                        \
    plm_status plm_##noun##_get_int_array(plm_##noun *handle, const char *key, std::int64_t capacity,        \
                                          std::int64_t *values, std::int64_t *count) {                       \
        return capi::call<capi::H>("plm_" #noun "_get_int_array", handle, [&](capi::H &h) {                  \
            return capi::get_int_array(h, key, capacity, values, count);                                     \
        });                                                                                                  \
    }

PLM_SETTERS(model, ModelHandle)
PLM_GETTERS(model, ModelHandle)
PLM_ARRAY_GETTERS(model, ModelHandle)
PLM_SETTERS(sampler, SamplerHandle)
PLM_GETTERS(sampler, SamplerHandle)
PLM_ARRAY_GETTERS(sampler, SamplerHandle)
PLM_SETTERS(basis, BasisHandle)
PLM_GETTERS(basis, BasisHandle)
PLM_ARRAY_GETTERS(basis, BasisHandle)
PLM_SETTERS(hbm, HbmHandle)
PLM_GETTERS(hbm, HbmHandle)
PLM_GETTERS(branch, BranchHandle)
PLM_ARRAY_GETTERS(branch, BranchHandle)
PLM_SETTERS(transient, TransientHandle)
PLM_GETTERS(transient, TransientHandle)
PLM_ARRAY_GETTERS(transient, TransientHandle)
PLM_SETTERS(study, StudyHandle)
PLM_GETTERS(study, StudyHandle)
PLM_ARRAY_GETTERS(study, StudyHandle)
