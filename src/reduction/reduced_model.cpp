#include "reduction/reduced_model.hpp"
#include "space/massless.hpp"

namespace plm {

Matrix static_coordinates_of(const ReducedModel &m, const Field &motions) {
    return coordinates_of(*m.model, motions, m.static_vectors(), m.lambda_0, m.n_massless_0);
}

} // namespace plm
