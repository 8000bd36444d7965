#include "space/rest_gaps.hpp"

namespace plm {
namespace {

// The same, told of the forces, too.
Error beside_forces(const Error &e) {
    return Error(e.status(),
                 format("%s (with the contact forces at rest that are given, which a body that nothing else "
                        "holds needs to balance its pre-load; after the build both change one after the "
                        "other: remove the forces by NULL, set the pre-load, then the new forces)",
                        e.what()))
        .reason(e.reason());
}

} // namespace

std::shared_ptr<const Model> with_rest_gaps(std::shared_ptr<Model> model, Watch watch) {
    if (model->rest_forces().empty()) return model;
    std::shared_ptr<const RestState> rest;
    try {
        rest = rest_of(std::shared_ptr<const Model>(model), watch);
    } catch (const Error &e) {
        if (e.reason() != reason::no_equilibrium) throw;
        throw beside_forces(e);
    }
    const Matrix displaced = model->gap_rows().of(rest->displacement);
    vector<double> gap = model->initial_gap();
    for (std::int64_t i = 0; i < model->n_pairs(); ++i)
        if (model->rest_forces().has(i)) gap[i] = displaced(Contact::normal_row(i), 0) - rest->penetration[i];
    model->set_initial_gap(std::move(gap));
    return model;
}

} // namespace plm
