#include "space/attachment_basis.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// The combinations of unit energy that are orthogonal to one another, by the energies of what they combine;
// those of less energy than `least` are left out.
Matrix unit_energy(const Matrix &energies, double least) {
    const SymmetricEigen e = symmetric_eigen(energies);
    const std::int64_t n = energies.cols();
    if (n > 0) least = std::max(least, 1e-14 * e.values.back());
    const std::int64_t first =
        std::lower_bound(e.values.begin(), e.values.end(), least) - e.values.begin(); // ascending
    Matrix t = e.vectors.columns(first, n - first);
    for (std::int64_t j = 0; j < t.cols(); ++j)
        for (std::int64_t i = 0; i < n; ++i) t(i, j) /= std::sqrt(e.values[first + j]);
    return t;
}

// The slowest come first.
SymmetricEigen by_inertia(Matrix inertia) {
    for (std::int64_t k = 0; k < inertia.rows() * inertia.cols(); ++k) inertia.data()[k] *= -1;
    SymmetricEigen e = symmetric_eigen(inertia);
    for (double &mu : e.values) mu = std::max(-mu, 0.0); // 0: no mass
    return e;
}

Matrix congruence(const Matrix &t, const Matrix &a) {
    return product('T', 'N', t, product('N', 'N', a, t));
}

// [A B; B^T D]
Matrix bordered(const Matrix &a, const Matrix &b, const Matrix &d) {
    const std::int64_t n = a.cols(), q = d.cols();
    Matrix whole(n + q, n + q);
    for (std::int64_t j = 0; j < n; ++j) std::copy_n(a.col(j), n, whole.col(j));
    for (std::int64_t j = 0; j < q; ++j) {
        std::copy_n(d.col(j), q, whole.col(n + j) + n);
        for (std::int64_t i = 0; i < n; ++i) whole(i, n + j) = whole(n + j, i) = b(i, j);
    }
    return whole;
}

Matrix chosen_columns(const Matrix &a, const vector<std::int64_t> &columns) {
    Matrix some(a.rows(), static_cast<std::int64_t>(columns.size()));
    for (std::int64_t j = 0; j < some.cols(); ++j) std::copy_n(a.col(columns[j]), a.rows(), some.col(j));
    return some;
}

constexpr double nothing_left = 1e-20; // of the energy: the modes contain all of it
constexpr double independent = 1e-12;  // least share of energy that others do not have
constexpr double negligible = 1e-9;    // energy of a further vector beside that it started with

} // namespace

AttachmentBasis::AttachmentBasis(std::shared_ptr<const Structure> structure,
                                 std::shared_ptr<const StaticResponses> responses, double reach)
    : structure_(std::move(structure)), responses_(std::move(responses)), forces_(*structure_), reach_(reach),
      frontier_(structure_->zeros(0)), further_(structure_->zeros(0)) {
    const std::int64_t n = forces_.count();
    works_ = coupling_ = Matrix(n, 0);
    orthonormalise_responses();
    const SymmetricEigen e = by_inertia(inertia_);
    slow_ = product('N', 'N', orthonormal_, e.vectors);
    for (double mu : e.values) share_.push_back(reach_ * mu);
    set_shares_of_loads();
    power_.assign(share_.size(), 1);
    at_.assign(share_.size(), -1);
    rayleigh_ritz();
}

// Scaled to unit energy first; responses that the exact modes already contain are dropped.
void AttachmentBasis::orthonormalise_responses() {
    const Matrix &energy = responses_->energy;
    const vector<double> whole = responses_->whole_energies(structure_->shift());
    const std::int64_t n = energy.cols();
    vector<double> scale(n);
    for (std::int64_t j = 0; j < n; ++j)
        scale[j] = energy(j, j) <= nothing_left * whole[j] ? 0 : 1 / std::sqrt(energy(j, j));
    Matrix scaled = energy;
    for (std::int64_t j = 0; j < n; ++j)
        for (std::int64_t i = 0; i < n; ++i) scaled(i, j) *= scale[i] * scale[j];
    orthonormal_ = unit_energy(scaled, independent);
    for (std::int64_t j = 0; j < orthonormal_.cols(); ++j)
        for (std::int64_t i = 0; i < n; ++i) orthonormal_(i, j) *= scale[i];
    inertia_ = congruence(orthonormal_, responses_->inertia);
}

// A load on one node has much of its energy in directions that are fast, and no slow one leads to it.
void AttachmentBasis::set_shares_of_loads() {
    const std::int64_t first = forces_.n_contact(), loads = forces_.count() - first;
    const vector<double> whole = responses_->whole_energies(structure_->shift());
    of_loads_.assign(share_.size(), 0.0);
    const Matrix works = product('T', 'N', slow_, responses_->energy.columns(first, loads));
    for (std::int64_t l = 0; l < loads; ++l)
        for (std::int64_t i = 0; i < works.rows() && whole[first + l] > 0; ++i)
            of_loads_[i] = std::max(of_loads_[i], works(i, l) * works(i, l) / whole[first + l]);
}

std::int64_t AttachmentBasis::n_blocks() const {
    return power_.empty() ? 0 : *std::max_element(power_.begin(), power_.end());
}

bool AttachmentBasis::refine(AskedError asked, std::int64_t most, Watch watch) {
    vector<std::int64_t> some = unfinished(asked, most);
    if (some.empty()) return false;
    further_.reserve(further_.cols() + powers_missing(asked, most));
    frontier_.reserve(frontier_.cols() + static_cast<std::int64_t>(some.size()));
    for (; !some.empty(); some = unfinished(asked, most)) {
        watch.step("contact space", 0.5);
        some.resize(std::min<std::size_t>(some.size(), solved_at_once));
        begin(some);
        advance(some);
    }
    rayleigh_ritz();
    return true;
}

bool AttachmentBasis::is_finished(std::size_t i, std::int64_t power, AskedError asked,
                                  std::int64_t most) const {
    const double rest = left(i, power);
    return power >= most || (rest <= asked.contact && of_loads_[i] * rest <= asked.loads);
}

double AttachmentBasis::left(std::size_t i, std::int64_t power) const {
    return std::pow(share_[i], 2.0 * static_cast<double>(power));
}

AskedError AttachmentBasis::left_after(AskedError asked, std::int64_t most) const {
    AskedError sum{0, 0};
    for (std::size_t i = 0; i < share_.size(); ++i) {
        std::int64_t power = power_[i];
        while (!is_finished(i, power, asked, most)) ++power;
        sum.contact += left(i, power);
        sum.loads += of_loads_[i] * left(i, power);
    }
    return sum;
}

vector<std::int64_t> AttachmentBasis::unfinished(AskedError asked, std::int64_t most) const {
    vector<std::int64_t> found;
    for (std::size_t i = 0; i < share_.size(); ++i)
        if (!is_finished(i, power_[i], asked, most)) found.push_back(static_cast<std::int64_t>(i));
    return found;
}

std::int64_t AttachmentBasis::powers_missing(AskedError asked, std::int64_t most) const {
    std::int64_t count = 0;
    for (std::size_t i = 0; i < share_.size(); ++i)
        for (std::int64_t power = power_[i]; !is_finished(i, power, asked, most); ++power) ++count;
    return count;
}

// The second powers of directions that have none yet.
void AttachmentBasis::begin(const vector<std::int64_t> &directions) {
    vector<std::int64_t> fresh;
    for (std::int64_t i : directions)
        if (at_[i] < 0) {
            at_[i] = frontier_.cols() + static_cast<std::int64_t>(fresh.size());
            fresh.push_back(i);
        }
    if (fresh.empty()) return;
    Field x = forces_.combine(chosen_columns(slow_, fresh));
    responses_->modes->take_from_forces(x);
    respond_outside(*structure_, *responses_->modes, x);
    x = structure_->mass_times(x);
    frontier_.append(next_power(std::move(x)));
}

void AttachmentBasis::advance(const vector<std::int64_t> &directions) {
    vector<std::int64_t> columns;
    for (std::int64_t i : directions) columns.push_back(at_[i]);
    const Field next = append_with_coupling(frontier_.columns(columns));
    for (std::size_t k = 0; k < columns.size(); ++k) {
        frontier_.put(columns[k], next.columns(static_cast<std::int64_t>(k), 1));
        ++power_[directions[k]];
    }
}

// Returns the next power.
Field AttachmentBasis::append_with_coupling(const Field &y) {
    Field next = next_power(appended(y));
    Matrix coupling = forces_.products(next);
    for (std::int64_t k = 0; k < coupling.rows() * coupling.cols(); ++k) coupling.data()[k] /= reach_;
    coupling_.append(coupling);
    return next;
}

Field AttachmentBasis::add_responses(Field forces, double least) {
    responses_->modes->take_from_forces(forces);
    Field y = forces;
    respond_outside(*structure_, *responses_->modes, y);
    const SymmetricEigen e = symmetric_eigen(gram(forces, y)); // ascending
    const std::int64_t n = y.cols(),
                       left = std::upper_bound(e.values.begin(), e.values.end(), least) - e.values.begin();
    y = plm::combine(y, e.vectors.columns(left, n - left));
    vector<double> scale;
    for (std::int64_t j = left; j < n; ++j) scale.push_back(1 / std::sqrt(std::max(1.0, e.values[j])));
    y.scale(scale); // dampers that hold like a support
    if (y.cols() > 0) {
        append_with_coupling(y);
        rayleigh_ritz();
    }
    return y;
}

// reach A^-1 times momenta M Y: of the order of Y where that is slow.
Field AttachmentBasis::next_power(Field momenta) const {
    momenta.scale(vector<double>(momenta.cols(), reach_));
    respond_outside(*structure_, *responses_->modes, momenta);
    return momenta;
}

// Returns the momenta M Y. Blocks this wide are what set-up needs most memory for: none lives longer than it
// is used.
Field AttachmentBasis::appended(const Field &y) {
    works_.append(forces_.products(y));
    {
        const Field stiff = structure_->shifted_times(y);
        energy_ = bordered(energy_, gram(further_, stiff), gram(y, stiff));
    }
    Field momenta = structure_->mass_times(y);
    further_inertia_ = bordered(further_inertia_, gram(further_, momenta), gram(y, momenta));
    further_.append(y);
    return momenta;
}

// Y less what the responses have of it, made A-orthonormal; then the eigenvectors of M in all of it.
void AttachmentBasis::rayleigh_ritz() {
    const std::int64_t n = orthonormal_.cols();
    const Matrix shared = product('T', 'N', orthonormal_, works_); // C = (X T)^T A Y
    Matrix rest = energy_;
    if (rest.cols() > 0) gemm('T', 'N', -1.0, shared, shared, 1.0, rest);
    const Matrix d = unit_energy(rest, negligible), cd = product('N', 'N', shared, d);
    of_responses_ = orthonormal_;
    Matrix less = product('N', 'N', orthonormal_, cd);
    for (std::int64_t k = 0; k < less.rows() * less.cols(); ++k) less.data()[k] *= -1;
    of_responses_.append(less);
    of_further_ = Matrix(further_.cols(), n);
    of_further_.append(d);
    const Matrix inertia = bordered(inertia_, product('T', 'N', orthonormal_, coupling_), further_inertia_);
    Matrix orthogonal(n + further_.cols(), n + d.cols()); // [1 -C D; 0 D]
    for (std::int64_t j = 0; j < n; ++j) orthogonal(j, j) = 1;
    for (std::int64_t j = 0; j < d.cols(); ++j) {
        for (std::int64_t i = 0; i < n; ++i) orthogonal(i, n + j) = -cd(i, j);
        std::copy_n(d.col(j), d.rows(), orthogonal.col(n + j) + n);
    }
    ritz_ = by_inertia(congruence(orthogonal, inertia));
}

Matrix AttachmentBasis::works() const {
    Matrix w = product('N', 'N', responses_->energy, of_responses_);
    gemm('N', 'N', 1.0, works_, of_further_, 1.0, w);
    return w;
}

Field AttachmentBasis::combine(const Matrix &y) const {
    Field x = forces_.combine(product('N', 'N', of_responses_, y));
    responses_->modes->take_from_forces(x);
    respond_outside(*structure_, *responses_->modes, x);
    add_combination(1.0, further_, product('N', 'N', of_further_, y), x);
    return x;
}

Matrix AttachmentBasis::products(const Field &forces, const Field &response) const {
    Matrix p = product('T', 'N', of_responses_, forces_.products(response));
    gemm('T', 'N', 1.0, of_further_, gram(further_, forces), 1.0, p);
    return p;
}

} // namespace plm
