// Options drawn from the key table, and every result of the key table read.
#pragma once
#include "witness.hpp"
#include <string>

namespace scenarios {

struct Key {
    std::string name, default_value;
    std::int32_t type = 0;
    bool is_option = false, may_be_nan = false;
    double low = 0, high = 0;
    std::vector<std::string> words;
};

/// The keys of one kind of handle, PLM_KIND_MODEL ... PLM_KIND_STUDY, as the library lists them.
const std::vector<Key> &keys_of(std::int32_t kind);

/// The functions by which one kind of handle sets options and reads results; null where there is none.
template <class H> struct Access {
    std::int32_t kind;
    plm_status (*set_int)(H *, const char *, std::int64_t);
    plm_status (*set_double)(H *, const char *, double);
    plm_status (*set_string)(H *, const char *, const char *);
    plm_status (*get_int)(H *, const char *, std::int64_t *);
    plm_status (*get_double)(H *, const char *, double *);
    plm_status (*get_string)(H *, const char *, std::int64_t, char *, std::int64_t *);
    plm_status (*get_array)(H *, const char *, std::int64_t, double *, std::int64_t *);
    plm_status (*get_int_array)(H *, const char *, std::int64_t, std::int64_t *, std::int64_t *);
};
#define ACCESS(noun, KIND)                                                                                   \
    {                                                                                                        \
        KIND, plm_##noun##_set_int, plm_##noun##_set_double, plm_##noun##_set_string, plm_##noun##_get_int,  \
            plm_##noun##_get_double, plm_##noun##_get_string, plm_##noun##_get_array,                        \
            plm_##noun##_get_int_array                                                                       \
    }
inline const Access<plm_model> model_access ACCESS(model, PLM_KIND_MODEL);
inline const Access<plm_sampler> sampler_access ACCESS(sampler, PLM_KIND_SAMPLER);
inline const Access<plm_basis> basis_access ACCESS(basis, PLM_KIND_BASIS);
inline const Access<plm_transient> transient_access ACCESS(transient, PLM_KIND_TRANSIENT);
inline const Access<plm_study> study_access ACCESS(study, PLM_KIND_STUDY);
inline const Access<plm_hbm> hbm_access{PLM_KIND_HBM,       plm_hbm_set_int, plm_hbm_set_double,
                                        plm_hbm_set_string, plm_hbm_get_int, plm_hbm_get_double,
                                        plm_hbm_get_string, nullptr,         nullptr};
inline const Access<plm_branch> branch_access{PLM_KIND_BRANCH,
                                              nullptr,
                                              nullptr,
                                              nullptr,
                                              plm_branch_get_int,
                                              plm_branch_get_double,
                                              plm_branch_get_string,
                                              plm_branch_get_array,
                                              plm_branch_get_int_array};
#undef ACCESS

/// Values that no one should ask for, and the library must refuse or survive.
double wild(Random &random);
std::int64_t drawn_int(Random &random, const Key &key);
double drawn_double(Random &random, const Key &key);
std::string drawn_word(Random &random, const Key &key);

/// Each option with a chance of `share`.
template <class H>
void draw_options(Witness &w, Random &random, const Access<H> &access, H *handle, double share) {
    for (const Key &key : keys_of(access.kind)) {
        if (!key.is_option || !random.chance(share)) continue;
        const char *name = key.name.c_str();
        w.begin((key.name + " is set").c_str());
        if (key.type == PLM_TYPE_INT)
            w.end(access.set_int(handle, name, drawn_int(random, key)));
        else if (key.type == PLM_TYPE_DOUBLE)
            w.end(access.set_double(handle, name, drawn_double(random, key)));
        else
            w.end(access.set_string(handle, name, drawn_word(random, key).c_str()));
    }
}

template <class H> void read_array(Witness &w, const Access<H> &access, H *handle, const Key &key) {
    std::int64_t n = 0;
    const char *name = key.name.c_str();
    if (w.end(access.get_array(handle, name, 0, nullptr, &n)) != PLM_OK) return;
    std::vector<double> values(static_cast<std::size_t>(n) + 1);
    w.begin((key.name + " is read").c_str());
    if (w.end(access.get_array(handle, name, n, values.data(), &n)) == PLM_OK && !key.may_be_nan)
        w.expect_finite(values.data(), static_cast<std::size_t>(n), name);
}

template <class H> void read_int_array(Witness &w, const Access<H> &access, H *handle, const Key &key) {
    std::int64_t n = 0;
    const char *name = key.name.c_str();
    if (w.end(access.get_int_array(handle, name, 0, nullptr, &n)) != PLM_OK) return;
    std::vector<std::int64_t> values(static_cast<std::size_t>(n) + 1);
    w.begin((key.name + " is read").c_str());
    w.end(access.get_int_array(handle, name, n, values.data(), &n));
}

/// Every key of the table; results are finite unless their description says when they are not.
template <class H> void read_results(Witness &w, const Access<H> &access, H *handle) {
    for (const Key &key : keys_of(access.kind)) {
        const char *name = key.name.c_str();
        w.begin((key.name + " is read").c_str());
        std::int64_t n = 0;
        double value = 0;
        char text[500];
        if (key.type == PLM_TYPE_INT) {
            w.end(access.get_int(handle, name, &n));
        } else if (key.type == PLM_TYPE_DOUBLE) {
            if (w.end(access.get_double(handle, name, &value)) == PLM_OK && !key.is_option && !key.may_be_nan)
                w.expect_finite(&value, 1, name);
        } else if (key.type == PLM_TYPE_STRING) {
            w.end(access.get_string(handle, name, sizeof text, text, &n));
        } else if (key.type == PLM_TYPE_ARRAY && access.get_array) {
            read_array(w, access, handle, key);
        } else if (key.type == PLM_TYPE_INT_ARRAY && access.get_int_array) {
            read_int_array(w, access, handle, key);
        }
    }
}

} // namespace scenarios
