#include "space/rest_gaps.hpp"

namespace plm {

std::shared_ptr<const Model> with_rest_gaps(std::shared_ptr<Model> model, Watch watch) {
    if (model->rest_forces().empty()) return model;
    const std::shared_ptr<const RestState> rest = rest_of(std::shared_ptr<const Model>(model), watch);
    const Matrix displaced = model->gap_rows().of(rest->displacement);
    vector<double> gap = model->initial_gap();
    for (std::int64_t i = 0; i < model->n_pairs(); ++i)
        if (model->rest_forces().has(i)) gap[i] = displaced(Contact::normal_row(i), 0) - rest->penetration[i];
    model->set_initial_gap(std::move(gap));
    return model;
}

} // namespace plm
