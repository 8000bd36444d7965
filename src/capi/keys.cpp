#include "capi/keys.hpp"
#include "capi/handles.hpp"
#include <algorithm>
#include <cstring>

namespace plm::capi {
namespace {

const char *kind_name(Kind kind) {
    static const char *const names[] = {"context", "model",  "sampler",   "basis",
                                        "hbm",     "branch", "transient", "study"};
    return names[static_cast<int>(kind)];
}

const char *type_name(std::int32_t type) {
    static const char *const names[] = {"", "int", "double", "string", "array", "int_array"};
    return names[type];
}

const void *default_options(Kind kind) {
    static const SpaceOptions model;
    static const SamplerOptions sampler;
    static const BasisOptions basis;
    static const HbmOptions hbm;
    static const TransientOptions transient;
    static const StudyOptions study;
    switch (kind) {
    case Kind::model:
        return &model;
    case Kind::sampler:
        return &sampler;
    case Kind::basis:
        return &basis;
    case Kind::hbm:
        return &hbm;
    case Kind::transient:
        return &transient;
    case Kind::study:
        return &study;
    default:
        return nullptr;
    }
}

std::size_t edit_distance(const std::string &a, const std::string &b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = diagonal + (a[i - 1] != b[j - 1]);
            diagonal = row[j];
            row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
        }
    }
    return row.back();
}

std::string nearest_name(const std::vector<Key> &keys, const std::string &name) {
    const auto nearer = [&](const Key &a, const Key &b) {
        return edit_distance(a.name, name) < edit_distance(b.name, name);
    };
    return std::min_element(keys.begin(), keys.end(), nearer)->name;
}

[[noreturn]] void wrong_type(const Key &key, const char *verb) {
    bad_argument("key", -1,
                 format("\"%s\" is of type %s; use the %s_%s function", key.name, type_name(key.type), verb,
                        type_name(key.type)));
}

const Key &find_option(Object &object, const char *name) {
    const Key &key = find_key(object.kind, name);
    if (!key.is_option) bad_argument("key", -1, format("\"%s\" is a result; it can be read only", key.name));
    if (const char *why = object.frozen()) throw Error(PLM_ERR_STATE, why);
    return key;
}

void require_bounds(const Key &key, double value) {
    if (!(value >= key.minimum && value <= key.maximum))
        bad_argument("value", -1,
                     format("\"%s\" is %g; it must lie in %g..%g (%s)", key.name, value, key.minimum,
                            key.maximum, key.description));
}

Value read(Object &object, const Key &key) {
    Value v;
    if (!key.is_option) {
        key.read_result(object, v);
    } else {
        key.read_option(object.options(), v);
        if (key.type == PLM_TYPE_STRING)
            v.text = split_words(key.choices)[static_cast<std::size_t>(v.integer)];
    }
    return v;
}

std::string option_text(const Key &key, const void *options) {
    Value v;
    key.read_option(options, v);
    if (key.type == PLM_TYPE_INT) return std::to_string(v.integer);
    if (key.type == PLM_TYPE_DOUBLE) {
        const std::string few = format("%g", v.real);
        return std::strtod(few.c_str(), nullptr) == v.real ? few : format("%.17g", v.real);
    }
    return split_words(key.choices)[static_cast<std::size_t>(v.integer)];
}

} // namespace

std::vector<std::string> split_words(const char *list) {
    std::vector<std::string> words;
    for (const char *p = list; *p;) {
        const char *end = std::strchr(p, ',');
        words.emplace_back(p, end ? static_cast<std::size_t>(end - p) : std::strlen(p));
        p = end ? end + 1 : p + words.back().size();
    }
    return words;
}

const std::vector<Key> &keys_of(Kind kind) {
    switch (kind) {
    case Kind::model:
        return model_keys();
    case Kind::sampler:
        return sampler_keys();
    case Kind::basis:
        return basis_keys();
    case Kind::hbm:
        return hbm_keys();
    case Kind::branch:
        return branch_keys();
    case Kind::transient:
        return transient_keys();
    case Kind::study:
        return study_keys();
    default:
        throw Error(PLM_ERR_INTERNAL, "this kind of handle has no keys");
    }
}

const Key &find_key(Kind kind, const char *name) {
    require_pointer(name, "key");
    const std::vector<Key> &keys = keys_of(kind);
    for (const Key &key : keys)
        if (std::strcmp(key.name, name) == 0) return key;
    throw Error(PLM_ERR_KEY, format("%s has no key \"%.80s\"; did you mean \"%s\"?", kind_name(kind), name,
                                    nearest_name(keys, std::string(name).substr(0, 80)).c_str()))
        .argument("key");
}

std::string default_text(Kind kind, const Key &key) {
    return key.is_option ? option_text(key, default_options(kind)) : "";
}

std::string changed_options(Kind kind, const void *options) {
    std::string text;
    for (const Key &key : keys_of(kind)) {
        if (!key.is_option) continue;
        const std::string now = option_text(key, options);
        if (now != option_text(key, default_options(kind)))
            text += (text.empty() ? "" : ", ") + (key.name + (" = " + now));
    }
    return text;
}

plm_status set_int(Object &object, const char *name, std::int64_t value) {
    const Key &key = find_option(object, name);
    if (key.type == PLM_TYPE_DOUBLE) return set_double(object, name, static_cast<double>(value));
    if (key.type != PLM_TYPE_INT) wrong_type(key, "set");
    require_bounds(key, static_cast<double>(value));
    Value v;
    v.integer = value;
    key.write_option(object.options(), v);
    return PLM_OK;
}

plm_status set_double(Object &object, const char *name, double value) {
    const Key &key = find_option(object, name);
    if (key.type != PLM_TYPE_DOUBLE) wrong_type(key, "set");
    require_bounds(key, value); // refuses NaN, too
    if (too_small(value) && key.maximum == huge)
        bad_argument("value", -1,
                     format("\"%s\" is %g; below %g squares and products vanish: choose other units, or 0",
                            key.name, value, smallest_scale));
    Value v;
    v.real = value;
    key.write_option(object.options(), v);
    return PLM_OK;
}

plm_status set_string(Object &object, const char *name, const char *value) {
    const Key &key = find_option(object, name);
    if (key.type != PLM_TYPE_STRING) wrong_type(key, "set");
    require_pointer(value, "value");
    const std::vector<std::string> words = split_words(key.choices);
    const auto word = std::find(words.begin(), words.end(), value);
    if (word == words.end())
        bad_argument("value", -1,
                     format("\"%s\" cannot be \"%.80s\"; choose one of %s", key.name, value, key.choices));
    Value v;
    v.integer = word - words.begin();
    key.write_option(object.options(), v);
    return PLM_OK;
}

plm_status get_int(Object &object, const char *name, std::int64_t *value) {
    const Key &key = find_key(object.kind, name);
    require_pointer(value, "value");
    if (key.type != PLM_TYPE_INT) wrong_type(key, "get");
    *value = read(object, key).integer;
    return PLM_OK;
}

plm_status get_double(Object &object, const char *name, double *value) {
    const Key &key = find_key(object.kind, name);
    require_pointer(value, "value");
    if (key.type != PLM_TYPE_DOUBLE && key.type != PLM_TYPE_INT) wrong_type(key, "get");
    const Value v = read(object, key);
    const double real = key.type == PLM_TYPE_INT ? static_cast<double>(v.integer) : v.real;
    if (!key.nan_is_unknown) require_finite_result(&real, 1, key.name);
    *value = real;
    return PLM_OK;
}

plm_status get_string(Object &object, const char *name, std::int64_t capacity, char *buffer,
                      std::int64_t *needed) {
    const Key &key = find_key(object.kind, name);
    if (key.type != PLM_TYPE_STRING) wrong_type(key, "get");
    return put_text(read(object, key).text, capacity, buffer, needed);
}

plm_status get_array(Object &object, const char *name, std::int64_t capacity, double *values,
                     std::int64_t *count) {
    const Key &key = find_key(object.kind, name);
    if (key.type != PLM_TYPE_ARRAY) wrong_type(key, "get");
    const Value v = read(object, key);
    if (values && !key.nan_is_unknown)
        require_finite_result(v.array.data(), static_cast<std::int64_t>(v.array.size()), key.name);
    return put_array(v.array, capacity, values, count);
}

plm_status get_int_array(Object &object, const char *name, std::int64_t capacity, std::int64_t *values,
                         std::int64_t *count) {
    const Key &key = find_key(object.kind, name);
    if (key.type != PLM_TYPE_INT_ARRAY) wrong_type(key, "get");
    return put_array(read(object, key).int_array, capacity, values, count);
}

} // namespace plm::capi
