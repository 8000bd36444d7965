#include "capi/registry.hpp"
#include <algorithm>
#include <mutex>

namespace plm::capi::registry {
namespace {

struct Slot {
    std::shared_ptr<Object> object;
    std::uintptr_t generation = 1;
    std::uint64_t born = 0; // order of creation
};

struct Table {
    std::mutex mutex;
    std::vector<Slot> slots;
    std::vector<std::size_t> unused;
    std::uint64_t births = 0;
};

// Never destroyed: a host may still hold handles in its own static destructors.
Table &table() {
    static Table *const the_table = new Table;
    return *the_table;
}

// Handle = generation | kind | slot | 1. Odd, so that it is the address of nothing a host could have
// allocated.
constexpr int slot_bits = sizeof(std::uintptr_t) >= 8 ? 24 : 14, kind_bits = 4;
constexpr std::uintptr_t slot_mask = (std::uintptr_t(1) << slot_bits) - 1;
constexpr std::uintptr_t kind_mask = (std::uintptr_t(1) << kind_bits) - 1;
constexpr std::uintptr_t generation_mask = ~std::uintptr_t(0) >> (slot_bits + kind_bits + 1);

void *encode(std::size_t slot, Kind kind, std::uintptr_t generation) {
    const std::uintptr_t named = (generation << kind_bits) | static_cast<std::uintptr_t>(kind);
    return reinterpret_cast<void *>((((named << slot_bits) | slot) << 1) | 1);
}

struct Decoded {
    Slot *slot = nullptr; // null: no handle of this kind was ever made like this
    std::uintptr_t generation = 0;
};

// The table is locked.
Decoded decode(Table &t, const void *handle, Kind kind) {
    const std::uintptr_t bits = reinterpret_cast<std::uintptr_t>(handle);
    const std::size_t slot = static_cast<std::size_t>((bits >> 1) & slot_mask);
    if (!(bits & 1) || slot >= t.slots.size()) return {};
    const std::uintptr_t named = (bits >> 1) >> slot_bits;
    if ((named & kind_mask) != static_cast<std::uintptr_t>(kind)) return {};
    return {&t.slots[slot], named >> kind_bits};
}

// The live slot behind a handle, or null.
Slot *live(Table &t, const void *handle, Kind kind) {
    const Decoded d = decode(t, handle, kind);
    const bool alive =
        d.slot && d.slot->object && d.slot->generation == d.generation && d.slot->object->kind == kind;
    return alive ? d.slot : nullptr;
}

std::shared_ptr<Object> vacate(Table &t, Slot &s) {
    s.generation = (s.generation + 1) & generation_mask;
    t.unused.push_back(static_cast<std::size_t>(&s - t.slots.data())); // reserved in add()
    return std::move(s.object);
}

} // namespace

void *add(std::shared_ptr<Object> object) {
    Table &t = table();
    const std::lock_guard<std::mutex> lock(t.mutex);
    if (t.unused.empty()) {
        if (t.slots.size() > slot_mask) throw std::bad_alloc();
        t.slots.emplace_back();
        t.unused.reserve(t.slots.capacity()); // vacate() must not fail
        t.unused.push_back(t.slots.size() - 1);
    }
    const std::size_t slot = t.unused.back();
    t.unused.pop_back();
    t.slots[slot].object = std::move(object);
    t.slots[slot].born = ++t.births;
    return encode(slot, t.slots[slot].object->kind, t.slots[slot].generation);
}

std::shared_ptr<Object> find(const void *handle, Kind kind) {
    Table &t = table();
    const std::lock_guard<std::mutex> lock(t.mutex);
    const Slot *s = live(t, handle, kind);
    return s ? s->object : nullptr;
}

bool is_gone(const void *handle, Kind kind) {
    Table &t = table();
    const std::lock_guard<std::mutex> lock(t.mutex);
    const Decoded d = decode(t, handle, kind);
    return d.slot && d.generation > 0 && d.generation < d.slot->generation;
}

std::shared_ptr<Object> remove(const void *handle, Kind kind) {
    Table &t = table();
    const std::lock_guard<std::mutex> lock(t.mutex);
    Slot *s = live(t, handle, kind);
    return s ? vacate(t, *s) : nullptr;
}

std::vector<std::shared_ptr<Object>> remove_children(const Context *context) {
    Table &t = table();
    const std::lock_guard<std::mutex> lock(t.mutex);
    std::vector<Slot *> mine;
    for (Slot &s : t.slots)
        if (s.object && s.object->owner.get() == context) mine.push_back(&s);
    std::sort(mine.begin(), mine.end(), [](const Slot *a, const Slot *b) { return a->born > b->born; });
    std::vector<std::shared_ptr<Object>> removed;
    removed.reserve(mine.size());
    for (Slot *s : mine) removed.push_back(vacate(t, *s));
    return removed;
}

} // namespace plm::capi::registry
