#include "linalg/warnings.hpp"
#include <algorithm>

namespace plm {

void Warnings::add(std::int32_t reason, const std::string &text) {
    for (const Warning &w : list_)
        if (w.reason == reason && w.text == text) return;
    list_.push_back({reason, text});
}

void Warnings::add(const Warnings &others) {
    for (const Warning &w : others.list_) add(w.reason, w.text);
}

bool Warnings::has(std::int32_t reason) const {
    return std::any_of(list_.begin(), list_.end(), [&](const Warning &w) { return w.reason == reason; });
}

std::string Warnings::text() const {
    std::string all;
    for (const Warning &w : list_) all += (all.empty() ? "" : "; ") + w.text;
    return all;
}

vector<std::int64_t> Warnings::reasons() const {
    vector<std::int64_t> all;
    for (const Warning &w : list_) all.push_back(w.reason);
    return all;
}

} // namespace plm
