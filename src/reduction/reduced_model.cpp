#include "reduction/reduced_model.hpp"
#include "space/massless.hpp"

namespace plm {

Matrix static_coordinates_of(const ReducedModel &m, const Field &motions) {
    const auto works = [&](const Field &forces) { return gram(m.static_vectors(), forces); };
    return coordinates_of(*m.model, motions, works, m.lambda_0, m.n_massless_0);
}

} // namespace plm
