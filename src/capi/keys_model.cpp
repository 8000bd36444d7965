#include "capi/handles.hpp"
#include "capi/keys.hpp"

namespace plm::capi {
namespace {

using H = ModelHandle;

const RestState &rest(const H &h) {
    if (!h.rest)
        throw Error(PLM_ERR_STATE, "the rest state is not known yet; solve for it first").argument("key");
    return *h.rest;
}

const MemoryEstimate &estimated(const H &h) {
    if (!h.memory)
        throw Error(PLM_ERR_STATE, "the memory is not estimated; estimate it before the build")
            .argument("key");
    return *h.memory;
}

vector<double> rest_displacement(const H &h) {
    const RestState &r = rest(h); // throws first where nothing is built
    return h.core->expanded(r.displacement);
}

const Warnings &built_warnings(const H &h) {
    return built(h), h.warnings;
}

} // namespace

const std::vector<Key> &model_keys() {
    using O = SpaceOptions;
    static const std::vector<Key> keys = {
        real_option<&O::tolerance>(
            "space_tolerance", 1e-14, 1,
            "relative error of the contact receptances at the highest frequency asked for"),
        real_option<&O::cutoff_factor>(
            "cutoff_factor", 1, 100,
            "exact open modes are kept up to this multiple of the highest frequency"),
        int_option<&O::max_blocks>("max_blocks", 1, 20, "most blocks of contact attachment vectors"),
        int_option<&O::verify_counts>("verify_counts", 0, 1,
                                      "1: the number of modes is verified by a Sturm count"),
        choice_option<&O::solver>(
            "solver", "auto,cholmod,eigen,host",
            "who factors sparse matrices; auto: the host's solver where the context has "
            "one, else LAPACK where every entry is stored (superelements), else cholmod where it was built, "
            "else "
            "eigen"),
        choice_option<&O::precision>("factor_precision", "auto,double,single",
                                     "numbers kept of a factorization by cholmod; single: half the memory, "
                                     "every solve refined to the residual "
                                     "of double; auto: double, unless only single fits memory_limit"),
        real_option<&O::memory_limit>(
            "memory_limit", 0, 1e9,
            "MiB that the model and what is made of it may take at once, as estimated before the build, the "
            "host's solver not counted; 0: no limit"),

        int_option<&O::absolute_outputs>("absolute_outputs", 0, 1,
                                         "1: outputs that are sums of DOFs include the motion of moving "
                                         "supports; DOFs are relative to it"),
        real_option<&O::reduction_error>(
            "reduction_error", 0, 1,
            "a superelement's own error, as the host that reduced the structure estimates it (relative, of "
            "amplitudes at resonance); added to estimated errors"),

        result<H>("n_dof", "DOFs of the model",
                  [](const H &h) { return h.core ? h.core->n_dof() : h.input.n_dof; }),
        result<H>("n_full", "DOFs of the structure a superelement was reduced from; 0 without a recovery",
                  [](const H &h) { return h.recovery.n_full; }),
        result<H>("n_free", "DOFs that are neither fixed nor given by others through constraints",
                  [](const H &h) { return built(h)->n_free(); }),
        result<H>("n_redundant_constraints",
                  "constraints that were left out: the others and the fixed DOFs say the same",
                  [](const H &h) { return built(h)->n_redundant_constraints(); }),
        result<H>("n_untied_nodes", "nodes beyond the tolerance of their tie, which stay free",
                  [](const H &h) { return h.n_untied; }),
        result<H>("tie_distance", "largest distance of a tied node from its surface (length); 0 without ties",
                  [](const H &h) { return h.tie_distance; }),
        result<H>("surface_report",
                  "what surface contacts found, a line for each: partners, distances, interference, normals "
                  "that disagree, points without a partner",
                  [](const H &h) { return h.surface_report.text; }),
        result<H>("n_surface_alone", "points of surface contacts too far from, or beside, all faces: no pair",
                  [](const H &h) { return h.surface_report.n_alone; }),
        result<H>("n_surface_opposed",
                  "points of surface contacts that look the same way as the nearest face does: no pair",
                  [](const H &h) { return h.surface_report.n_opposed; }),
        result<H>("surface_distance", "largest distance of a point of a pair from its face (length)",
                  [](const H &h) { return h.surface_report.distance; }),
        result<H>("surface_interference", "largest interference of surface contacts (length)",
                  [](const H &h) { return h.surface_report.interference; }),
        result<H>("surface_point",
                  "of surface contacts, each point in the order in which they were added: its node in the "
                  "table of its surface (from 0), or its number among the points of the faces",
                  [](const H &h) { return h.surface_report.point; }),
        result<H>("surface_face", "of each of these points: the face of its partner (from 0), -1: none",
                  [](const H &h) { return h.surface_report.face; }),
        result<H>("surface_pair", "of each of these points: its contact pair (from 0), -1: none",
                  [](const H &h) { return h.surface_report.pair; }),
        result<H>("surface_gap",
                  "of each of these points: its distance along the normal (length), < 0: interference, "
                  "before small ones are closed; 0 without a pair",
                  [](const H &h) { return h.surface_report.gap; }),
        result<H>(
            "surface_normal",
            "of each of these points: three components of its pair's normal, into the master; 0 without "
            "a pair",
            [](const H &h) { return h.surface_report.normal; }),
        result<H>("surface_area", "of each of these points: the area it stands for; 0 where nothing tells it",
                  [](const H &h) { return h.surface_report.area; }),
        result<H>("n_pairs", "contact pairs",
                  [](const H &h) { return h.core ? h.core->n_pairs() : h.input.contact.n_pairs(); }),
        warning_text<H>([](const H &h) -> const Warnings & { return built_warnings(h); }),
        warning_reasons<H>([](const H &h) -> const Warnings & { return built_warnings(h); }),
        result<H>("n_findings",
                  "findings of the build that are worth a look (each is in the log); after an audit: of all "
                  "its findings",
                  [](const H &h) { return built(h), h.n_findings; }),
        result<H>("n_rigid_modes", "rigid-body modes of the open structure",
                  [](const H &h) { return built(h)->n_rigid(); }),
        result<H>("shift", "sigma of the factored K + sigma M (rad^2/time^2); 0 when K is positive definite",
                  [](const H &h) { return built(h)->shift(); }),
        result<H>("local_stiffness",
                  "1 / median contact flexibility (force/length), of 16 pairs where there are more and k_n "
                  "is given; 0 without pairs",
                  [](const H &h) { return built(h)->local_stiffness(); }),
        result<H>("contact_stiffness", "k_n of every pair (force/length), chosen ones included",
                  [](const H &h) { return built(h)->contact_stiffness(); }),
        result<H>("initial_gap", "initial gap of every pair (length)",
                  [](const H &h) { return h.core ? h.core->initial_gap() : h.input.contact.initial_gap; }),

        result<H>("memory_matrices", "bytes of the structure on its free DOFs: M, K, C, gap rows",
                  [](const H &h) { return estimated(h).structure; }),
        result<H>("memory_factorization", "bytes of the factorization while it is made",
                  [](const H &h) { return estimated(h).factorization; }),
        result<H>("memory_factor", "bytes that are kept of it",
                  [](const H &h) { return estimated(h).factor; }),
        result<H>("memory_modes", "bytes of modes while they are sought, beside matrices and factor",
                  [](const H &h) { return estimated(h).modes; }),
        result<H>("memory_contact_space",
                  "bytes of the contact space while it is made, beside matrices and factor",
                  [](const H &h) { return estimated(h).contact_space; }),
        result<H>("memory_basis",
                  "bytes of a basis of forty columns while it is made, beside matrices and factor",
                  [](const H &h) { return estimated(h).basis; }),

        result<H>("rest_displacement", "displacement at rest under the pre-load, n_dof (length)",
                  rest_displacement),
        result<H>("rest_penetration", "penetration of every pair at rest (length)",
                  [](const H &h) { return rest(h).penetration; }),
        result<H>("rest_force", "normal force of every pair at rest (force)",
                  [](const H &h) { return rest(h).force; }),
        result<H>("rest_closed", "1 for every pair closed at rest, else 0",
                  [](const H &h) { return rest(h).states.flags(); }),
        result<H>("rest_n_closed", "pairs closed at rest",
                  [](const H &h) { return rest(h).states.n_closed(); }),
        result<H>("rest_iterations", "Newton iterations of the static equilibrium",
                  [](const H &h) { return rest(h).iterations; }),
    };
    return keys;
}

} // namespace plm::capi
