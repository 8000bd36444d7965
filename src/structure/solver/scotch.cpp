#include "structure/solver/scotch.hpp"
#include "linalg/carried/scotch_parts.hpp"
#include "linalg/error.hpp"
#include <cstdio> // scotch.h uses FILE without it
#include <limits>
#include <mutex>
#include <new>
#include <scotch.h>

namespace plm {
namespace {

vector<SCOTCH_Num> narrowed(const vector<std::int64_t> &from) {
    return vector<SCOTCH_Num>(from.begin(), from.end());
}

/// SCOTCH's default.
struct Strategy {
    SCOTCH_Strat it;
    Strategy() {
        carried_scotch_scans(true);
        SCOTCH_stratInit(&it);
        const int failed = SCOTCH_stratGraphOrderBuild(&it, SCOTCH_STRATQUALITY, 0, 0.2);
        carried_scotch_scans(false);
        if (failed) {
            SCOTCH_stratExit(&it);
            throw std::bad_alloc();
        }
    }
    ~Strategy() { SCOTCH_stratExit(&it); }
    Strategy(const Strategy &) = delete;
    Strategy &operator=(const Strategy &) = delete;
};

/// What its functions hold until the end, however they end.
struct Holdings {
    Holdings() = default;
    ~Holdings() { carried_scotch_release(); }
    Holdings(const Holdings &) = delete;
    Holdings &operator=(const Holdings &) = delete;
};

} // namespace

vector<std::int64_t> order_by_scotch(const NodeGraph &graph) {
    // Its scanner of strategies and its random numbers belong to the process.
    static std::mutex one_at_a_time;
    constexpr auto largest = std::numeric_limits<SCOTCH_Num>::max();
    const auto edges = static_cast<std::int64_t>(graph.neighbour.size());
    if (graph.row.size() > largest / 4 || edges > largest / 4) return {};
    const vector<SCOTCH_Num> first = narrowed(graph.first_neighbour), neighbour = narrowed(graph.neighbour);
    const auto size = static_cast<SCOTCH_Num>(graph.size());
    vector<SCOTCH_Num> weight(size), order(size);
    for (SCOTCH_Num v = 0; v < size; ++v)
        weight[v] = static_cast<SCOTCH_Num>(graph.first_row[v + 1] - graph.first_row[v]);

    const std::lock_guard<std::mutex> lock(one_at_a_time);
    Strategy strategy;
    const Holdings holdings;
    SCOTCH_Graph its_graph;
    SCOTCH_graphInit(&its_graph);
    SCOTCH_randomReset(); // the same order in every run
    if (SCOTCH_graphBuild(&its_graph, 0, size, first.data(), nullptr, weight.data(), nullptr,
                          static_cast<SCOTCH_Num>(edges), neighbour.data(), nullptr) != 0 ||
        SCOTCH_graphOrder(&its_graph, &strategy.it, nullptr, order.data(), nullptr, nullptr, nullptr) != 0)
        return {};
    return vector<std::int64_t>(order.begin(), order.end());
}

std::string scotch_version() {
    int version, release, patch;
    SCOTCH_version(&version, &release, &patch);
    return format("%d.%d.%d", version, release, patch);
}

} // namespace plm
