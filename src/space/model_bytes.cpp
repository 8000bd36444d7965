#include "space/model_bytes.hpp"
#include "space/space.hpp"
#include "structure/field_bytes.hpp"

namespace plm {
namespace {

// Who is asked for the amplitude of some DOF, whichever (basis_error.cpp), asks for that of the first one.
DofTerms first_dof(const Model &model) {
    return model.terms(0);
}

template <class Bytes, class S> void pass_space(Bytes &bytes, S &s) {
    bytes(s.lambda);
    const std::int64_t m = s.size(), z = s.n_pairs();
    bytes.integer(s.n_massless, 0, m);
    bytes(s.gap);
    bytes.require(s.gap.cols() == m && (m == 0 || s.gap.rows() == z * Contact::n_directions || z == 0),
                  "gaps of another space");
    bytes(s.damping_diagonal);
    bytes(s.damping);
    bytes.require(s.damping_diagonal.empty() || static_cast<std::int64_t>(s.damping_diagonal.size()) == m,
                  "the damping of another space");
    bytes.require(s.damping.empty() || (s.damping.rows() == m && s.damping.cols() == m),
                  "the damping of another space");
    bytes.require(!s.damping.empty() || !s.damping_diagonal.empty() || m == 0, "no damping");
    bytes(s.preload);
    bytes.require(s.preload.empty() || static_cast<std::int64_t>(s.preload.size()) == m,
                  "the pre-load of another space");
    pass_loads(bytes, s.excitation);
    if constexpr (Bytes::reads) require_loads(bytes, s.excitation, m, m);
    bytes.integer(s.n_exact_modes, 0, m);
    bytes(s.highest_frequency);
    bytes(s.error_estimate);
    bytes(s.is_contact_space);
    bytes(s.counts_verified);
    bytes(s.seconds);
    bytes(s.description);
}

} // namespace

template <class Self, class Bytes> void Model::pass(Self &self, Bytes &bytes) {
    pass_contact(bytes, self.contact_);
    bytes(self.local_stiffness_);
    auto &o = self.space_options_;
    bytes(o.tolerance);
    bytes(o.cutoff_factor);
    bytes.integer(o.max_blocks, 0, INT64_MAX);
    bytes(o.verify_counts);
    bytes(o.reduction_error);
    bytes(o.absolute_outputs);
    bytes(self.rest_forces_.force);
}

Model::Model(ByteReader &bytes) : Structure(bytes) {
    pass(*this, bytes);
    bytes.require(gap_rows().size().n_pairs == n_pairs() &&
                      gap_rows().size().n_directions == Contact::n_directions,
                  "pairs without gap rows");
}

void Model::write(ByteWriter &bytes) const {
    Structure::write(bytes);
    pass(*this, bytes);
}

void write_formed(ByteWriter &bytes, const SpaceVectors &vectors) {
    write_field(bytes, vectors.formed());
}

SpaceVectors read_formed(ByteReader &bytes, const Model &model, std::int64_t cols) {
    return SpaceVectors(read_field(bytes, model.n_free(), cols));
}

SpaceVectors formed_beside(const Model &model, const SpaceVectors &vectors) {
    const Field &all = vectors.formed();
    Field here = model.zeros(0);
    here.reserve(all.cols());
    for (std::int64_t j = 0; j < all.cols(); ++j) here.append(here.from(all.column(j)));
    return SpaceVectors(std::move(here));
}

void Space::write(ByteWriter &bytes) const {
    pass_space(bytes, *this);
    bytes(vectors.row(first_dof(*model)));
}

std::shared_ptr<const Space> Space::read(ByteReader &bytes, std::shared_ptr<const Model> model) {
    const auto space = std::make_shared<Space>();
    space->model = std::move(model);
    pass_space(bytes, *space);
    vector<double> row;
    bytes(row);
    require_length(bytes, row, space->size());
    space->vectors = SpaceVectors::absent(space->model->n_free(),
                                          {{first_dof(*space->model), std::move(row)}}, space->size());
    return space;
}

} // namespace plm
