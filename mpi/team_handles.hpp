// Teams as plm_mpi.h hands them out, and what keeps exceptions from their callers.
#pragma once
#include "capi/barrier.hpp"
#include "mpi/service.hpp"
#include "plm/plm_mpi.h"
#include <map>
#include <mutex>

namespace plm::mpi {

struct Handle {
    Service service;
    std::string error;
    plm_context *context = nullptr; // rank 0: of the model
};

/// Live teams by the number that their handles are: a stale one is recognised, and never dereferenced.
struct Table {
    std::mutex lock;
    std::map<std::uintptr_t, std::shared_ptr<Handle>> teams;
    std::uintptr_t next = 1;
};
inline Table &table() {
    static Table t;
    return t;
}
inline thread_local std::string creation_error;

inline std::shared_ptr<Handle> find(const void *team) {
    const std::lock_guard<std::mutex> lock(table().lock);
    const auto found = table().teams.find(reinterpret_cast<std::uintptr_t>(team));
    return found == table().teams.end() ? nullptr : found->second;
}

inline std::uintptr_t enter(std::shared_ptr<Handle> handle) {
    const std::lock_guard<std::mutex> lock(table().lock);
    table().teams[table().next] = std::move(handle);
    return table().next++;
}
inline void leave(std::uintptr_t number) {
    const std::lock_guard<std::mutex> lock(table().lock);
    table().teams.erase(number);
}

inline Status told(std::string &text, const char *function, const Verdict &v) noexcept {
    try {
        text = std::string(function) + ": " + v.text;
    } catch (...) { // no memory for the text: the status stands
        text.clear();
    }
    return v.status;
}

/// body(Handle &) of a live team; what it throws becomes status and text.
template <class Body> plm_status call(const char *function, const void *team, Body body) noexcept {
    capi::HeldThread held;
    std::shared_ptr<Handle> handle;
    try {
        handle = find(team);
        if (!handle) return PLM_ERR_HANDLE;
        return body(*handle);
    } catch (...) {
        if (!handle) return PLM_ERR_MEMORY;
        return told(handle->error, function, Team::describe_failure());
    }
}

} // namespace plm::mpi
