// Handles: what a host holds is a number that names a slot of one table and the slot's generation, never an
// address. A handle is looked up, not dereferenced, so a stale, foreign or made-up one is recognised.
#pragma once
#include "plm/plm.h"
#include <cstdint>
#include <memory>
#include <vector>

namespace plm::capi {

enum class Kind {
    context = 0,
    model = PLM_KIND_MODEL,
    sampler = PLM_KIND_SAMPLER,
    basis = PLM_KIND_BASIS,
    hbm = PLM_KIND_HBM,
    branch = PLM_KIND_BRANCH,
    transient = PLM_KIND_TRANSIENT,
    study = PLM_KIND_STUDY
};

struct Context;

/// What a handle names. It keeps its context alive, derived members hold the parents.
struct Object {
    Object(Kind k, std::shared_ptr<Context> c) : kind(k), owner(std::move(c)) {}
    virtual ~Object() = default;
    Object(const Object &) = delete;
    Object &operator=(const Object &) = delete;
    /// The options struct that the key table writes to; null for kinds without options.
    virtual void *options() { return nullptr; }
    /// Why options can no longer be set; null while they can.
    virtual const char *frozen() const { return nullptr; }

    const Kind kind;
    const std::shared_ptr<Context> owner; // null for a context itself
};

namespace registry {
void *add(std::shared_ptr<Object> object);
/// Did the handle name an object of this kind that has been destroyed since?
bool is_gone(const void *handle, Kind kind);
/// Null when the handle is not a live one of this kind.
std::shared_ptr<Object> find(const void *handle, Kind kind);
/// Takes the object out; the handle is stale from now on. Null as for find().
std::shared_ptr<Object> remove(const void *handle, Kind kind);
/// Takes out everything made in a context, youngest first, the context itself excepted.
std::vector<std::shared_ptr<Object>> remove_children(const Context *context);
} // namespace registry

/// H: a handle class with H::Opaque (plm_model ...) and H::the_kind.
template <class H> typename H::Opaque *publish(std::shared_ptr<H> object) {
    return static_cast<typename H::Opaque *>(registry::add(std::move(object)));
}
template <class H> std::shared_ptr<H> find(const typename H::Opaque *handle) {
    return std::static_pointer_cast<H>(registry::find(handle, H::the_kind));
}

} // namespace plm::capi
