// Couplings of nodes by their coordinates: rows of constraints that the library makes.
#include "capi/barrier.hpp"
#include "capi/node_tables.hpp"
#include "structure/tie.hpp"
#include <algorithm>

namespace plm::capi {
namespace {

template <class Index> struct Coupling {
    std::int32_t index_base, per_reference;
    const Index *reference_dof;
    const double *reference_xyz;
    NodeArrays<Index> nodes;
};

/// rows(reference, nodes): of the coupling, once its arguments are checked.
template <class Index, class Rows> void add_coupling(ModelHandle &m, const Coupling<Index> &x, Rows rows) {
    require_open(m);
    require_index_base(x.index_base);
    require_range(x.nodes.n, 1, INT64_MAX / 64, "n");
    NodeReader<Index> reader(x.index_base, m.input.n_dof);
    const CoupledNode reference = reader.take({"reference_dof", "reference_xyz", "per_reference", 1,
                                               x.per_reference, x.reference_dof, x.reference_xyz})[0];
    const vector<CoupledNode> nodes = reader.take(x.nodes);
    reader.refuse_repeated_dofs();
    append(m.input.constraints, rows(reference, nodes));
}

template <class Index>
plm_status add_rigid_link(const char *function, plm_model *model, const Coupling<Index> &x) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        add_coupling(m, x, rigid_link);
        return PLM_OK;
    });
}

vector<double> checked_weights(const double *weight, std::int64_t n) {
    if (!weight) return vector<double>(n, 1.0);
    require_finite_array(weight, n, "weight");
    for (std::int64_t i = 0; i < n; ++i)
        if (!(weight[i] > 0))
            bad_argument("weight", i,
                         format("weight[%lld] is %g; it must be > 0: leave out a node that carries nothing",
                                Int(i), weight[i]));
    return vector<double>(weight, weight + n);
}

template <class Index>
plm_status add_distributing_coupling(const char *function, plm_model *model, const Coupling<Index> &x,
                                     const double *weight) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        add_coupling(m, x, [&](const CoupledNode &reference, const vector<CoupledNode> &nodes) {
            return distributing_coupling(reference, nodes, checked_weights(weight, x.nodes.n));
        });
        return PLM_OK;
    });
}

template <class Index> struct TieArguments {
    std::int32_t index_base;
    NodeArrays<Index> dependent, surface;
    FaceArrays<Index> faces;
    double tolerance;
};

Outcome outcome_of(const Tie &t, double tolerance) {
    if (t.n_untied == 0) return PLM_OK;
    return Outcome(PLM_WARNING, PLM_REASON_MODEL,
                   format("%lld of %lld nodes stay free, farther from the surface than the tolerance %g: the "
                          "farthest is node %lld (counted from 0), at %g; leave them out, or check their "
                          "coordinates, the faces and the tolerance",
                          Int(t.n_untied), Int(t.distance.size()), tolerance, Int(t.farthest_untied),
                          t.distance[t.farthest_untied]));
}

template <class Index>
plm_status add_tie(const char *function, plm_model *model, const TieArguments<Index> &x, double *distance) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) -> Outcome {
        require_open(m);
        require_index_base(x.index_base);
        require_range(x.dependent.n, 1, INT64_MAX / 64, "n");
        require_range(x.surface.n, 1, INT64_MAX / 64, "n_surface");
        require_range(x.faces.n, 1, INT64_MAX / 64, "n_faces");
        require_finite(x.tolerance, "tolerance");
        if (!(x.tolerance > 0))
            bad_argument("tolerance", -1, format("tolerance is %g; it must be a length > 0", x.tolerance));
        NodeReader<Index> reader(x.index_base, m.input.n_dof), of_surface(x.index_base, m.input.n_dof);
        const vector<CoupledNode> dependent = reader.take(x.dependent);
        reader.refuse_repeated_dofs();
        MeshSurface surface;
        surface.node = of_surface.take(x.surface, true);
        of_surface.refuse_repeated_dofs();
        take_faces(surface, x.faces, x.index_base);
        const Tie t = tie_nodes(dependent, surface, x.tolerance);
        if (t.farthest_tied < 0)
            bad_argument(
                "tolerance", -1,
                format("no node is tied: the nearest, node %lld (counted from 0), is %g from the surface, "
                       "and the tolerance is %g; check the units of the coordinates and the faces",
                       Int(t.nearest), t.distance[t.nearest], x.tolerance));
        append(m.input.constraints, t.rows);
        m.n_untied += t.n_untied;
        m.tie_distance = std::max(m.tie_distance, t.distance[t.farthest_tied]);
        if (distance) std::copy(t.distance.begin(), t.distance.end(), distance);
        return outcome_of(t, x.tolerance);
    });
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_add_rigid_link_i32(plm_model *model, std::int32_t index_base, std::int32_t per_reference,
                                        const std::int32_t *reference_dof, const double *reference_xyz,
                                        std::int64_t n, std::int32_t per_dependent,
                                        const std::int32_t *dependent_dof, const double *dependent_xyz) {
    return add_rigid_link<std::int32_t>("plm_model_add_rigid_link_i32", model,
                                        {index_base,
                                         per_reference,
                                         reference_dof,
                                         reference_xyz,
                                         {"dependent_dof", "dependent_xyz", "per_dependent", n, per_dependent,
                                          dependent_dof, dependent_xyz}});
}

plm_status plm_model_add_rigid_link_i64(plm_model *model, std::int32_t index_base, std::int32_t per_reference,
                                        const std::int64_t *reference_dof, const double *reference_xyz,
                                        std::int64_t n, std::int32_t per_dependent,
                                        const std::int64_t *dependent_dof, const double *dependent_xyz) {
    return add_rigid_link<std::int64_t>("plm_model_add_rigid_link_i64", model,
                                        {index_base,
                                         per_reference,
                                         reference_dof,
                                         reference_xyz,
                                         {"dependent_dof", "dependent_xyz", "per_dependent", n, per_dependent,
                                          dependent_dof, dependent_xyz}});
}

plm_status plm_model_add_distributing_coupling_i32(plm_model *model, std::int32_t index_base,
                                                   std::int32_t per_reference,
                                                   const std::int32_t *reference_dof,
                                                   const double *reference_xyz, std::int64_t n,
                                                   const std::int32_t *dof, const double *xyz,
                                                   const double *weight) {
    return add_distributing_coupling<std::int32_t>(
        "plm_model_add_distributing_coupling_i32", model,
        {index_base, per_reference, reference_dof, reference_xyz, {"dof", "xyz", "", n, 3, dof, xyz}},
        weight);
}

plm_status plm_model_add_distributing_coupling_i64(plm_model *model, std::int32_t index_base,
                                                   std::int32_t per_reference,
                                                   const std::int64_t *reference_dof,
                                                   const double *reference_xyz, std::int64_t n,
                                                   const std::int64_t *dof, const double *xyz,
                                                   const double *weight) {
    return add_distributing_coupling<std::int64_t>(
        "plm_model_add_distributing_coupling_i64", model,
        {index_base, per_reference, reference_dof, reference_xyz, {"dof", "xyz", "", n, 3, dof, xyz}},
        weight);
}

plm_status plm_model_add_tie_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                 const std::int32_t *dependent_dof, const double *dependent_xyz,
                                 std::int64_t n_surface, const std::int32_t *surface_dof,
                                 const double *surface_xyz, std::int64_t n_faces,
                                 const std::int32_t *face_ptr, const std::int32_t *face_node,
                                 double tolerance, double *distance) {
    return add_tie<std::int32_t>("plm_model_add_tie_i32", model,
                                 {index_base,
                                  {"dependent_dof", "dependent_xyz", "", n, 3, dependent_dof, dependent_xyz},
                                  {"surface_dof", "surface_xyz", "", n_surface, 3, surface_dof, surface_xyz},
                                  {n_faces, face_ptr, face_node},
                                  tolerance},
                                 distance);
}

plm_status plm_model_add_tie_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                 const std::int64_t *dependent_dof, const double *dependent_xyz,
                                 std::int64_t n_surface, const std::int64_t *surface_dof,
                                 const double *surface_xyz, std::int64_t n_faces,
                                 const std::int64_t *face_ptr, const std::int64_t *face_node,
                                 double tolerance, double *distance) {
    return add_tie<std::int64_t>("plm_model_add_tie_i64", model,
                                 {index_base,
                                  {"dependent_dof", "dependent_xyz", "", n, 3, dependent_dof, dependent_xyz},
                                  {"surface_dof", "surface_xyz", "", n_surface, 3, surface_dof, surface_xyz},
                                  {n_faces, face_ptr, face_node},
                                  tolerance},
                                 distance);
}
