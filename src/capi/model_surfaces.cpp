// Contact between surfaces: rows of the gap matrix that the library makes from coordinates.
#include "capi/barrier.hpp"
#include "capi/new_pairs.hpp"
#include "capi/node_tables.hpp"
#include "structure/surface_normals.hpp"
#include <algorithm>
#include <map>

namespace plm::capi {
namespace {

void require_areas(const MeshSurface &surface) {
    const SurfaceNormals normals(places(surface));
    for (std::int64_t face = 0; face < surface.n_faces(); ++face)
        if (dot(normals.of_face(face), normals.of_face(face)) == 0)
            bad_argument("face_node", surface.face_ptr[face],
                         format("face %lld (counted from 0) has no area, so that nothing tells its normal; "
                                "leave it out, or check its nodes and their order (the corners around, then "
                                "those in the middle of the sides)",
                                Int(face)));
}

template <class Index>
plm_status add_surface(const char *function, plm_model *model, std::int32_t index_base,
                       const NodeArrays<Index> &nodes, const double *area, const FaceArrays<Index> &faces,
                       std::int64_t *surface) {
    return call<ModelHandle>(function, model, [&](ModelHandle &m) {
        require_open(m);
        require_index_base(index_base);
        require_range(nodes.n, 1, INT64_MAX / 64, "n");
        require_range(faces.n, 0, INT64_MAX / 64, "n_faces");
        require_pointer(surface, "surface");
        ContactSurface s;
        NodeReader<Index> reader(index_base, m.input.n_dof);
        s.mesh.node = reader.take(nodes, true);
        s.is_wall = reader.has_no_dof();
        reader.refuse_repeated_dofs();
        if (faces.n > 0) take_faces(s.mesh, faces, index_base);
        require_areas(s.mesh);
        if (area) {
            require_finite_array(area, nodes.n, "area");
            s.area.assign(area, area + nodes.n);
            for (std::int64_t i = 0; i < nodes.n; ++i)
                if (area[i] < 0)
                    bad_argument("area", i,
                                 format("area[%lld] is %g; it must be > 0, or 0 for what the faces give",
                                        Int(i), area[i]));
        }
        m.surfaces.push_back(std::move(s));
        *surface = static_cast<std::int64_t>(m.surfaces.size()) - 1;
        return PLM_OK;
    });
}

struct Contacting {
    std::int64_t slave, master;
    std::int32_t options;
    double stiffness, search, closed;
};

const ContactSurface &surface_of(const ModelHandle &m, std::int64_t surface, const char *name) {
    const auto n = static_cast<std::int64_t>(m.surfaces.size());
    if (surface < 0 || surface >= n)
        bad_argument(
            name, -1,
            format("%s is %lld, but the model has %lld surfaces, counted from 0 (from 1 in Fortran); "
                   "add it first",
                   name, Int(surface), Int(n)));
    return m.surfaces[static_cast<std::size_t>(surface)];
}

void require_faces(const ContactSurface &surface, const char *name, const char *what_for) {
    if (surface.mesh.n_faces() == 0)
        bad_argument(name, -1, format("%s has nodes only, and no faces, which %s needs", name, what_for));
}

void check(const ModelHandle &m, const Contacting &x) {
    constexpr std::int32_t all =
        PLM_SURFACE_POINTS | PLM_SURFACE_SYMMETRIC | PLM_SURFACE_SMOOTH | PLM_SURFACE_TWO_SIDED;
    const ContactSurface &slave = surface_of(m, x.slave, "slave"),
                         &master = surface_of(m, x.master, "master");
    if (x.slave == x.master)
        bad_argument("master", -1, "master is the slave itself; contact is between two surfaces");
    if (x.options & ~all)
        bad_argument("options", -1,
                     format("options is %d; it is a sum of PLM_SURFACE_POINTS, _SYMMETRIC, _SMOOTH and "
                            "_TWO_SIDED, or 0",
                            x.options));
    if (slave.is_wall)
        bad_argument("slave", -1, "slave is a wall, which nothing moves; a wall is the master");
    require_faces(master, "master", "a master");
    if (x.options & PLM_SURFACE_POINTS) require_faces(slave, "slave", "PLM_SURFACE_POINTS");
    if (x.options & PLM_SURFACE_SYMMETRIC) require_faces(slave, "slave", "PLM_SURFACE_SYMMETRIC");
    if (!is_stiffness(x.stiffness))
        bad_argument("stiffness", -1,
                     format("stiffness is %g; it must be > 0 (%g to %g), or PLM_AUTO_STIFFNESS", x.stiffness,
                            smallest_scale, largest_scale));
    require_finite(x.search, "search");
    if (!(x.search > 0))
        bad_argument("search", -1, format("search is %g; it must be a length > 0", x.search));
    require_finite(x.closed, "closed");
    if (!(x.closed >= 0))
        bad_argument("closed", -1, format("closed is %g; it must be a length >= 0", x.closed));
}

/// One side of a contact: the points of the slave, with their k_n.
struct Pass {
    std::vector<SurfacePair> points;
    std::int64_t slave, master;
    double share; // of the stiffness
    bool knows_areas = false;
};

// Shares of a pressure that nodes of such faces can carry are not positive at corners: no pairs at nodes pass
// a uniform one.
bool has_middle_nodes(const MeshSurface &surface) {
    for (std::int64_t face = 0; face < surface.n_faces(); ++face)
        if (surface.face_ptr[face + 1] - surface.face_ptr[face] > 4) return true;
    return false;
}

// Of what is fixed on both sides nothing ever changes, as at the ends of surfaces that are clamped together.
void leave_out_held(std::vector<SurfacePair> &points, const ModelInput &input) {
    std::vector<char> fixed(static_cast<std::size_t>(input.n_dof), 0);
    for (std::int64_t dof : input.fixed) fixed[static_cast<std::size_t>(dof)] = 1;
    for (SurfacePair &p : points)
        if (p.has_partner() && std::all_of(p.row.begin(), p.row.end(), [&](const DofTerm &t) {
                return fixed[static_cast<std::size_t>(t.dof)];
            }))
            p.face = SurfacePair::held;
}

Pass find_pairs(const ModelHandle &m, const Contacting &x, bool is_reversed) {
    const std::int64_t from = is_reversed ? x.master : x.slave, to = is_reversed ? x.slave : x.master;
    const ContactSurface &slave = surface_of(m, from, "slave"), &master = surface_of(m, to, "master");
    SurfaceContactChoice choice;
    choice.search = x.search;
    choice.at_points = x.options & PLM_SURFACE_POINTS || (has_middle_nodes(slave.mesh) && slave.area.empty());
    choice.is_smooth = x.options & PLM_SURFACE_SMOOTH;
    choice.is_two_sided = x.options & PLM_SURFACE_TWO_SIDED;
    Pass pass{surface_contact(slave.mesh, master.mesh, choice), from, to,
              x.options & PLM_SURFACE_SYMMETRIC ? 0.5 : 1.0};
    leave_out_held(pass.points, m.input);
    pass.knows_areas = slave.mesh.n_faces() > 0 || !slave.area.empty();
    if (!choice.at_points && !slave.area.empty())
        for (SurfacePair &p : pass.points)
            if (slave.area[p.point] > 0) p.area = slave.area[p.point];
    return pass;
}

// Nodes that face each other exactly find each other from both sides: the two are one pair.
class KnownRows {
  public:
    /// The pair with this row; `next`, which becomes it, where there is none.
    std::int64_t find(const DofTerms &row, std::int64_t next) {
        constexpr double rounding = 1e-12;
        std::vector<std::int64_t> dofs;
        for (const DofTerm &t : row) dofs.push_back(t.dof);
        auto &alike = of_dofs_[std::move(dofs)];
        for (const auto &[known, pair] : alike)
            if (std::equal(known.begin(), known.end(), row.begin(), [](const DofTerm &a, const DofTerm &b) {
                    return std::abs(a.coefficient - b.coefficient) <= rounding;
                }))
                return pair;
        alike.emplace_back(row, next);
        return next;
    }

  private:
    std::map<std::vector<std::int64_t>, std::vector<std::pair<DofTerms, std::int64_t>>> of_dofs_;
};

double stiffness_of(const SurfacePair &p, const Pass &pass, const Contacting &x) {
    if (x.stiffness == PLM_AUTO_STIFFNESS) return x.stiffness;
    const double k_n = x.stiffness * pass.share * (pass.knows_areas ? p.area : 1);
    if (!is_stiffness(k_n))
        bad_argument("stiffness", -1,
                     format("point %lld of the slave (counted from 0) would have k_n = %g (an area of %g); "
                            "it must lie in %g to %g",
                            Int(p.point), k_n, p.area, smallest_scale, largest_scale));
    return k_n;
}

// Returns the pair of each point, counted from the first of these; -1: none.
vector<std::int64_t> take(NewPairs &pairs, KnownRows &known, Pass &pass, const Contacting &x) {
    vector<std::int64_t> of_point;
    for (SurfacePair &p : pass.points) {
        of_point.push_back(-1);
        if (!p.has_partner()) continue;
        const double k_n = stiffness_of(p, pass, x);
        std::sort(p.row.begin(), p.row.end(),
                  [](const DofTerm &a, const DofTerm &b) { return a.dof < b.dof; });
        const auto next = static_cast<std::int64_t>(pairs.stiffness.size());
        const std::int64_t pair = of_point.back() = known.find(p.row, next);
        if (pair < next) {
            if (k_n != PLM_AUTO_STIFFNESS) pairs.stiffness[pair] += k_n;
            continue;
        }
        for (const DofTerm &t : p.row) {
            pairs.row.push_back(plm::Contact::normal_row(pair));
            pairs.dof.push_back(t.dof);
            pairs.coefficient.push_back(t.coefficient);
        }
        pairs.stiffness.push_back(k_n);
        pairs.gap.push_back(std::abs(p.gap) <= x.closed ? 0 : p.gap);
    }
    return of_point;
}

/// Of one pass.
struct Findings {
    std::int64_t n_pairs = 0, n_alone = 0, n_opposed = 0, n_held = 0, n_closed = 0, n_pressed = 0,
                 first_opposed = -1;
    std::int64_t farthest = 0, deepest = 0, nearest = 0; // points
    double distance = 0, interference = 0, least = -1;
};

Findings look_at(const Pass &pass, double closed) {
    Findings f;
    for (const SurfacePair &p : pass.points) {
        if (f.least < 0 || p.distance < f.least) f.least = p.distance, f.nearest = p.point;
        if (p.face == SurfacePair::opposed && f.n_opposed++ == 0) f.first_opposed = p.point;
        f.n_alone += p.face == SurfacePair::none;
        f.n_held += p.face == SurfacePair::held;
        if (!p.has_partner()) continue;
        ++f.n_pairs;
        f.n_closed += std::abs(p.gap) <= closed;
        f.n_pressed += p.gap < -closed;
        if (p.distance > f.distance) f.distance = p.distance, f.farthest = p.point;
        if (-p.gap > f.interference) f.interference = -p.gap, f.deepest = p.point;
    }
    return f;
}

std::string in_words(const Pass &pass, const Findings &f, std::int64_t contact) {
    return format(
        "contact %lld, %lld points of surface %lld on surface %lld: %lld pairs, the farthest (point "
        "%lld) at %g; %lld of them closed, %lld with interference, the deepest (point %lld) by %g; "
        "%lld points look the same way as the nearest face, %lld have no face near them, and at %lld nothing "
        "can move\n",
        Int(contact), Int(pass.points.size()), Int(pass.slave), Int(pass.master), Int(f.n_pairs),
        Int(f.farthest), f.distance, Int(f.n_closed), Int(f.n_pressed), Int(f.deepest), f.interference,
        Int(f.n_opposed), Int(f.n_alone), Int(f.n_held));
}

void add(SurfaceReport &report, const Pass &pass, const Findings &f,
         const vector<std::int64_t> &pair_of_point, std::int64_t n_before) {
    for (std::int64_t pair : pair_of_point) report.pair.push_back(pair < 0 ? -1 : n_before + pair);
    for (const SurfacePair &p : pass.points) {
        report.point.push_back(p.point);
        report.face.push_back(p.has_partner() ? p.face : -1);
        report.gap.push_back(p.gap);
        report.normal.insert(report.normal.end(), p.normal.begin(), p.normal.end());
        report.area.push_back(p.area);
    }
    report.n_alone += f.n_alone, report.n_opposed += f.n_opposed;
    report.distance = std::max(report.distance, f.distance);
    report.interference = std::max(report.interference, f.interference);
    report.text += in_words(pass, f, report.n_contacts);
}

Outcome add_contact(ModelHandle &m, const Contacting &x) {
    NewPairs pairs;
    KnownRows known;
    SurfaceReport report = m.surface_report;
    std::string said;
    for (const bool is_reversed : {false, true}) {
        if (is_reversed && !(x.options & PLM_SURFACE_SYMMETRIC)) break;
        Pass pass = find_pairs(m, x, is_reversed);
        const Findings f = look_at(pass, x.closed);
        if (f.n_pairs + f.n_opposed + f.n_held == 0)
            bad_argument(
                "search", -1,
                format("no point of surface %lld has a partner on surface %lld: the nearest, point %lld "
                       "(counted from 0), is %g from it, and search is %g; check the units of the "
                       "coordinates, the faces and search",
                       Int(pass.slave), Int(pass.master), Int(f.nearest), f.least, x.search));
        add(report, pass, f, take(pairs, known, pass, x), m.input.contact.n_pairs());
        if (f.n_opposed > 0)
            said +=
                format("%s%lld points of surface %lld look the same way as the face of surface %lld nearest "
                       "to them, the first point %lld (counted from 0), and have no pair: turn the faces of "
                       "one surface over (normals by the right-hand rule, out of the body), leave out what "
                       "is not to touch, or ask for PLM_SURFACE_TWO_SIDED where the surface is a sheet",
                       said.empty() ? "" : "; ", Int(f.n_opposed), Int(pass.slave), Int(pass.master),
                       Int(f.first_opposed));
    }
    ++report.n_contacts;
    add_to(m.input, pairs);
    std::swap(m.surface_report, report);
    return said.empty() ? Outcome(PLM_OK) : Outcome(PLM_WARNING, PLM_REASON_MODEL, said);
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_add_surface_i32(plm_model *model, std::int32_t index_base, std::int64_t n,
                                     const std::int32_t *dof, const double *xyz, const double *area,
                                     std::int64_t n_faces, const std::int32_t *face_ptr,
                                     const std::int32_t *face_node, std::int64_t *surface) {
    return add_surface<std::int32_t>("plm_model_add_surface_i32", model, index_base,
                                     {"dof", "xyz", "", n, 3, dof, xyz}, area, {n_faces, face_ptr, face_node},
                                     surface);
}

plm_status plm_model_add_surface_i64(plm_model *model, std::int32_t index_base, std::int64_t n,
                                     const std::int64_t *dof, const double *xyz, const double *area,
                                     std::int64_t n_faces, const std::int64_t *face_ptr,
                                     const std::int64_t *face_node, std::int64_t *surface) {
    return add_surface<std::int64_t>("plm_model_add_surface_i64", model, index_base,
                                     {"dof", "xyz", "", n, 3, dof, xyz}, area, {n_faces, face_ptr, face_node},
                                     surface);
}

plm_status plm_model_add_surface_contact(plm_model *model, std::int64_t slave, std::int64_t master,
                                         std::int32_t options, double stiffness, double search,
                                         double closed) {
    return call<ModelHandle>("plm_model_add_surface_contact", model, [&](ModelHandle &m) -> Outcome {
        require_open(m);
        const Contacting x{slave, master, options, stiffness, search, closed};
        check(m, x);
        return add_contact(m, x);
    });
}
