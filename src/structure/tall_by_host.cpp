// The structure's matrices and factors where the host keeps them: what tall.hpp asks for, in its operations.
#include "linalg/blas_lapack.hpp"
#include "linalg/error.hpp"
#include "structure/field.hpp"
#include "structure/solver/factor.hpp"
#include "structure/sparse.hpp"
#include "structure/tall_block_by_host.hpp"
#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <set>

namespace plm {
namespace {

namespace op = tall_operation;
using Numbers = TallOperations::Numbers;

/// What all matrices of a structure share.
struct Origin {
    std::shared_ptr<TallOperations> host;
    std::int64_t n = 0;
    TallFacts facts;
    TallScales scales;
    bool has_damping = false;
};

struct Weights {
    double m = 0, k = 0, c = 0;
    vector<double> list() const { return {m, k, c}; }
};

/// Entries added to a sum of the host's matrices: the lower triangle.
struct AddedEntries {
    vector<std::int64_t> row, column;
    vector<double> value;
    bool empty() const { return row.empty(); }
    vector<std::int64_t> dofs() const {
        std::set<std::int64_t> all(row.begin(), row.end());
        all.insert(column.begin(), column.end());
        return vector<std::int64_t>(all.begin(), all.end());
    }
    void append(double factor, const AddedEntries &other) {
        row.insert(row.end(), other.row.begin(), other.row.end());
        column.insert(column.end(), other.column.begin(), other.column.end());
        for (double v : other.value) value.push_back(factor * v);
    }
    /// As a matrix over dofs().
    SparseMatrix matrix() const {
        const vector<std::int64_t> all = dofs();
        const auto place = [&](std::int64_t dof) {
            return std::lower_bound(all.begin(), all.end(), dof) - all.begin();
        };
        vector<std::int64_t> i, j;
        vector<double> v;
        for (std::size_t e = 0; e < row.size(); ++e) {
            i.push_back(place(row[e])), j.push_back(place(column[e])), v.push_back(value[e]);
            if (row[e] == column[e]) continue;
            i.push_back(j[i.size() - 1]), j.push_back(place(row[e])), v.push_back(value[e]);
        }
        const auto n = static_cast<std::int64_t>(all.size());
        return from_triplets(n, n, i, j, v);
    }
};

const HostBlock &host_block(const Field &x) {
    return HostBlock::of(x.block());
}

class FactorByHost final : public TallFactor {
  public:
    FactorByHost(std::shared_ptr<const Origin> origin, const Weights &weights,
                 const vector<std::int64_t> &held, const AddedEntries &added, bool to_count)
        : origin_(std::move(origin)), handle_(origin_->host->new_handle()) {
        Numbers number{handle_, to_count, static_cast<std::int64_t>(held.size()),
                       static_cast<std::int64_t>(added.row.size())};
        for (const vector<std::int64_t> *list : {&held, &added.row, &added.column})
            number.insert(number.end(), list->begin(), list->end());
        try {
            origin_->host->run(op::factor, number, weights.list(), added.value.data(), told_);
            refuse_breakdown();
        } catch (...) { // the destructor does not run
            origin_->host->drop(handle_);
            throw;
        }
    }
    ~FactorByHost() override { origin_->host->drop(handle_); }
    FactorByHost(const FactorByHost &) = delete;

    std::int64_t negative() const { return static_cast<std::int64_t>(told_[0]); }
    void solve(Field &x) const override {
        if (x.cols() == 0) return;
        origin_->host->run(op::solve, {handle_, host_block(x).handle(), 0, x.cols()});
        if (!x.is_finite())
            throw Error(status::callback, "the host's tall operation SOLVE returned NaN or Inf");
    }
    double reciprocal_condition() const override { return told_[1]; }
    std::int64_t factor_nonzeros() const override { return static_cast<std::int64_t>(told_[2]); }
    bool calls_host() const override { return true; }
    bool multiply_responses(const SparseMatrix &b, const Field &loads, const TallMatrix &, Matrix &energy,
                            Matrix &inertia) const override {
        const std::int64_t t = b.rows + loads.cols();
        if (t == 0) return false;
        Numbers number{handle_, loads.cols() > 0 ? host_block(loads).handle() : 0, 0, loads.cols(), b.rows,
                       b.nnz()};
        for (std::int64_t j = 0; j < b.cols; ++j) number.insert(number.end(), b.ptr[j + 1] - b.ptr[j], j);
        number.insert(number.end(), b.idx.begin(), b.idx.end());
        vector<double> out(static_cast<std::size_t>(1 + 2 * t * t), 0.0);
        origin_->host->run(op::responses, number, {}, b.val.data(), out.data());
        if (out[0] != 1) return false;
        energy.reset(t, t), inertia.reset(t, t);
        std::copy_n(out.data() + 1, t * t, energy.data());
        std::copy_n(out.data() + 1 + t * t, t * t, inertia.data());
        return true;
    }

  private:
    void refuse_breakdown() const {
        if (told_[3] == 0) return;
        const auto dof = static_cast<std::int64_t>(told_[4]);
        if (told_[3] == 1) throw_not_positive_definite(dof);
        throw_singular(dof);
    }

    std::shared_ptr<const Origin> origin_;
    std::int64_t handle_;
    double told_[8] = {};
};

class HostMatrix;

class HostProducts final : public PairProducts {
  public:
    HostProducts(const HostMatrix &k, const Field &x);
    double energy(std::int64_t j) const override { return energies_(0, j); }
    double precise_energy(std::int64_t j) const override { return energies_(0, j); }
    double terms(std::int64_t j) const override { return energies_(1, j); }
    double residual(std::int64_t j, double lambda, const Field &mx, double rounding) const override;

  private:
    const HostMatrix &k_;
    const Field &x_;
    Matrix energies_;
    Field kx_; // where something is held or added: the host's residual knows of neither
};

class HostMatrix final : public TallMatrix {
  public:
    HostMatrix(std::shared_ptr<const Origin> origin, const Weights &weights,
               std::shared_ptr<const vector<std::int64_t>> held, AddedEntries added = {})
        : origin_(std::move(origin)), w_(weights), held_(std::move(held)), added_(std::move(added)),
          none_(std::make_unique<HostBlock>(origin_->host, origin_->n)) {}

    const Origin &origin() const { return *origin_; }
    bool is_stiffness_alone() const {
        return w_.m == 0 && w_.k == 1 && w_.c == 0 && held_->empty() && added_.empty();
    }
    std::int64_t rows() const override { return origin_->n; }
    Field none() const override { return none_; }

    Field times(const Field &x) const override {
        std::unique_ptr<HostBlock> y = host_block(none_).fresh();
        if (x.cols() > 0)
            origin_->host->run(op::apply, {y->handle(), 0, host_block(x).handle(), 0, x.cols()}, w_.list());
        y->set_cols(x.cols());
        if (!held_->empty()) y->zero_rows(*held_);
        Field product(std::move(y));
        if (added_.empty() || x.cols() == 0) return product;
        const vector<std::int64_t> dofs = added_.dofs();
        const Matrix forces = multiply(added_.matrix(), x.rows_at(dofs));
        std::vector<DofTerms> sums(static_cast<std::size_t>(x.cols()));
        for (std::int64_t j = 0; j < x.cols(); ++j)
            for (std::size_t i = 0; i < dofs.size(); ++i)
                sums[j].push_back({dofs[i], forces(static_cast<std::int64_t>(i), j)});
        product.block().add_sums(sums);
        return product;
    }
    void times(const Field &x, Field &y) const override { y = times(x); }

    std::unique_ptr<TallMatrix> plus(double factor, const TallMatrix &other) const override {
        const auto &b = static_cast<const HostMatrix &>(other);
        AddedEntries added = added_;
        added.append(factor, b.added_);
        return std::make_unique<HostMatrix>(
            origin_, Weights{w_.m + factor * b.w_.m, w_.k + factor * b.w_.k, w_.c + factor * b.w_.c}, held_,
            std::move(added));
    }
    std::unique_ptr<TallMatrix> scaled(double factor) const override {
        AddedEntries added;
        added.append(factor, added_);
        return std::make_unique<HostMatrix>(origin_, Weights{factor * w_.m, factor * w_.k, factor * w_.c},
                                            held_, std::move(added));
    }
    std::unique_ptr<TallMatrix> with_springs(const std::vector<DofTerms> &rows,
                                             const vector<double> &spring) const override {
        AddedEntries added = added_;
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (const DofTerm &a : rows[i])
                for (const DofTerm &b : rows[i]) {
                    if (a.dof < b.dof) continue;
                    added.row.push_back(a.dof), added.column.push_back(b.dof);
                    added.value.push_back(spring[i] * a.coefficient * b.coefficient);
                }
        return std::make_unique<HostMatrix>(origin_, w_, held_, std::move(added));
    }
    std::unique_ptr<TallFactor> factor(const Solver &) const override {
        return std::make_unique<FactorByHost>(origin_, w_, *held_, added_, false);
    }
    std::int64_t count_negative(double factor, const TallMatrix &other, const Solver &) const override {
        const std::unique_ptr<TallMatrix> sum = plus(factor, other);
        const auto &s = static_cast<const HostMatrix &>(*sum);
        return FactorByHost(origin_, s.w_, *held_, s.added_, true).negative();
    }
    vector<double> diagonal_at(const vector<std::int64_t> &dofs) const override {
        vector<double> some(dofs.size(), 0.0);
        if (dofs.empty()) return some;
        Numbers number{static_cast<std::int64_t>(dofs.size())};
        number.insert(number.end(), dofs.begin(), dofs.end());
        origin_->host->run(op::diagonal, number, w_.list(), nullptr, some.data());
        for (std::size_t i = 0; i < dofs.size(); ++i)
            for (std::size_t e = 0; e < added_.row.size(); ++e)
                if (added_.row[e] == dofs[i] && added_.column[e] == dofs[i]) some[i] += added_.value[e];
        return some;
    }
    // Asked of the mass alone: the host told how many have any, and those held are few.
    std::int64_t n_positive() const override {
        std::int64_t count = origin_->facts.n_massive;
        for (double m : diagonal_at(*held_)) count -= m > 0;
        return count;
    }
    Energy energy(const Field &x, std::int64_t column) const override {
        const Matrix both = energies(x.columns(column, 1));
        return {both(0, 0), both(1, 0)};
    }
    /// x' A x and its terms, for all columns.
    Matrix energies(const Field &x) const {
        Matrix both(2, x.cols());
        if (x.cols() == 0) return both;
        origin_->host->run(op::energy, {host_block(x).handle(), 0, x.cols()}, w_.list(), nullptr,
                           both.data());
        if (added_.empty()) return both;
        const vector<std::int64_t> dofs = added_.dofs();
        const SparseMatrix a = added_.matrix();
        const Matrix motion = x.rows_at(dofs);
        for (std::int64_t j = 0; j < x.cols(); ++j) {
            const Energy more = plm::energy(a, motion.col(j));
            both(0, j) += more.sum, both(1, j) += more.terms;
        }
        return both;
    }
    std::unique_ptr<PairProducts> products(const Field &x) const override {
        return std::make_unique<HostProducts>(*this, x);
    }
    void require_finite_entries(const char *) const override {} // they are the host's
    const SparseMatrix &entries() const override;

  private:
    std::shared_ptr<const Origin> origin_;
    Weights w_;
    std::shared_ptr<const vector<std::int64_t>> held_;
    AddedEntries added_;
    Field none_;
    mutable std::mutex reading_;
    mutable std::optional<SparseMatrix> entries_; // once they were asked for
};

// Column by column: of small structures, which are solved densely.
const SparseMatrix &HostMatrix::entries() const {
    constexpr std::int64_t most = 2000;
    const std::int64_t n = rows();
    if (n > most)
        throw Error(status::eigensolver,
                    format("as many modes as nearly all that there are, or of few DOFs with mass, are found "
                           "from the entries of the matrices, which the host keeps behind its tall "
                           "operations: of at most %lld DOFs, where the model has %lld; ask for fewer modes, "
                           "or hand the matrices over",
                           static_cast<long long>(most), static_cast<long long>(n)));
    const std::lock_guard<std::mutex> lock(reading_);
    if (entries_) return *entries_;
    vector<std::int64_t> i, j;
    vector<double> v;
    for (std::int64_t dof = 0; dof < n; ++dof) {
        const vector<double> column = times(none_.sums({{{dof, 1.0}}})).column(0);
        for (std::int64_t row = 0; row < n; ++row)
            if (column[row] != 0) i.push_back(row), j.push_back(dof), v.push_back(column[row]);
    }
    entries_ = from_triplets(n, n, i, j, v);
    return *entries_;
}

HostProducts::HostProducts(const HostMatrix &k, const Field &x) : k_(k), x_(x), energies_(k.energies(x)) {
    if (!k.is_stiffness_alone()) kx_ = k.times(x);
}

double HostProducts::residual(std::int64_t j, double lambda, const Field &mx, double rounding) const {
    double norm = 0;
    if (k_.is_stiffness_alone()) {
        k_.origin().host->run(op::residual, {host_block(x_).handle(), j, host_block(mx).handle(), j, 1},
                              {rounding}, &lambda, &norm);
    } else {
        Field rest = kx_.columns(j, 1);
        add(-lambda, mx.columns(j, 1), rest);
        norm = column_norms(rest)[0];
    }
    return std::isfinite(norm) ? norm : INFINITY;
}

class HostHeld final : public HeldTall {
  public:
    HostHeld(const std::shared_ptr<const Origin> &origin, const vector<std::int64_t> &dofs)
        : dofs_(std::make_shared<const vector<std::int64_t>>(dofs)), mass_(origin, {1, 0, 0}, dofs_),
          stiffness_(origin, {0, 1, 0}, dofs_),
          whole_(origin, {0, 1, 0}, std::make_shared<const vector<std::int64_t>>()),
          n_interior_(origin->facts.n_dof - static_cast<std::int64_t>(dofs.size())) {}
    std::int64_t n_interior() const override { return n_interior_; }
    const TallMatrix &mass() const override { return mass_; }
    const TallMatrix &stiffness() const override { return stiffness_; }
    Field driving_forces(std::int64_t first, std::int64_t count) const override {
        std::vector<DofTerms> units;
        for (std::int64_t j = first; j < first + count; ++j) units.push_back({{(*dofs_)[j], -1.0}});
        return inside(whole_.times(whole_.none().sums(units)));
    }
    // Over all DOFs as well, zero at those that are held.
    Field on_all_dofs(const Field &interior) const override { return interior; }
    Field inside(const Field &all) const override {
        Field x = all;
        static_cast<HostBlock &>(x.block()).zero_rows(*dofs_);
        return x;
    }

  private:
    std::shared_ptr<const vector<std::int64_t>> dofs_;
    HostMatrix mass_, stiffness_, whole_;
    std::int64_t n_interior_;
};

class HostTall final : public Tall {
  public:
    explicit HostTall(std::shared_ptr<const Origin> origin)
        : origin_(std::move(origin)), none_held_(std::make_shared<const vector<std::int64_t>>()),
          mass_(origin_, {1, 0, 0}, none_held_), stiffness_(origin_, {0, 1, 0}, none_held_),
          damping_(origin_, {0, 0, 1}, none_held_) {}
    const TallMatrix &mass() const override { return mass_; }
    const TallMatrix &stiffness() const override { return stiffness_; }
    const TallMatrix *damping() const override { return origin_->has_damping ? &damping_ : nullptr; }
    TallFacts facts() const override { return origin_->facts; }
    std::unique_ptr<HeldTall> held(const vector<std::int64_t> &dofs) const override {
        return std::make_unique<HostHeld>(origin_, dofs);
    }
    const TallScales &scales() const { return origin_->scales; }

  private:
    std::shared_ptr<const Origin> origin_;
    std::shared_ptr<const vector<std::int64_t>> none_held_;
    HostMatrix mass_, stiffness_, damping_;
};

} // namespace

std::unique_ptr<Tall> tall_by_host(std::shared_ptr<TallOperations> operations, std::int64_t n_dof) {
    double told[16] = {};
    operations->run(op::facts, {}, {}, nullptr, told);
    for (double one : told)
        if (!std::isfinite(one))
            throw Error(status::callback, "the host's tall operation FACTS told NaN or Inf").argument("fn");
    if (!(told[0] >= 1 && told[0] <= static_cast<double>(n_dof) && told[1] <= told[0]))
        throw Error(status::callback,
                    format("the host's tall operation FACTS told %g DOFs, %g of them with mass, where the "
                           "model has %lld",
                           told[0], told[1], static_cast<long long>(n_dof)))
            .argument("fn");
    const auto number = [](double v) { return static_cast<std::int64_t>(v); };
    auto origin = std::make_shared<Origin>();
    origin->host = std::move(operations), origin->n = n_dof;
    TallFacts &f = origin->facts;
    f.n_dof = number(told[0]), f.n_massive = number(told[1]);
    f.trace_of_mass = told[2], f.trace_of_stiffness = told[3], f.least_stiffness = told[4];
    f.typical_eigenvalue = told[5] > 0 ? told[5] : told[3] / told[2];
    f.loose = number(told[6]), f.multiplier = number(told[7]), f.n_multipliers = number(told[8]);
    origin->has_damping = told[9] == 1;
    origin->scales = {told[10], told[11], told[12]};
    return std::make_unique<HostTall>(std::move(origin));
}

TallScales scales_of(const Tall &by_host) {
    return static_cast<const HostTall &>(by_host).scales();
}

} // namespace plm
