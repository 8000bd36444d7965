// The contact pairs of the model: node pairs, ground contacts and raw rows all become rows of the gap matrix.
#include "capi/barrier.hpp"
#include "capi/new_pairs.hpp"
#include "capi/sparse_rows.hpp"
#include "linalg/scale.hpp"
#include <algorithm>

namespace plm::capi {
namespace {

using Int = long long; // for printf

// Reserves generously, so that adding pairs one by one stays linear.
template <class T> void reserve_for(vector<T> &to, const vector<T> &from) {
    if (to.capacity() - to.size() < from.size())
        to.reserve(std::max(to.size() + from.size(), 2 * to.capacity()));
}
template <class T> void append(vector<T> &to, const vector<T> &from) {
    to.insert(to.end(), from.begin(), from.end());
}

} // namespace

bool is_stiffness(double k_n) {
    return k_n == PLM_AUTO_STIFFNESS || (k_n >= smallest_scale && k_n <= largest_scale);
}

void add_to(ModelInput &input, NewPairs &pairs) {
    const std::int64_t first = input.contact.n_rows();
    for (std::int64_t &r : pairs.row) r += first;
    reserve_for(input.gap_row, pairs.row);
    reserve_for(input.gap_dof, pairs.dof);
    reserve_for(input.gap_coefficient, pairs.coefficient);
    reserve_for(input.contact.stiffness, pairs.stiffness);
    reserve_for(input.contact.initial_gap, pairs.gap);
    append(input.gap_row, pairs.row);
    append(input.gap_dof, pairs.dof);
    append(input.gap_coefficient, pairs.coefficient);
    append(input.contact.stiffness, pairs.stiffness);
    append(input.contact.initial_gap, pairs.gap);
}

namespace {

void take_stiffness_and_gap(NewPairs &pairs, std::int64_t n, const double *stiffness, const double *gap) {
    if (n > 0) require_pointer(stiffness, "stiffness");
    for (std::int64_t i = 0; i < n; ++i)
        if (!is_stiffness(stiffness[i]))
            bad_argument("stiffness", i,
                         format("stiffness[%lld] is %g; it must be > 0 (%g to %g), or PLM_AUTO_STIFFNESS",
                                Int(i), stiffness[i], smallest_scale, largest_scale));
    if (gap) require_finite_array(gap, n, "gap");
    pairs.stiffness.assign(stiffness, stiffness + n);
    pairs.gap.assign(static_cast<std::size_t>(n), 0.0);
    if (gap) std::copy(gap, gap + n, pairs.gap.begin());
}

void check_normals(const double *normal, std::int64_t n) {
    require_finite_array(normal, 3 * n, "normal");
    for (std::int64_t i = 0; i < n; ++i) {
        const double length = std::hypot(std::hypot(normal[3 * i], normal[3 * i + 1]), normal[3 * i + 2]);
        if (std::abs(length - 1) > 1e-6)
            bad_argument("normal", i,
                         format("normal[%lld] is not of unit length (|n| = %g); normalise the three "
                                "components of every pair",
                                Int(i), length));
    }
}

// One side of the pairs: sign * normal at the x, y, z DOFs of a node, absent DOFs left out.
template <class Index>
void add_side(NewPairs &pairs, const char *name, const Index *dof, const double *normal, double sign,
              std::int64_t n, std::int64_t base, std::int64_t n_dof) {
    if (n > 0) require_pointer(dof, name);
    for (std::int64_t i = 0; i < n; ++i) {
        int present = 0;
        for (std::int64_t k = 3 * i; k < 3 * i + 3; ++k) {
            if (dof[k] < base) continue;
            require_dof(dof[k], base, n_dof, name, k);
            ++present;
            if (normal[k] == 0) continue;
            pairs.row.push_back(plm::Contact::normal_row(i));
            pairs.dof.push_back(dof[k] - base);
            pairs.coefficient.push_back(sign * normal[k]);
        }
        if (present == 0)
            bad_argument(name, 3 * i,
                         format("the node of pair %lld has no DOF at all; use a ground contact for a "
                                "node that cannot move",
                                Int(i)));
    }
}

// A node against itself never opens or closes.
template <class Index>
void refuse_same_nodes(const Index *dof_a, const Index *dof_b, const double *normal, std::int64_t n,
                       std::int64_t base) {
    for (std::int64_t i = 0; i < n; ++i) {
        bool same = true;
        for (std::int64_t k = 3 * i; k < 3 * i + 3; ++k)
            same = same && (normal[k] == 0 || dof_a[k] == dof_b[k] || (dof_a[k] < base && dof_b[k] < base));
        if (same)
            bad_argument("dof_b", 3 * i,
                         format("both sides of pair %lld have the same DOFs, or none, along the normal: its "
                                "gap can never "
                                "change; give the DOFs of the two nodes that face each other",
                                Int(i)));
    }
}

template <class Index> struct NodePairs {
    std::int32_t index_base;
    std::int64_t n;
    const Index *dof_a, *dof_b; // dof_b null: ground
    const char *name_a;
    bool ground;
    const double *normal, *stiffness, *gap;
};

template <class Index>
plm_status add_nodes(const char *function, plm_model *model, const NodePairs<Index> &x) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(x.index_base);
        require_range(x.n, 0, INT64_MAX / 64, "n");
        NewPairs pairs;
        check_normals(x.normal, x.n);
        add_side(pairs, x.name_a, x.dof_a, x.normal, 1.0, x.n, x.index_base, m.input.n_dof);
        if (!x.ground) {
            add_side(pairs, "dof_b", x.dof_b, x.normal, -1.0, x.n, x.index_base, m.input.n_dof);
            refuse_same_nodes(x.dof_a, x.dof_b, x.normal, x.n, x.index_base);
        }
        take_stiffness_and_gap(pairs, x.n, x.stiffness, x.gap);
        add_to(m.input, pairs);
        return PLM_OK;
    });
}

void take_dense_rows(NewPairs &pairs, std::int64_t n, std::int64_t n_dof, const double *row,
                     std::int64_t ld) {
    for (std::int64_t i = 0; i < n; ++i) {
        const std::size_t before = pairs.row.size();
        for (std::int64_t j = 0; j < n_dof; ++j) {
            const double coefficient = row[i + j * ld];
            if (!std::isfinite(coefficient) || too_large(coefficient))
                bad_argument("row", i + j * ld,
                             format("row[%lld], gap row %lld at DOF %lld (both counted from 0), is %g: no "
                                    "number, or beyond %g where squares and products overflow",
                                    Int(i + j * ld), Int(i), Int(j), coefficient, largest_scale));
            if (coefficient == 0) continue;
            pairs.row.push_back(plm::Contact::normal_row(i));
            pairs.dof.push_back(j);
            pairs.coefficient.push_back(coefficient);
        }
        if (pairs.row.size() == before)
            bad_argument("row", i, format("gap row %lld is zero; its penetration can never change", Int(i)));
    }
}

template <class Index>
plm_status add_rows(const char *function, plm_model *model, std::int32_t index_base, std::int64_t n,
                    const Index *row_ptr, const Index *dof, const double *coefficient,
                    const double *stiffness, const double *gap) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(index_base);
        require_range(n, 0, INT64_MAX / 64, "n");
        const SparseRows<Index> rows{
            "gap row", "its penetration can never change", n, index_base, row_ptr, dof, coefficient};
        check_row_pointers(rows);
        NewPairs pairs;
        for_entries(rows, m.input.n_dof, [&](std::int64_t i, std::int64_t j, double c) {
            pairs.row.push_back(plm::Contact::normal_row(i));
            pairs.dof.push_back(j);
            pairs.coefficient.push_back(c);
        });
        take_stiffness_and_gap(pairs, n, stiffness, gap);
        add_to(m.input, pairs);
        return PLM_OK;
    });
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_add_node_pairs_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                        const std::int32_t *dof_a, const std::int32_t *dof_b,
                                        const double *normal, const double *stiffness, const double *gap) {
    return add_nodes<std::int32_t>("plm_model_add_node_pairs_i32", model,
                                   {index_base, n, dof_a, dof_b, "dof_a", false, normal, stiffness, gap});
}

plm_status plm_model_add_node_pairs_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                        const std::int64_t *dof_a, const std::int64_t *dof_b,
                                        const double *normal, const double *stiffness, const double *gap) {
    return add_nodes<std::int64_t>("plm_model_add_node_pairs_i64", model,
                                   {index_base, n, dof_a, dof_b, "dof_a", false, normal, stiffness, gap});
}

plm_status plm_model_add_ground_contacts_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                             const std::int32_t *dof, const double *normal,
                                             const double *stiffness, const double *gap) {
    return add_nodes<std::int32_t>("plm_model_add_ground_contacts_i32", model,
                                   {index_base, n, dof, nullptr, "dof", true, normal, stiffness, gap});
}

plm_status plm_model_add_ground_contacts_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                             const std::int64_t *dof, const double *normal,
                                             const double *stiffness, const double *gap) {
    return add_nodes<std::int64_t>("plm_model_add_ground_contacts_i64", model,
                                   {index_base, n, dof, nullptr, "dof", true, normal, stiffness, gap});
}

plm_status plm_model_add_gap_rows_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                      const std::int32_t *row_ptr, const std::int32_t *dof,
                                      const double *coefficient, const double *stiffness, const double *gap) {
    return add_rows("plm_model_add_gap_rows_i32", model, index_base, n, row_ptr, dof, coefficient, stiffness,
                    gap);
}

plm_status plm_model_add_gap_rows_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                      const std::int64_t *row_ptr, const std::int64_t *dof,
                                      const double *coefficient, const double *stiffness, const double *gap) {
    return add_rows("plm_model_add_gap_rows_i64", model, index_base, n, row_ptr, dof, coefficient, stiffness,
                    gap);
}

plm_status plm_model_add_dense_gap_rows(plm_model *model, std::int64_t n, const double *row, std::int64_t ld,
                                        const double *stiffness, const double *gap) {
    return call<ModelHandle>("plm_model_add_dense_gap_rows", model, [&](ModelHandle &m) {
        require_open(m);
        require_range(n, 0, INT64_MAX / 64, "n");
        require_range(ld, std::max<std::int64_t>(n, 1), INT32_MAX, "ld");
        if (n > 0) require_pointer(row, "row");
        NewPairs pairs;
        take_dense_rows(pairs, n, m.input.n_dof, row, ld);
        take_stiffness_and_gap(pairs, n, stiffness, gap);
        add_to(m.input, pairs);
        return PLM_OK;
    });
}
