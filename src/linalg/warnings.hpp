// What should be looked at with a result that is valid as far as it goes.
#pragma once
#include "memory.hpp"
#include <cstdint>
#include <string>
#include <vector>

namespace plm {

struct Warning {
    std::int32_t reason; // PLM_REASON_...
    std::string text;    // cause and remedy
};

class Warnings {
  public:
    /// What was said once is not said again.
    void add(std::int32_t reason, const std::string &text);
    void add(const Warnings &others);
    bool empty() const { return list_.empty(); }
    const std::vector<Warning> &list() const { return list_; }
    bool has(std::int32_t reason) const;
    /// All texts, joined by "; ". Empty: nothing to look at.
    std::string text() const;
    /// The reasons in the same order.
    vector<std::int64_t> reasons() const;

  private:
    std::vector<Warning> list_;
};

} // namespace plm
