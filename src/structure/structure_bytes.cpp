// A structure as bytes: all but its matrices, their factors and modes. Maps from DOFs to free ones, gap rows
// and loads are few numbers; who needs more attaches the model (its fingerprint tells that it is the same).
#include "linalg/bytes.hpp"
#include "structure/field_bytes.hpp"
#include "structure/structure.hpp"
#include <cmath>
#include <utility>

namespace plm {
namespace {

constexpr std::int64_t least_list_item = 16; // bytes

template <class Bytes, class Terms> void pass_terms(Bytes &bytes, Terms &terms, std::int64_t n) {
    pass_list(bytes, terms, 16, [&](auto &t) {
        bytes.integer(t.dof, 0, n - 1);
        bytes(t.coefficient);
    });
}

template <class Bytes, class Sparse>
void pass_sparse(Bytes &bytes, Sparse &a, std::int64_t rows, std::int64_t cols) {
    bytes.integer(a.rows, rows, rows);
    bytes.integer(a.cols, 0, cols);
    bytes(a.ptr);
    bytes(a.idx);
    bytes(a.val);
    if constexpr (Bytes::reads) {
        if (a.ptr.empty()) return bytes.require(a.cols == 0 && a.idx.empty() && a.val.empty(), "no columns");
        require_length(bytes, a.ptr, a.cols + 1);
        require_length(bytes, a.val, a.nnz());
        bytes.require(a.ptr[0] == 0 && a.ptr.back() == a.nnz(), "columns that do not hold the entries");
        for (std::int64_t j = 0; j < a.cols; ++j) {
            bytes.require(a.ptr[j] <= a.ptr[j + 1] && a.ptr[j + 1] <= a.nnz(), "columns that overlap");
            for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
                bytes.require(a.idx[p] >= (p > a.ptr[j] ? a.idx[p - 1] + 1 : 0) && a.idx[p] < rows,
                              "rows that are not in order or do not exist");
        }
    }
}

/// The columns as an array of this process, fetched where they are kept elsewhere.
template <class F> void with_array(const Field &x, F f) {
    if (const Matrix *columns = x.block().matrix()) return f(*columns);
    Matrix all(x.rows(), 0);
    for (std::int64_t j = 0; j < x.cols(); ++j) {
        const vector<double> column = x.column(j);
        all.append(Field(column).in_core());
    }
    f(all);
}

template <class Bytes, class F>
void pass_field(Bytes &bytes, F &field, std::int64_t rows, std::int64_t most_cols) {
    if constexpr (Bytes::reads) {
        Matrix columns;
        bytes(columns);
        bytes.require(columns.cols() <= most_cols && (columns.empty() || columns.rows() == rows),
                      "vectors of another length than the structure has");
        field = Field(std::move(columns));
    } else {
        with_array(field, [&](const Matrix &columns) { bytes(columns); });
    }
}

constexpr int most_harmonic = 1 << 20, most_power = 64;

template <class Bytes, class Part> void pass_part(Bytes &bytes, Part &part) {
    bytes.integer(part.harmonic, 0, most_harmonic);
    bytes.integer(part.power, -most_power, most_power);
}

template <class Bytes, class Loads> void pass_forces(Bytes &bytes, Loads &loads, std::int64_t n) {
    const std::int64_t count = bytes.size(static_cast<std::int64_t>(loads.size()), least_list_item);
    auto at = loads.begin();
    for (std::int64_t k = 0; k < count; ++k) {
        LoadPart part(0);
        HarmonicForce force;
        if constexpr (!Bytes::reads) part = at->first, force = (at++)->second;
        pass_part(bytes, part);
        pass_field(bytes, force.real, n, 1);
        pass_field(bytes, force.imag, n, 1);
        if constexpr (Bytes::reads) loads[part] = std::move(force);
    }
}

std::uint64_t crc_of(const SparseMatrix &a, std::uint64_t crc) {
    crc = crc64(a.ptr.data(), sizeof(std::int64_t) * a.ptr.size(), crc);
    crc = crc64(a.idx.data(), sizeof(std::int64_t) * a.idx.size(), crc);
    return crc64(a.val.data(), sizeof(double) * a.val.size(), crc);
}

std::uint64_t crc_of(const Field &x, std::uint64_t crc) {
    with_array(x, [&](const Matrix &columns) {
        crc = crc64(columns.data(), sizeof(double) * static_cast<std::size_t>(x.rows() * x.cols()), crc);
    });
    return crc;
}

} // namespace

void write_field(ByteWriter &bytes, const Field &field) {
    with_array(field, [&](const Matrix &columns) { bytes(columns); });
}

Field read_field(ByteReader &bytes, std::int64_t rows, std::int64_t cols) {
    Matrix all;
    bytes(all);
    require_shape(bytes, all, rows, cols);
    return Field(std::move(all));
}

template <class Groups, class Bytes>
void DofMap::pass_groups(Groups &groups, std::int64_t n_dof, Bytes &bytes) {
    bytes(groups.within);
    bytes(groups.rows.ptr);
    bytes(groups.rows.dof);
    bytes(groups.rows.coefficient);
    if constexpr (Bytes::reads) {
        const ConstraintRows &rows = groups.rows;
        const std::int64_t n_sums = static_cast<std::int64_t>(groups.within.size()),
                           entries = static_cast<std::int64_t>(rows.dof.size());
        bytes.require(!rows.ptr.empty() && rows.ptr[0] == 0 && rows.ptr.back() == entries &&
                          rows.n_rows() >= n_sums,
                      "sums over DOFs without their rows");
        require_length(bytes, rows.coefficient, entries);
        for (std::int64_t i = 0; i < rows.n_rows(); ++i)
            bytes.require(rows.ptr[i] < rows.ptr[i + 1] && rows.ptr[i + 1] <= entries, "rows that overlap");
        for (std::int64_t dof : groups.within) bytes.require(dof >= 0 && dof < n_dof, "a sum over no DOF");
        for (std::int64_t i = rows.n_rows() - n_sums, k = 0; k < n_sums; ++i, ++k) // of sums before it
            for (std::int64_t p = rows.ptr[i]; p + 1 < rows.ptr[i + 1]; ++p)
                bytes.require(rows.dof[p] >= 0 && rows.dof[p] < n_dof + k, "a sum over DOFs that are none");
    }
}

template <class Map, class Bytes> void DofMap::pass(Map &map, Bytes &bytes) {
    bytes.integer(map.n_dof_, 1, INT64_MAX);
    pass_groups(map.grouped_, map.n_dof_, bytes);
    bytes(map.free_dof_);
    bytes(map.place_);
    const std::int64_t n = static_cast<std::int64_t>(map.place_.size()), n_free = map.n_free();
    bytes.require(n >= 1 && n_free >= 1 && n_free <= n, "no DOFs");
    bytes.require(n - map.n_dof_ == static_cast<std::int64_t>(map.grouped_.within.size()),
                  "another number of DOFs than there are places");
    pass_sparse(bytes, map.dependent_, n_free, n);
    bytes.integer(map.elimination_.n_redundant, 0, INT64_MAX);
    if constexpr (Bytes::reads) {
        for (std::int64_t i = 0; i < n_free; ++i) {
            const std::int64_t dof = map.free_dof_[i];
            bytes.require(dof >= 0 && dof < n && map.place_[dof] == i, "free DOFs that are not in order");
        }
        for (std::int64_t place : map.place_)
            bytes.require(place < n_free && place >= held - map.dependent_.cols, "a DOF without a place");
    }
}
void DofMap::write(ByteWriter &bytes) const {
    pass(*this, bytes);
}
void DofMap::read(ByteReader &bytes) {
    pass(*this, bytes);
}

template <class Rows, class Bytes> void GapRows::pass(Rows &rows, std::int64_t n_free, Bytes &bytes) {
    constexpr std::int64_t most_directions = 3;
    bytes.integer(rows.size_.n_pairs, 0, std::int64_t(1) << 40);
    bytes.integer(rows.size_.n_directions, 1, most_directions);
    pass_sparse(bytes, rows.matrix_, rows.n_rows(), n_free);
    bytes(rows.left_out_);
    pass_field(bytes, rows.momenta_, n_free, n_free);
    bytes.require(rows.matrix_.cols == n_free, "gap rows of another structure");
    bytes.require(rows.left_out_.cols() == rows.momenta_.cols() &&
                      (rows.left_out_.cols() == 0 || rows.left_out_.rows() == rows.n_rows()),
                  "rigid motions that do not belong to the gap rows");
}
void GapRows::write(ByteWriter &bytes) const {
    pass(*this, matrix_.cols, bytes);
}
void GapRows::read(ByteReader &bytes, std::int64_t n_free) {
    pass(*this, n_free, bytes);
    place_ = Field(n_free, 0);
}

template <class Motion, class Bytes>
void BaseMotion::pass(Motion &motion, std::int64_t n_dof, std::int64_t n_free, Bytes &bytes) {
    const std::int64_t count = bytes.size(static_cast<std::int64_t>(motion.parts_.size()), least_list_item);
    for (std::int64_t k = 0; k < count; ++k) {
        LoadPart part(0);
        if constexpr (!Bytes::reads) part = motion.parts_[static_cast<std::size_t>(k)];
        pass_part(bytes, part);
        if constexpr (Bytes::reads) motion.parts_.push_back(part);
    }
    bytes(motion.moved_);
    pass_field(bytes, motion.lift_, n_free, motion.moved_.cols());
    if (motion.parts_.empty()) return bytes.require(motion.moved_.cols() == 0, "a base that does not move");
    require_shape(bytes, motion.moved_, n_dof, 2 * static_cast<std::int64_t>(motion.parts_.size()));
    require_shape(bytes, motion.lift_.in_core(), n_free, motion.moved_.cols());
}
void BaseMotion::write(ByteWriter &bytes) const {
    pass(*this, 0, 0, bytes);
}
void BaseMotion::read(ByteReader &bytes, std::int64_t n_dof, std::int64_t n_free) {
    pass(*this, n_dof, n_free, bytes);
}

template <class Self, class Bytes> void Structure::pass(Self &self, Bytes &bytes) {
    auto &parts = *self.parts_;
    const std::int64_t n = parts.dofs.n_free();
    auto &damping = self.damping_options_;
    bytes(damping.alpha);
    bytes(damping.beta);
    bytes(damping.structural);
    bytes(damping.modal_ratio);
    bytes(damping.has_matrix);
    pass_field(bytes, self.preload_, n, 1);
    pass_forces(bytes, self.excitation_, n);
    bytes(self.preload_resultant_);
    bytes(self.mean_resultant_);
    bytes(parts.shift);
    bytes(parts.uncertainty);
    bytes.integer(parts.n_rigid, 0, n);
    bytes.integer(parts.n_unheld, 0, n);
}

void Structure::write(ByteWriter &bytes) const {
    parts_->dofs.write(bytes);
    parts_->gap_rows.write(bytes);
    parts_->base.write(bytes);
    const std::vector<DofTerms> none, &outputs = outputs_ ? *outputs_ : none;
    pass_list(bytes, outputs, 8, [&](const DofTerms &sum) { pass_terms(bytes, sum, n_dof_); });
    pass(*this, bytes);
    bytes(static_cast<std::int64_t>(fingerprint()));
    bytes(static_cast<std::int64_t>(fingerprint_of_loads()));
}

Structure::Structure(ByteReader &bytes) : parts_(std::make_shared<Parts>()) {
    parts_->dofs.read(bytes);
    n_dof_ = parts_->dofs.n_dof();
    parts_->place = Field(n_free(), 0);
    parts_->gap_rows.read(bytes, n_free());
    parts_->base.read(bytes, n_dof_, n_free());
    std::vector<DofTerms> outputs;
    pass_list(bytes, outputs, 8, [&](DofTerms &sum) { pass_terms(bytes, sum, n_dof_); });
    outputs_ = std::make_shared<const std::vector<DofTerms>>(std::move(outputs));
    pass(*this, bytes);
    std::int64_t whole = 0, loads = 0;
    bytes(whole);
    bytes(loads);
    parts_->fingerprint = static_cast<std::uint64_t>(whole);
    parts_->fingerprint_of_loads = static_cast<std::uint64_t>(loads);
}

void Structure::throw_without_matrices() {
    throw Error(
        status::state,
        "this needs the matrices of the structure, which are not in the bytes that the basis was read "
        "from: attach the model that it was made of, or build the basis on one")
        .argument("basis");
}

namespace {

/// The first seven: a host whose parts are summed in another order (another number of ranks) tells others
/// behind them of the same model.
double leading_digits(double x) {
    int power = 0;
    const double mantissa = std::frexp(x, &power);
    return std::ldexp(std::round(std::ldexp(mantissa, 24)), power - 24);
}

} // namespace

// Of what moves: supports and constraints are in the matrices on the free DOFs and in their numbers.
std::uint64_t Structure::fingerprint_of_parts() const {
    const vector<std::int64_t> &dofs = parts_->dofs.free_dofs();
    std::uint64_t crc = crc64(&n_dof_, sizeof n_dof_);
    crc = crc64(dofs.data(), sizeof(std::int64_t) * dofs.size(), crc);
    const SparseMatrix &gap = parts_->gap_rows.matrix();
    for (const SparseMatrix *a : {&std::as_const(parts_->mass), &std::as_const(parts_->stiffness),
                                  &std::as_const(parts_->damping), &gap})
        crc = crc_of(*a, crc);
    if (!parts_->in_core) { // what the host told of its matrices
        const TallFacts f = parts_->tall->facts();
        const double told[] = {static_cast<double>(f.n_dof), static_cast<double>(f.n_massive),
                               leading_digits(f.trace_of_mass), leading_digits(f.trace_of_stiffness),
                               leading_digits(f.least_stiffness)};
        crc = crc64(told, sizeof told, crc);
    }
    return crc == 0 ? 1 : crc;
}

std::uint64_t Structure::fingerprint_of_loads() const {
    if (!is_whole()) return parts_->fingerprint_of_loads;
    const double numbers[] = {damping_options_.alpha, damping_options_.beta, damping_options_.structural};
    std::uint64_t crc = crc64(numbers, sizeof numbers);
    const vector<double> &ratios = damping_options_.modal_ratio;
    crc = crc64(ratios.data(), sizeof(double) * ratios.size(), crc);
    crc = crc_of(preload_, crc);
    for (const auto &[part, force] : excitation_) {
        const std::int64_t which[] = {part.harmonic, part.power};
        crc = crc64(which, sizeof which, crc);
        crc = crc_of(force.imag, crc_of(force.real, crc));
    }
    return crc;
}

} // namespace plm
