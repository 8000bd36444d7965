#include "reduction/widened_model.hpp"
#include "reduction/compression.hpp"
#include <utility>

namespace plm {
namespace {

ReducedModel widen(const ReducedModel &m, HarmonicLoads excitation) {
    ReducedModel wide = m;
    wide.same_static = true;
    wide.lambda = m.lambda_0;
    wide.n_massless = m.n_massless_0;
    wide.gap = m.gap_0;
    wide.vectors = m.vectors_0;
    wide.vectors_0 = SpaceVectors();
    wide.to_static = Matrix();
    // what is moved from keeps its shape, without numbers: not to be left in a model
    wide.damping_diagonal = std::exchange(wide.damping_diagonal_0, {});
    wide.damping = std::exchange(wide.damping_0, Matrix());
    wide.excitation = std::move(excitation);
    if (m.all_pairs)
        wide.all_pairs = std::make_shared<const AllPairs>(
            AllPairs{m.all_pairs->gap_0, m.all_pairs->gap_0, m.all_pairs->contact});
    return wide;
}

std::shared_ptr<const ReducedModel> widened_of(const ReducedModel &m) {
    if (!m.model)
        throw Error(status::state, "a reduced model with static directions of its own needs its model");
    return m.widened.get([&] { return widen(m, projected(m.vectors_0, m.model->excitation())); });
}

} // namespace

void keep_widened(const ReducedModel &reduced, const HarmonicLoads &excitation) {
    reduced.widened.get([&] { return widen(reduced, excitation); });
}

const HarmonicLoads &loads_when_widened(const ReducedModel &reduced) {
    return widened_of(reduced)->excitation;
}

void clear_massless(std::int64_t n, Matrix &c) {
    for (std::int64_t j = 0; j < c.cols(); ++j)
        for (std::int64_t i = 0; i < c.rows(); ++i)
            if (i >= c.rows() - n || j >= c.cols() - n) c(i, j) = 0;
}

std::shared_ptr<const ReducedModel> widened(const std::shared_ptr<const ReducedModel> &reduced) {
    if (reduced->same_static) return reduced;
    return widened_of(*reduced);
}

bool of_one_basis(const std::shared_ptr<const ReducedModel> &a,
                  const std::shared_ptr<const ReducedModel> &b) {
    const auto one = uncompressed(a), other = uncompressed(b);
    return one == other || widened(one) == other || widened(other) == one;
}

} // namespace plm
