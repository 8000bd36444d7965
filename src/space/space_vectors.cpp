#include "space/space_vectors.hpp"
#include "linalg/error.hpp"
#include <algorithm>

namespace plm {
namespace {

// Columns `first` to first + count of the identity.
Matrix unit_columns(std::int64_t n, std::int64_t first, std::int64_t count) {
    Matrix e(n, count);
    for (std::int64_t j = 0; j < count; ++j) e(first + j, j) = 1;
    return e;
}

Matrix one_column(const vector<double> &y) {
    Matrix column(static_cast<std::int64_t>(y.size()), 1);
    std::copy(y.begin(), y.end(), column.data());
    return column;
}

bool has_responses(const SpaceVectors::Parts &p) {
    return p.of_responses.rows() > 0;
}

Field recover_some(const SpaceVectors::Parts &p, const Matrix &y) {
    Field x = p.further->zeros(y.cols());
    if (has_responses(p)) {
        x = ActingForces(*p.structure).combine(product('N', 'N', p.of_responses, y));
        p.modes->take_from_forces(x);
        respond_outside(*p.structure, *p.modes, x);
    }
    if (p.of_modes.rows() > 0) add_combination(1.0, p.modes->vectors, product('N', 'N', p.of_modes, y), x);
    if (p.of_further.rows() > 0) add_combination(1.0, *p.further, product('N', 'N', p.of_further, y), x);
    return x;
}

Field recover(const SpaceVectors::Parts &p, const Matrix &y) {
    if (y.cols() <= solved_at_once) return recover_some(p, y);
    Field x = p.further->zeros(y.cols());
    for (std::int64_t first = 0; first < y.cols(); first += solved_at_once)
        x.put(first, recover_some(p, y.columns(first, std::min(solved_at_once, y.cols() - first))));
    return x;
}

Matrix products_with_some(const SpaceVectors::Parts &p, const Field &f) {
    Matrix c = product('T', 'N', p.of_further, gram(*p.further, f));
    if (p.of_modes.rows() > 0) gemm('T', 'N', 1.0, p.of_modes, gram(p.modes->vectors, f), 1.0, c);
    if (!has_responses(p)) return c;
    Field x = f;
    p.modes->take_from_forces(x);
    respond_outside(*p.structure, *p.modes, x);
    gemm('T', 'N', 1.0, p.of_responses, ActingForces(*p.structure).products(x), 1.0, c);
    return c;
}

Matrix products_with(const SpaceVectors::Parts &p, const Field &f) {
    if (f.cols() <= solved_at_once) return products_with_some(p, f);
    Matrix c(p.of_further.cols(), 0);
    for (std::int64_t first = 0; first < f.cols(); first += solved_at_once)
        c.append(products_with_some(p, f.columns(first, std::min(solved_at_once, f.cols() - first))));
    return c;
}

} // namespace

SpaceVectors::SpaceVectors(Field vectors) : recovered_(std::make_shared<Recovered>()) {
    parts_.of_further = unit_columns(vectors.cols(), 0, vectors.cols());
    parts_.further = std::make_shared<const Field>(std::move(vectors));
    recovered_->all = parts_.further;
}

SpaceVectors SpaceVectors::absent(std::int64_t n_free, std::map<DofTerms, vector<double>> rows,
                                  std::int64_t m) {
    Parts p;
    p.further = std::make_shared<const Field>(n_free, 0);
    p.of_further = Matrix(0, m);
    SpaceVectors v(std::move(p));
    v.recovered_ = std::make_shared<Recovered>();
    v.recovered_->rows = std::move(rows);
    v.recovered_->absent = true;
    return v;
}

void SpaceVectors::require_present() const {
    if (is_absent())
        throw Error(status::state,
                    "this needs vectors of the contact space, which are not in the bytes that the basis was "
                    "read from: attach the model that it was made of, or build the basis on one")
            .argument("basis");
}

SpaceVectors SpaceVectors::times(const Matrix &y) const {
    require_present();
    Parts p;
    if (recovered_ && recovered_->all) { // nothing is left to solve
        p.further = recovered_->all;
        p.of_further = y;
    } else {
        p.structure = parts_.structure;
        p.modes = parts_.modes;
        p.further = parts_.further;
        p.of_further = product('N', 'N', parts_.of_further, y);
        if (parts_.of_modes.rows() > 0) p.of_modes = product('N', 'N', parts_.of_modes, y);
        if (has_responses(parts_)) p.of_responses = product('N', 'N', parts_.of_responses, y);
    }
    SpaceVectors basis(std::move(p));
    basis.recovered_ = std::make_shared<Recovered>();
    return basis;
}

SpaceVectors SpaceVectors::whole() const {
    SpaceVectors basis = *this;
    if (!basis.recovered_) basis.recovered_ = std::make_shared<Recovered>();
    return basis;
}

std::int64_t SpaceVectors::bytes() const {
    const auto entries = [](const auto &a) { return a.rows() * a.cols(); };
    std::int64_t n = entries(parts_.of_further) + entries(parts_.of_modes) + entries(parts_.of_responses);
    if (parts_.further) n += entries(*parts_.further);
    if (parts_.modes) n += entries(parts_.modes->vectors) + entries(parts_.modes->momenta);
    return static_cast<std::int64_t>(sizeof(double)) * n;
}

const Field &SpaceVectors::formed() const {
    require_present();
    if (!recovered_) throw Error(status::internal, "the vectors of a space are not formed as a whole");
    if (!recovered_->all) {
        recovered_->all = std::make_shared<const Field>(recover(parts_, unit_columns(cols(), 0, cols())));
        recovered_->rows.clear();
    }
    return *recovered_->all;
}

bool SpaceVectors::worth_forming(std::int64_t more) const {
    if (!recovered_) return false;
    require_present();
    if (recovered_->all) return true;
    recovered_->asked += more;
    if (recovered_->asked <= cols()) return false;
    formed();
    return true;
}

vector<double> SpaceVectors::row(const DofTerms &sum) const {
    if (sum.empty()) return vector<double>(cols(), 0.0);
    if (recovered_) {
        const auto known = recovered_->rows.find(sum);
        if (known != recovered_->rows.end()) return known->second;
    }
    if (worth_forming(1)) return formed().row(sum);
    const Matrix found = products_with(parts_, parts_.further->sums({sum}));
    vector<double> entries(found.data(), found.data() + found.rows());
    if (recovered_ && !recovered_->all) recovered_->rows[sum] = entries;
    return entries;
}

Matrix SpaceVectors::rows_at(const vector<std::int64_t> &chosen) const {
    if (worth_forming(static_cast<std::int64_t>(chosen.size()))) return formed().rows_at(chosen);
    std::vector<DofTerms> units;
    for (std::int64_t dof : chosen) units.push_back({{dof, 1.0}});
    return products_with(parts_, parts_.further->sums(units)).transposed();
}

Field combine(const SpaceVectors &v, const Matrix &y) {
    return v.worth_forming(y.cols()) ? combine(v.formed(), y) : recover(v.parts(), y);
}

Field combine(const SpaceVectors &v, const vector<double> &y) {
    return combine(v, one_column(y));
}

void add_combination(double factor, const SpaceVectors &v, const Matrix &y, Field &x) {
    if (v.worth_forming(y.cols()))
        add_combination(factor, v.formed(), y, x);
    else
        add(factor, recover(v.parts(), y), x);
}

void add_combination(double factor, const SpaceVectors &v, const vector<double> &y, Field &x) {
    add_combination(factor, v, one_column(y), x);
}

Matrix gram(const SpaceVectors &v, const Field &f) {
    return v.worth_forming(f.cols()) ? gram(v.formed(), f) : products_with(v.parts(), f);
}

Field all_columns(const SpaceVectors &v) {
    return columns(v, 0, v.cols());
}

Field columns(const SpaceVectors &v, std::int64_t first, std::int64_t count) {
    if (v.worth_forming(count)) return v.formed().columns(first, count);
    return recover(v.parts(), unit_columns(v.cols(), first, count));
}

vector<double> projected(const SpaceVectors &v, const Field &load) {
    if (load.empty()) return {};
    const Matrix c = gram(v, load);
    return vector<double>(c.data(), c.data() + c.rows());
}

HarmonicLoads projected(const SpaceVectors &v, const HarmonicForces &loads) {
    HarmonicLoads reduced;
    for (const auto &[part, load] : loads) reduced[part] = {projected(v, load.real), projected(v, load.imag)};
    return reduced;
}

} // namespace plm
