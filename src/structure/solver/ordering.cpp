#include "structure/solver/ordering.hpp"
#include "structure/solver/scotch.hpp"
#include <algorithm>
#include <numeric>

namespace plm {
namespace {

/// A good 64-bit hash of an index (the finalizer of SplitMix64).
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

std::uint64_t pattern_of(const SparseMatrix &a) {
    std::uint64_t hash = mixed(static_cast<std::uint64_t>(a.cols));
    for (std::int64_t j : a.ptr) hash = mixed(hash ^ static_cast<std::uint64_t>(j));
    for (std::int64_t i : a.idx) hash = mixed(hash ^ static_cast<std::uint64_t>(i));
    return hash;
}

bool same_column(const SparseMatrix &a, std::int64_t j, std::int64_t k) {
    return std::equal(a.idx.begin() + a.ptr[j], a.idx.begin() + a.ptr[j + 1], a.idx.begin() + a.ptr[k],
                      a.idx.begin() + a.ptr[k + 1]);
}

/// Vertex of each row: rows whose columns have one pattern (and with it the diagonal) share theirs.
vector<std::int64_t> vertices_of_rows(const SparseMatrix &a, NodeGraph &graph) {
    vector<std::uint64_t> hash(a.cols, 0);
    for (std::int64_t j = 0; j < a.cols; ++j)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            hash[j] += mixed(static_cast<std::uint64_t>(a.idx[p]));
    graph.row.resize(a.cols);
    std::iota(graph.row.begin(), graph.row.end(), std::int64_t(0));
    std::sort(graph.row.begin(), graph.row.end(),
              [&](std::int64_t j, std::int64_t k) { return hash[j] != hash[k] ? hash[j] < hash[k] : j < k; });
    vector<std::int64_t> vertex(a.cols);
    for (std::int64_t i = 0; i < a.cols; ++i) {
        const bool joins = i > 0 && same_column(a, graph.row[i], graph.row[graph.first_row.back()]);
        if (!joins) graph.first_row.push_back(i);
        vertex[graph.row[i]] = static_cast<std::int64_t>(graph.first_row.size()) - 1;
    }
    graph.first_row.push_back(a.cols);
    return vertex;
}

} // namespace

NodeGraph node_graph(const SparseMatrix &a) {
    NodeGraph graph;
    const vector<std::int64_t> vertex = vertices_of_rows(a, graph);
    vector<std::int64_t> seen(graph.size(), -1);
    graph.first_neighbour.push_back(0);
    for (std::int64_t v = 0; v < graph.size(); ++v) {
        seen[v] = v;
        const std::int64_t j = graph.row[graph.first_row[v]];
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
            const std::int64_t other = vertex[a.idx[p]];
            if (seen[other] == v) continue;
            seen[other] = v;
            graph.neighbour.push_back(other);
        }
        graph.first_neighbour.push_back(static_cast<std::int64_t>(graph.neighbour.size()));
    }
    return graph;
}

vector<std::int64_t> nested_dissection(const SparseMatrix &a) {
#ifdef PLM_WITH_SCOTCH
    const NodeGraph graph = node_graph(a);
    const vector<std::int64_t> nodes = order_by_scotch(graph);
    vector<std::int64_t> order;
    order.reserve(nodes.empty() ? 0 : a.cols);
    for (std::int64_t v : nodes)
        order.insert(order.end(), graph.row.begin() + graph.first_row[v],
                     graph.row.begin() + graph.first_row[v + 1]);
    return order;
#else
    return {};
#endif
}

std::string ordering_backend() {
#ifdef PLM_WITH_SCOTCH
    return " with SCOTCH " + scotch_version();
#else
    return {};
#endif
}

const vector<std::int64_t> *KeptOrders::find(const SparseMatrix &a) const {
    const std::uint64_t pattern = pattern_of(a);
    for (const Kept &one : kept_)
        if (one.pattern == pattern && static_cast<std::int64_t>(one.order.size()) == a.cols)
            return &one.order;
    return nullptr;
}

void KeptOrders::keep(const SparseMatrix &a, const std::int64_t *order) {
    constexpr std::size_t most = 4;
    if (kept_.size() == most) kept_.erase(kept_.begin());
    kept_.push_back({pattern_of(a), vector<std::int64_t>(order, order + a.cols)});
}

} // namespace plm
