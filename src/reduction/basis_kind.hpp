// A kind of basis as the rest of the library sees it: its name, the options it reads, what it needs and how
// it is built. What differs from kind to kind is asked here and nowhere else.
#pragma once
#include "linalg/memory.hpp"
#include "linalg/monitor.hpp"
#include "reduction/basis_kinds.hpp"
#include <cstdint>
#include <memory>

namespace plm {

class Model;
class Sampler;
struct BasisOptions;
struct CollectedModes;
struct Compressed;
struct Responses;
struct RestState;
struct SelectionRule;
struct Space;

/// What the columns of a basis are collected from.
struct ColumnSources {
    const Space &space;
    const Sampler *sampler; // null where there is none
    const std::vector<vector<double>>
        &dominant; // the sampler's dominant modes in the coordinates of this space
    const RestState &rest;
    const SelectionRule &rule;
    const BasisOptions &options;
};

/// There are three ways to a basis: columns are collected in a space and conditioned; a parent is compressed
/// to its responses; or P is a whole space. The functions that are not null say which.
struct BasisKind {
    constexpr BasisKind(const char *its_name, const char *its_description)
        : name(its_name), description(its_description) {}

    const char *name;
    const char *description;       // what P is made of, a clause for the reference of the keys
    const char *own_options = "";  // keys that only this kind reads, separated by commas
    bool needs_sampler = false;    // is made from the dominant mode and the contact sweep of a sampler
    bool needs_pairs = false;      // is about contact
    bool any_parent = false;       // else a parent must be a whole space, which the columns are collected in
    bool has_load_vectors = false; // its columns hold the static responses to the loads already

    /// Throws PLM_ERR_ARGUMENT where the options ask for more than the model has.
    void (*check)(const BasisOptions &options, std::int64_t n_pairs) = nullptr;
    /// Modes are taken up to here (Hz); null: up to the end of the rule.
    double (*highest_hz)(const BasisOptions &options, const SelectionRule &rule) = nullptr;
    /// Its own space for frequencies up to `highest` (rad/s); null: a contact space.
    std::shared_ptr<const Space> (*make_space)(const std::shared_ptr<const Model> &model,
                                               const BasisOptions &options, double highest,
                                               Watch watch) = nullptr;
    CollectedModes (*collect)(const ColumnSources &from, Watch watch) = nullptr;
    Compressed (*compress)(const Responses &responses, const BasisOptions &options) = nullptr;

    /// Modes of linear systems and vectors beside them.
    constexpr bool is_collected() const { return collect != nullptr; }
    constexpr bool is_compressed() const { return compress != nullptr; }
};

} // namespace plm
