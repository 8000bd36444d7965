#include "reduction/reduced_model_bytes.hpp"
#include "reduction/widened_model.hpp"
#include "space/model_bytes.hpp"

namespace plm {
namespace {

// Damping of r coordinates, diagonal or not.
template <class Bytes, class D, class M>
void pass_damping(Bytes &bytes, D &diagonal, M &matrix, std::int64_t r) {
    bytes(diagonal);
    bytes(matrix);
    if constexpr (Bytes::reads)
        bytes.require(matrix.empty() ? diagonal.empty() || static_cast<std::int64_t>(diagonal.size()) == r
                                     : matrix.rows() == r && matrix.cols() == r,
                      "the damping of another basis");
}

template <class Bytes, class M> void pass_dynamic(Bytes &bytes, M &m) {
    bytes(m.lambda);
    bytes.require(m.size() >= 1, "no coordinates");
    bytes.integer(m.n_massless, 0, m.size());
    pass_damping(bytes, m.damping_diagonal, m.damping, m.size());
    bytes.require(!m.damping.empty() || static_cast<std::int64_t>(m.damping_diagonal.size()) == m.size(),
                  "no damping");
    bytes(m.structural);
    bytes(m.gap);
}

template <class Bytes, class M> void pass_static(Bytes &bytes, M &m) {
    bytes(m.same_static);
    bytes(m.lambda_0);
    const std::int64_t r = m.size(), r_0 = m.static_size();
    bytes.require(m.same_static ? r_0 == r : r_0 >= 1, "static coordinates that do not fit");
    bytes.integer(m.n_massless_0, 0, r_0);
    bytes(m.gap_0);
    pass_damping(bytes, m.damping_diagonal_0, m.damping_0, r_0);
    bytes(m.to_static);
    bytes.require(m.same_static ? m.to_static.empty() : m.to_static.rows() == r_0 && m.to_static.cols() == r,
                  "static coordinates that do not fit");
    bytes(m.preload_0);
    require_length(bytes, m.preload_0, r_0);
    bytes(m.in_space);
    bytes.require(m.in_space.empty() || m.in_space.cols() == r_0, "a space of other coordinates");
}

template <class Bytes, class M> void pass_pairs(Bytes &bytes, M &m) {
    pass_contact(bytes, m.contact);
    const std::int64_t z = m.n_pairs(), r = m.size(), r_0 = m.static_size();
    const auto fits = [&](const Matrix &gap, std::int64_t pairs, std::int64_t cols) {
        bytes.require(gap.cols() == cols && (gap.rows() == pairs * Contact::n_directions || pairs == 0),
                      "gaps of other pairs or coordinates");
    };
    fits(m.gap, z, r);
    fits(m.gap_0, z, r_0);
    bytes(m.carried);
    bool sampled = m.all_pairs != nullptr;
    bytes(sampled);
    if constexpr (Bytes::reads)
        if (sampled) m.all_pairs = std::make_shared<AllPairs>();
    if (!sampled) return bytes.require(m.carried.empty(), "pairs carried of none");
    AllPairs all;
    if constexpr (!Bytes::reads) all = *m.all_pairs;
    bytes(all.gap);
    bytes(all.gap_0);
    pass_contact(bytes, all.contact);
    const std::int64_t whole = all.contact.n_pairs();
    fits(all.gap, whole, r);
    fits(all.gap_0, whole, r_0);
    require_length(bytes, m.carried, z);
    for (std::int64_t pair : m.carried)
        bytes.require(pair >= 0 && pair < whole, "a pair that does not exist");
    if constexpr (Bytes::reads) m.all_pairs = std::make_shared<const AllPairs>(std::move(all));
}

template <class Bytes, class M> void pass_equations(Bytes &bytes, M &m) {
    pass_dynamic(bytes, m);
    pass_static(bytes, m);
    pass_pairs(bytes, m);
    pass_loads(bytes, m.excitation);
    if constexpr (Bytes::reads) require_loads(bytes, m.excitation, m.size(), m.static_size());
}

// And those of a model that is there: of its structure.
void require_pairs(ByteReader &bytes, const ReducedModel &m, const Model &model) {
    bytes.require(m.n_whole_pairs() == model.n_pairs(), "pairs of another model");
}

} // namespace

void write_whole(ByteWriter &bytes, const ReducedModel &reduced) {
    pass_equations(bytes, reduced);
    write_formed(bytes, reduced.vectors);
    if (reduced.same_static) return;
    write_formed(bytes, reduced.vectors_0);
    pass_loads(bytes, loads_when_widened(reduced));
}

std::shared_ptr<const ReducedModel> read_whole(ByteReader &bytes, std::shared_ptr<const Model> model) {
    const auto m = std::make_shared<ReducedModel>();
    m->model = std::move(model);
    pass_equations(bytes, *m);
    require_pairs(bytes, *m, *m->model);
    m->vectors = read_formed(bytes, *m->model, m->size());
    if (m->same_static) return m;
    m->vectors_0 = read_formed(bytes, *m->model, m->static_size());
    HarmonicLoads loads;
    pass_loads(bytes, loads);
    require_loads(bytes, loads, m->static_size(), m->static_size());
    keep_widened(*m, loads);
    return m;
}

void write_compressed(ByteWriter &bytes, const ReducedModel &reduced) {
    pass_equations(bytes, reduced);
    bytes(reduced.from->coordinates);
}

std::shared_ptr<const ReducedModel> read_compressed(ByteReader &bytes,
                                                    std::shared_ptr<const ReducedModel> from) {
    const auto m = std::make_shared<ReducedModel>();
    m->model = from->model;
    pass_equations(bytes, *m);
    require_pairs(bytes, *m, *m->model);
    Matrix coordinates;
    bytes(coordinates);
    bytes.require(m->same_static && from->same_static, "a compressed model with a static basis of its own");
    require_shape(bytes, coordinates, from->size(), m->size());
    m->vectors = from->vectors.times(coordinates);
    m->from = std::make_shared<const CompressedFrom>(CompressedFrom{std::move(from), std::move(coordinates)});
    return m;
}

std::uint64_t fingerprint(const ReducedModel &reduced) {
    ByteWriter writer([](const void *, std::size_t) {});
    pass_equations(writer, reduced);
    return writer.checksum();
}

} // namespace plm
