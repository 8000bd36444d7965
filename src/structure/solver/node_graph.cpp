#include "structure/solver/node_graph.hpp"
#include "structure/solver/hash.hpp"
#include <algorithm>
#include <numeric>

namespace plm {
namespace {

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

} // namespace plm
