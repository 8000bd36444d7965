// The one table of options and results: what the getters and setters of every handle, the introspection
// functions, the key reference, the Fortran constants and the Python attributes are made from.
#pragma once
#include "capi/arguments.hpp"
#include "capi/registry.hpp"
#include "linalg/scale.hpp"
#include <functional>
#include <string>

namespace plm::capi {

/// A value on its way through the table; the member that counts is given by the key's type.
struct Value {
    std::int64_t integer = 0;
    double real = 0;
    std::string text;
    vector<double> array;
    vector<std::int64_t> int_array;
};

struct Key {
    const char *name;
    std::int32_t type; // PLM_TYPE_...
    bool is_option;
    const char *description; // one line, with units
    double minimum = 0, maximum = 0;
    const char *choices = "";    // string options: words separated by commas
    bool nan_is_unknown = false; // results of studies: NaN stands for what a method did not deliver
    // options: on the options struct of the kind; write: choices as their position in `integer`
    void (*read_option)(const void *options, Value &) = nullptr;
    void (*write_option)(void *options, const Value &) = nullptr;
    // results: throws PLM_ERR_STATE when it is too early
    std::function<void(const Object &, Value &)> read_result = nullptr;
};

constexpr double huge = largest_scale; // "no bound"

// The tables, one per kind (keys_<kind>.cpp).
const std::vector<Key> &model_keys();
const std::vector<Key> &sampler_keys();
const std::vector<Key> &basis_keys();
const std::vector<Key> &hbm_keys();
const std::vector<Key> &branch_keys();
const std::vector<Key> &transient_keys();
const std::vector<Key> &study_keys();

const std::vector<Key> &keys_of(Kind kind);
/// PLM_ERR_KEY with the nearest name when there is none.
const Key &find_key(Kind kind, const char *name);
/// Words of a comma-separated list.
std::vector<std::string> split_words(const char *list);
/// Default of an option as text.
std::string default_text(Kind kind, const Key &key);
/// Those of an options struct that are not the defaults: "key = value, key = value".
std::string changed_options(Kind kind, const void *options);

// The bodies of plm_X_set_* and plm_X_get_*.
plm_status set_int(Object &object, const char *key, std::int64_t value);
plm_status set_double(Object &object, const char *key, double value);
plm_status set_string(Object &object, const char *key, const char *value);
plm_status get_int(Object &object, const char *key, std::int64_t *value);
plm_status get_double(Object &object, const char *key, double *value);
plm_status get_string(Object &object, const char *key, std::int64_t capacity, char *buffer,
                      std::int64_t *needed);
plm_status get_array(Object &object, const char *key, std::int64_t capacity, double *values,
                     std::int64_t *count);
plm_status get_int_array(Object &object, const char *key, std::int64_t capacity, std::int64_t *values,
                         std::int64_t *count);

// ---- Makers of table rows ----

template <class> struct MemberOf;
template <class Struct_, class Type_> struct MemberOf<Type_ Struct_::*> {
    using Struct = Struct_;
    using Type = Type_;
};

/// Integer or bool member of an options struct.
template <auto member>
Key int_option(const char *name, double minimum, double maximum, const char *description) {
    using M = MemberOf<decltype(member)>;
    Key key{name, PLM_TYPE_INT, true, description, minimum, maximum};
    key.read_option = [](const void *o, Value &v) {
        v.integer = static_cast<std::int64_t>(static_cast<const typename M::Struct *>(o)->*member);
    };
    key.write_option = [](void *o, const Value &v) {
        static_cast<typename M::Struct *>(o)->*member = static_cast<typename M::Type>(v.integer);
    };
    return key;
}

template <auto member>
Key real_option(const char *name, double minimum, double maximum, const char *description) {
    using M = MemberOf<decltype(member)>;
    Key key{name, PLM_TYPE_DOUBLE, true, description, minimum, maximum};
    key.read_option = [](const void *o, Value &v) {
        v.real = static_cast<const typename M::Struct *>(o)->*member;
    };
    key.write_option = [](void *o, const Value &v) {
        static_cast<typename M::Struct *>(o)->*member = v.real;
    };
    return key;
}

/// Enum (or bool) member; the choices stand for the values first, first + 1, ...
template <auto member, int first = 0>
Key choice_option(const char *name, const char *choices, const char *description) {
    using M = MemberOf<decltype(member)>;
    Key key{name, PLM_TYPE_STRING, true, description, 0, 0, choices};
    key.read_option = [](const void *o, Value &v) {
        v.integer = static_cast<int>(static_cast<const typename M::Struct *>(o)->*member) - first;
    };
    key.write_option = [](void *o, const Value &v) {
        static_cast<typename M::Struct *>(o)->*member = static_cast<typename M::Type>(v.integer + first);
    };
    return key;
}

inline std::int32_t put(Value &v, std::int64_t x) {
    return v.integer = x, PLM_TYPE_INT;
}
inline std::int32_t put(Value &v, double x) {
    return v.real = x, PLM_TYPE_DOUBLE;
}
inline std::int32_t put(Value &v, std::string x) {
    return v.text = std::move(x), PLM_TYPE_STRING;
}
inline std::int32_t put(Value &v, vector<double> x) {
    return v.array = std::move(x), PLM_TYPE_ARRAY;
}
inline std::int32_t put(Value &v, vector<std::int64_t> x) {
    return v.int_array = std::move(x), PLM_TYPE_INT_ARRAY;
}

/// get(const H &) for a handle class H; its return type decides the type of the key.
template <class H, class Get> Key result(const char *name, const char *description, Get get) {
    using T = decltype(get(std::declval<const H &>()));
    Value unused;
    Key key{name, put(unused, T()), false, description};
    key.read_result = [get](const Object &o, Value &v) { put(v, get(static_cast<const H &>(o))); };
    return key;
}

/// What a handle warns of, for people and for programs; get(const H &) gives its Warnings.
template <class H, class Get> Key warning_text(Get get) {
    return result<H>("warning", "what should be looked at; empty: nothing",
                     [get](const H &h) { return get(h).text(); });
}
template <class H, class Get> Key warning_reasons(Get get) {
    return result<H>("warning_reasons", "PLM_REASON_... of each part of \"warning\"",
                     [get](const H &h) { return get(h).reasons(); });
}

} // namespace plm::capi
