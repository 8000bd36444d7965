#include "mpi/node_order.hpp"
#include "structure/solver/hash.hpp"
#include "structure/solver/scotch.hpp"
#include <algorithm>
#include <numeric>

namespace plm::mpi {
namespace {

/// The nodes of one rank, or of all one after the other.
struct Nodes {
    struct Count {
        std::int32_t rows, neighbours;
    };
    std::vector<Count> count; // of each node
    std::vector<std::int32_t> dof,
        neighbour; // its DOFs; a DOF of each node beside it, perhaps several of one
};

/// Own rows, those of one pattern side by side.
std::vector<std::int64_t> by_pattern(const Matrices &a, std::vector<std::uint64_t> &hash) {
    hash.assign(static_cast<std::size_t>(a.rows()), 0);
    for (std::int64_t i = 0; i < a.rows(); ++i)
        for (std::int32_t column : a.columns(i))
            hash[static_cast<std::size_t>(i)] += mixed(static_cast<std::uint64_t>(column));
    std::vector<std::int64_t> order(hash.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::int64_t i, std::int64_t j) {
        const auto a_hash = hash[static_cast<std::size_t>(i)], b_hash = hash[static_cast<std::size_t>(j)];
        return a_hash != b_hash ? a_hash < b_hash : i < j;
    });
    return order;
}

bool meets_itself(const Matrices &a, std::int64_t row) {
    const auto columns = a.columns(row);
    return std::find(columns.begin(), columns.end(), row) != columns.end();
}

/// Of each own row the first one of its node. Rows that do not meet each other are no node, alike as they may
/// be: those of supports are empty.
std::vector<std::int64_t> leaders(const Matrices &a, const std::vector<std::int64_t> &order,
                                  const std::vector<std::uint64_t> &hash) {
    std::vector<std::int64_t> leader(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::int64_t row = order[k],
                           before = k > 0 ? leader[static_cast<std::size_t>(order[k - 1])] : -1;
        const bool joins = before >= 0 &&
                           hash[static_cast<std::size_t>(row)] == hash[static_cast<std::size_t>(before)] &&
                           a.columns(row) == a.columns(before) && meets_itself(a, row);
        leader[static_cast<std::size_t>(row)] = joins ? before : row;
    }
    return leader;
}

Nodes own_nodes(const Rows &rows, const Matrices &a) {
    std::vector<std::uint64_t> hash;
    const std::vector<std::int64_t> order = by_pattern(a, hash), leader = leaders(a, order, hash);
    Nodes nodes;
    for (std::int64_t row : order) {
        nodes.dof.push_back(static_cast<std::int32_t>(rows.owned()[static_cast<std::size_t>(row)]));
        if (leader[static_cast<std::size_t>(row)] != row) {
            ++nodes.count.back().rows;
            continue;
        }
        const std::size_t before = nodes.neighbour.size();
        for (std::int32_t column : a.columns(row))
            if (column >= a.rows() || (leader[static_cast<std::size_t>(column)] == column && column != row))
                nodes.neighbour.push_back(static_cast<std::int32_t>(a.dof_of_column(rows, column)));
        nodes.count.push_back({1, static_cast<std::int32_t>(nodes.neighbour.size() - before)});
    }
    return nodes;
}

template <class T> std::vector<T> on_brain(Team &team, const std::vector<T> &mine) {
    std::vector<int> to;
    team.together([&] { to.assign(mine.size(), 0); });
    return deliver(team, mine, to);
}

/// What stands where in Nodes, and its vertex: they are numbered by their first DOF, so that the order does
/// not depend on how many ranks there are.
struct Places {
    std::vector<std::size_t> row, neighbour; // of each node
    std::vector<std::int64_t> sorted;        // nodes by their first DOF

    explicit Places(const Nodes &nodes) : row(1, 0), neighbour(1, 0), sorted(nodes.count.size()) {
        for (const Nodes::Count &c : nodes.count)
            row.push_back(row.back() + static_cast<std::size_t>(c.rows)),
                neighbour.push_back(neighbour.back() + static_cast<std::size_t>(c.neighbours));
        std::iota(sorted.begin(), sorted.end(), 0);
        std::sort(sorted.begin(), sorted.end(), [&](std::int64_t v, std::int64_t w) {
            return nodes.dof[row[static_cast<std::size_t>(v)]] < nodes.dof[row[static_cast<std::size_t>(w)]];
        });
    }
};

NodeGraph graph_of(const Nodes &nodes, std::int64_t n_dof, const AddedEntries &added) {
    NodeGraph graph;
    const Places places(nodes);
    std::vector<std::int64_t> node(static_cast<std::size_t>(n_dof)); // of each DOF
    graph.first_row.push_back(0);
    for (std::int64_t sorted : places.sorted) {
        const auto v = static_cast<std::size_t>(sorted);
        for (std::size_t r = places.row[v]; r < places.row[v + 1]; ++r) {
            node[static_cast<std::size_t>(nodes.dof[r])] = graph.size();
            graph.row.push_back(nodes.dof[r]);
        }
        graph.first_row.push_back(static_cast<std::int64_t>(graph.row.size()));
    }
    std::vector<std::pair<std::int64_t, std::int64_t>> more; // neighbours by added entries, both ways
    for (std::int64_t k = 0; k < added.count; ++k) {
        const std::int64_t v = node[static_cast<std::size_t>(added.row[k])],
                           w = node[static_cast<std::size_t>(added.column[k])];
        more.emplace_back(v, w), more.emplace_back(w, v);
    }
    std::sort(more.begin(), more.end());
    std::vector<std::int64_t> seen(nodes.count.size(), -1);
    auto next = more.begin();
    graph.first_neighbour.push_back(0);
    for (std::int64_t v = 0; v < graph.size(); ++v) {
        seen[static_cast<std::size_t>(v)] = v;
        const auto add = [&](std::int64_t w) {
            if (seen[static_cast<std::size_t>(w)] == v) return;
            seen[static_cast<std::size_t>(w)] = v;
            graph.neighbour.push_back(w);
        };
        const auto place = static_cast<std::size_t>(places.sorted[static_cast<std::size_t>(v)]);
        for (std::size_t k = places.neighbour[place]; k < places.neighbour[place + 1]; ++k)
            add(node[static_cast<std::size_t>(nodes.neighbour[k])]);
        for (; next != more.end() && next->first == v; ++next) add(next->second);
        graph.first_neighbour.push_back(static_cast<std::int64_t>(graph.neighbour.size()));
    }
    return graph;
}

NodeOrder as_mumps_takes_it(const NodeGraph &graph, const vector<std::int64_t> &nodes) {
    NodeOrder order;
    if (nodes.empty()) return order;
    order.position.resize(graph.row.size());
    MUMPS_INT place = 0;
    for (std::int64_t v : nodes)
        for (std::int64_t k = graph.first_row[v]; k < graph.first_row[v + 1]; ++k)
            order.position[static_cast<std::size_t>(graph.row[k])] = ++place;
    for (std::int64_t first : graph.first_row) order.first.push_back(static_cast<MUMPS_INT>(first + 1));
    for (std::int64_t dof : graph.row) order.dofs.push_back(static_cast<MUMPS_INT>(dof + 1));
    return order;
}

} // namespace

NodeOrder order_of_nodes(Team &team, const Rows &rows, const Matrices &matrices, const AddedEntries &added) {
    NodeOrder order;
#ifdef PLM_WITH_SCOTCH
    Nodes mine, all;
    team.together([&] { mine = own_nodes(rows, matrices); });
    all.count = on_brain(team, mine.count);
    all.dof = on_brain(team, mine.dof);
    all.neighbour = on_brain(team, mine.neighbour);
    team.together([&] {
        if (!team.is_brain()) return;
        const NodeGraph graph = graph_of(all, rows.n_dof(), added);
        order = as_mumps_takes_it(graph, order_by_scotch(graph));
    });
#endif
    return order;
}

} // namespace plm::mpi
