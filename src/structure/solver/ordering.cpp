#include "structure/solver/ordering.hpp"
#include "structure/solver/hash.hpp"
#include "structure/solver/node_graph.hpp"
#include "structure/solver/scotch.hpp"

namespace plm {
namespace {

std::uint64_t pattern_of(const SparseMatrix &a) {
    std::uint64_t hash = mixed(static_cast<std::uint64_t>(a.cols));
    for (std::int64_t j : a.ptr) hash = mixed(hash ^ static_cast<std::uint64_t>(j));
    for (std::int64_t i : a.idx) hash = mixed(hash ^ static_cast<std::uint64_t>(i));
    return hash;
}

} // namespace

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

vector<std::int64_t> KeptOrders::find(const SparseMatrix &a) const {
    const std::uint64_t pattern = pattern_of(a);
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Kept &one : kept_)
        if (one.pattern == pattern && static_cast<std::int64_t>(one.order.size()) == a.cols) return one.order;
    return {};
}

void KeptOrders::keep(const SparseMatrix &a, const std::int64_t *order) {
    constexpr std::size_t most = 4;
    Kept one{pattern_of(a), vector<std::int64_t>(order, order + a.cols)};
    const std::lock_guard<std::mutex> lock(mutex_);
    if (kept_.size() == most) kept_.erase(kept_.begin());
    kept_.push_back(std::move(one));
}

} // namespace plm
