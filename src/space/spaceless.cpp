#include "space/spaceless.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <utility>

namespace plm {
namespace {

// A space of a smaller structure takes a tenth of a second.
constexpr std::int64_t large = 10000;
// A search for modes takes some three solutions a mode, a space two or three a pair.
constexpr std::int64_t pairs_per_mode = 4;
// Of sixteen.
constexpr double digits_to_lose = 4;
// Pairs whose state is not the factorization's: each takes a solution, and a place for it.
constexpr std::size_t most_changed = 64;

} // namespace

// Newton's method on the whole structure. The springs of the present contact set differ in few pairs from
// those factored: (K + B'S B + B_D' delta B_D)^-1 with a small matrix, else they are factored.
class Spaceless::Equations final : public RestEquations {
  public:
    explicit Equations(Spaceless &owner)
        : owner_(owner), model_(*owner.model_), contact_(model_.rest_forces().without_them(model_.contact())),
          load_(load()), q_(model_.zeros(1)), d_(model_.zeros(1)) {}

    vector<double> penetration() const override {
        vector<double> u(static_cast<std::size_t>(model_.n_pairs()));
        model_.gap_rows().of(q_, u);
        const vector<double> apart = contact_.unloaded_penetration();
        for (std::size_t i = 0; i < u.size(); ++i) u[i] += apart[i];
        return u;
    }

    vector<double> terms() const override {
        const Matrix terms = model_.gap_rows().terms_of(q_);
        return vector<double>(terms.data(), terms.data() + terms.rows());
    }

    Step step(const vector<double> &u) override {
        Field elastic = model_.stiffness_times(q_);
        add(-1, load_, elastic);
        const vector<double> forces = contact_.forces(u);
        Matrix n(static_cast<std::int64_t>(u.size()), 1);
        std::copy(forces.begin(), forces.end(), n.data());
        d_ = model_.gap_rows().forces(n);
        add(1, elastic, d_);
        d_.scale({-1.0});
        take(springs_at(u));
        solve(d_);
        Step step{vector<double>(u.size()), column_products(d_, elastic)[0],
                  column_products(d_, model_.stiffness_times(d_))[0], false};
        model_.gap_rows().of(d_, step.gaps);
        return step;
    }

    void move(double part) override { add(part, d_, q_); }

    const Field &displacement() const { return q_; }
    const Contact &contact() const { return contact_; }

  private:
    Field load() const {
        const vector<double> given = model_.rest_forces().loads(model_.n_pairs());
        Matrix n(model_.n_pairs(), 1);
        for (std::int64_t i = 0; i < model_.n_pairs(); ++i) n(i, 0) = -given[i];
        Field load = model_.gap_rows().forces(n);
        if (model_.has_preload()) add(1, model_.preload(), load);
        return load;
    }

    // At first those that touch are closed, too: most pairs of joints that are pressed together end so.
    vector<double> springs_at(const vector<double> &u) {
        vector<double> springs = contact_.tangents(u);
        if (!std::exchange(begun_, true))
            for (std::size_t i = 0; i < u.size(); ++i)
                if (u[i] == 0) springs[i] = model_.contact_stiffness()[i];
        return springs;
    }

    void take(const vector<double> &springs) {
        changed_.clear();
        for (std::size_t i = 0; i < springs.size(); ++i)
            if (owner_.factored_.empty() || springs[i] != owner_.factored_[i]) changed_.push_back(i);
        if (owner_.factored_.empty() || changed_.size() > most_changed) {
            owner_.watch_.step("rest", 0.3);
            known_.clear();
            answers_ = Field();
            changed_.clear();
            owner_.factor(springs);
        }
        vector<std::size_t> unknown;
        for (std::size_t i : changed_)
            if (std::find(known_.begin(), known_.end(), i) == known_.end()) unknown.push_back(i);
        if (!unknown.empty()) answer(unknown);
        delta_.clear();
        for (std::size_t i : changed_) delta_.push_back(springs[i] - owner_.factored_[i]);
    }

    // Of the factored structure to a unit force of each of the pairs.
    void answer(const vector<std::size_t> &pairs) {
        Matrix unit(model_.n_pairs(), static_cast<std::int64_t>(pairs.size()));
        for (std::size_t j = 0; j < pairs.size(); ++j)
            unit(static_cast<std::int64_t>(pairs[j]), static_cast<std::int64_t>(j)) = 1;
        Field x = model_.gap_rows().forces(unit);
        owner_.sprung_.solve(x);
        if (known_.empty())
            answers_ = std::move(x);
        else
            answers_.append(x);
        known_.insert(known_.end(), pairs.begin(), pairs.end());
    }

    void solve(Field &x) const {
        owner_.sprung_.solve(x);
        if (changed_.empty()) return;
        const auto n = static_cast<std::int64_t>(changed_.size());
        const Matrix all = model_.gap_rows().of(answers_);
        vector<double> u(static_cast<std::size_t>(model_.n_pairs()));
        model_.gap_rows().of(x, u);
        Matrix small(n, n);
        vector<double> forces(changed_.size());
        vector<std::int64_t> column(changed_.size());
        for (std::size_t j = 0; j < changed_.size(); ++j) {
            column[j] = std::find(known_.begin(), known_.end(), changed_[j]) - known_.begin();
            forces[j] = u[changed_[j]];
        }
        for (std::int64_t j = 0; j < n; ++j) {
            for (std::int64_t i = 0; i < n; ++i)
                small(i, j) = all(static_cast<std::int64_t>(changed_[i]), column[j]);
            small(j, j) += 1 / delta_[j];
        }
        RealLu lu;
        lu.factor(small);
        lu.solve(forces.data(), 1, n);
        vector<double> y(known_.size(), 0.0);
        for (std::size_t j = 0; j < changed_.size(); ++j) y[static_cast<std::size_t>(column[j])] = forces[j];
        add_combination(-1, answers_, y, x);
    }

    Spaceless &owner_;
    const Model &model_;
    const Contact contact_; // without the pairs whose forces are given, which are among the loads
    const Field load_;
    Field q_, d_;
    bool begun_ = false;
    vector<std::size_t> changed_; // pairs whose springs differ from the factored ones,
    vector<double> delta_;        // by so much
    vector<std::size_t> known_;   // pairs of which the answers are known
    Field answers_;
};

Spaceless::Spaceless(std::shared_ptr<const Model> model, Watch watch)
    : model_(std::move(model)), watch_(watch), sprung_(*model_) {}

Spaceless::~Spaceless() = default;

std::unique_ptr<Spaceless> Spaceless::if_worth(std::shared_ptr<const Model> model, std::int64_t n_modes,
                                               Watch watch) {
    const Model &m = *model;
    if (m.n_free() < large || m.n_pairs() < pairs_per_mode * n_modes || m.shift() > 0 ||
        m.space_options().memory_limit > 0 || m.space_options().precision == PrecisionChoice::single)
        return nullptr;
    std::unique_ptr<Spaceless> without(new Spaceless(std::move(model), watch));
    if (without->sprung_.digits_lost(m.contact_stiffness()) > digits_to_lose) return nullptr;
    return without;
}

std::shared_ptr<const RestState> Spaceless::rest() {
    auto rest = std::make_shared<RestState>();
    rest->penetration = model_->contact().unloaded_penetration();
    rest->displacement = model_->zeros(1);
    if (is_loaded_at_rest(*model_)) {
        watch_.step("rest", 0.0);
        Equations equations(*this);
        rest->iterations = find_rest(equations, equations.contact(), rest->penetration);
        rest->displacement = equations.displacement();
    }
    rest->put_forces(*model_);
    return rest;
}

void Spaceless::factor(const vector<double> &springs) {
    factored_.clear(); // should this fail
    sprung_.factor(springs);
    factored_ = springs;
}

StructureModes Spaceless::modes(const PairStates &states, std::int64_t n) {
    ModeSearch search;
    search.cancelled = [this] { return watch_.cancelled("modes", 0.5); };
    const vector<double> springs = model_->contact().springs(states);
    if (std::count(springs.begin(), springs.end(), 0.0) == model_->n_pairs())
        return model_->lowest_modes(n, search);
    if (springs != factored_) {
        watch_.step("modes", 0.0);
        factor(springs);
    }
    watch_.step("modes", 0.3);
    return sprung_.lowest_modes(n, search);
}

std::shared_ptr<const RestState> rest_of(const std::shared_ptr<const Model> &model, Watch watch) {
    if (const auto without = Spaceless::if_worth(model, 1, watch)) return without->rest();
    return rest_of(*make_contact_space(model, 0.0, 1, watch));
}

} // namespace plm
