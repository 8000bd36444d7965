// What an operation threw, as values to assert on.
#pragma once
#include "linalg/error.hpp"

struct Caught {
    plm::Status status = plm::status::ok;
    std::string argument, text;
    std::int64_t index = -1;
    bool says(const char *part) const {
        const bool found = text.find(part) != std::string::npos;
        if (!found) std::printf("    text: %s\n    lacks: %s\n", text.c_str(), part);
        return found;
    }
};

template <class Body> Caught caught(Body body) {
    try {
        body();
    } catch (const plm::Error &e) {
        return {e.status(), e.argument(), e.what(), e.index()};
    }
    return {};
}
