#include "orbits/modal_pieces.hpp"
#include "contact/polynomial.hpp"
#include "orbits/contact_set.hpp"
#include "orbits/load_powers.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm {
namespace {

constexpr double longest_turn = 3.0; // rad of a mode that a polynomial describes: 30 terms or so
constexpr double clear_of_zero = 3;  // times what the fast modes may add: a piece that gets somewhere
constexpr double truncation = 1e-17;
constexpr double most_growth = 100; // of an unstable mode in a piece, its logarithm: nothing overflows
constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double unnoticed = 1e-11; // of the motion: fast modes that a recorder is not told of

} // namespace

bool ModalPieces::enter(std::shared_ptr<const ContactModes> modes, const FlowState &state,
                        const FlowState &change) {
    modes_ = std::move(modes);
    puts_aside_ = model_.n_following() > 0 || model_.walls_move();
    now_ = state.time;
    const std::size_t size = static_cast<std::size_t>(modes_->size());
    vector<double> coordinates(size), changed;
    modes_->from_state(state.y.data(), state.v.data(), coordinates.data());
    if (parameter_ != FlowParameter::none) {
        changed.resize(size);
        modes_->from_state(change.y.data(), change.v.data(), changed.data());
    }
    if (begin(coordinates, changed)) return true;
    modes_ = nullptr;
    return false;
}

bool ModalPieces::pass(std::shared_ptr<const ContactModes> to, const vector<double> &transition) {
    const std::int64_t n = to->size(), columns = parameter_ != FlowParameter::none ? 2 : 1;
    both_ = at_now_;
    if (columns == 2) {
        const vector<double> changed = changed_now();
        both_.insert(both_.end(), changed.begin(), changed.end());
    }
    passed_.resize(static_cast<std::size_t>(n * columns));
    gemm('N', n, columns, n, 1.0, transition.data(), n, both_.data(), n, 0.0, passed_.data(), n);
    const double start = start_;
    modes_.swap(to);
    const auto second = passed_.begin() + static_cast<std::ptrdiff_t>(n);
    if (begin({passed_.begin(), second}, {second, passed_.end()})) return true;
    modes_.swap(to);
    start_ = start;
    set_steady();
    return false;
}

// Here and now.
bool ModalPieces::begin(const vector<double> &coordinates, const vector<double> &changed) {
    if (!set_steady()) return false;
    vector<double> steady, changed_steady;
    steady_at(now_, steady, changed.empty() ? nullptr : &changed_steady);
    start_ = now_;
    at_now_ = coordinates;
    free_ = coordinates;
    changed_free_ = changed;
    for (std::size_t i = 0; i < free_.size(); ++i) free_[i] -= steady[i];
    for (std::size_t i = 0; i < changed_free_.size(); ++i) changed_free_[i] -= changed_steady[i];
    present_ = free_;
    changed_unheld_.clear();
    if (!changed.empty())
        changed_unheld_.assign(changed.begin() + static_cast<std::ptrdiff_t>(modes_->first_free()),
                               changed.end());
    return true;
}

void ModalPieces::put_aside(Part part, double time, vector<double> &sum) const {
    sum = modes_->constant_load().*part;
    for (const ContactModes::Harmonic &load : modes_->loads()) {
        if (!puts_aside_) break;
        const Complex z = scale(load) * std::polar(1.0, load.frequency(omega_) * time);
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += z.real() * (load.real.*part)[i] - z.imag() * (load.imag.*part)[i];
    }
}

void ModalPieces::add_put_aside(Part part, Matrix &powers) const {
    const vector<double> &constant = modes_->constant_load().*part;
    const std::int64_t n = static_cast<std::int64_t>(constant.size()), first = powers.rows() - n;
    for (std::int64_t i = 0; i < n; ++i) powers(first + i, 0) += constant[i];
    for (const ContactModes::Harmonic &load : modes_->loads()) {
        if (!puts_aside_) break;
        const double w = load.frequency(omega_);
        Complex z = scale(load) * std::polar(1.0, w * now_);
        for (std::int64_t k = 0; k < powers.cols(); ++k) {
            for (std::int64_t i = 0; i < n; ++i)
                powers(first + i, k) += z.real() * (load.real.*part)[i] - z.imag() * (load.imag.*part)[i];
            if (load.part.harmonic == 0) break;
            z *= Complex(0, w * duration_ / static_cast<double>(k + 1));
        }
    }
}

// What the modes that a piece of this length does not resolve may add to the pairs.
void ModalPieces::veil(double duration, vector<double> &sum) const {
    std::fill(sum.begin(), sum.end(), 0.0);
    const Matrix &reach = modes_->reach();
    for (std::int64_t k = 0; k < reach.cols(); ++k) {
        const ContactModes::Mode &m = modes_->modes()[static_cast<std::size_t>(k)];
        if (m.speed * duration <= longest_turn) continue;
        const double grows = m.rate.real() > 0 ? std::exp(m.rate.real() * duration) : 1.0,
                     size = size_[static_cast<std::size_t>(k)] * grows, *row = reach.col(k);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += row[i] * size;
    }
}

bool ModalPieces::allows(double duration) {
    veil(duration, veil_);
    for (std::size_t i = 0; i < veil_.size(); ++i) {
        if (veil_[i] <= tiny_[i])
            veil_[i] = 0;
        else if (!(std::abs(now_penetration_[i]) > clear_of_zero * veil_[i]))
            return false;
    }
    return true;
}

// Of the penetrations now, and how large the free motion of each mode is.
void ModalPieces::sum_rounding() {
    const std::size_t z = static_cast<std::size_t>(modes_->gap_by_pair().cols());
    tiny_.resize(z);
    const double size = norm2(modes_->size(), at_now_.data());
    if (!std::isfinite(size)) // no duration would do
        throw Error(status::convergence, "the motion grows beyond all numbers").reason(reason::not_finite);
    put_aside(&ContactModes::Load::gap, now_, aside_);
    for (std::size_t i = 0; i < z; ++i) tiny_[i] = eps * (std::abs(aside_[i]) + modes_->gap_size()[i] * size);
    size_.clear();
    for (const ContactModes::Mode &m : modes_->modes()) {
        const double re = present_[m.first], im = m.is_pair ? present_[m.first + 1] : 0.0;
        size_.push_back(std::sqrt(re * re + im * im));
    }
}

double ModalPieces::expand(double longest) {
    sum_rounding();
    now_penetration_ = aside_;
    veil_.resize(tiny_.size());
    if (!tiny_.empty()) gemv('T', 1.0, modes_->gap_by_pair(), at_now_.data(), 1.0, now_penetration_.data());
    double duration = longest;
    for (const ContactModes::Mode &m : modes_->modes())
        if (m.rate.real() > 0) duration = std::min(duration, most_growth / m.rate.real());
    duration = std::min(duration, longest_turn / modes_->free_speed());
    while (!allows(duration)) duration *= 0.5; // at the end all modes are resolved
    duration_ = duration;
    fill_powers(duration);
    find_penetrations();
    return duration;
}

void ModalPieces::find_penetrations() {
    const std::int64_t z = modes_->gap_by_pair().cols();
    bound_travel();
    aside_powers_.reset(z, puts_aside_ ? n_terms_ : 1);
    add_put_aside(&ContactModes::Load::gap, aside_powers_);
    penetrations_.expand(now_penetration_, travel_, modes_->gap_by_pair(), 'T', powers_, aside_powers_);
    penetrations_.draw_near(veil_);
}

// By how far each mode may move its coordinates: |exp(rate t) - 1| and |exp(iht) - 1| of their sizes.
void ModalPieces::bound_travel() {
    constexpr double rounding = 1e3; // of the sums, in tiny_
    travel_ = veil_;
    for (std::size_t i = 0; i < travel_.size(); ++i) travel_[i] += rounding * tiny_[i];
    const Matrix &reach = modes_->reach();
    const auto turned = [&](double speed) { return std::min(2.0, speed * duration_); };
    for (std::int64_t k = 0; k < reach.cols(); ++k) {
        const ContactModes::Mode &m = modes_->modes()[static_cast<std::size_t>(k)];
        const double grows = m.rate.real() > 0 ? std::exp(m.rate.real() * duration_) : 1.0;
        double way = size_[static_cast<std::size_t>(k)] * grows * turned(m.speed);
        for (std::size_t l = 0; l < steady_.size(); ++l)
            if (!steady_[l].empty())
                way += std::abs(scale(modes_->loads()[l])) * steady_[l][static_cast<std::size_t>(k)].size *
                       turned(modes_->loads()[l].frequency(omega_));
        const double *row = reach.col(k);
        for (std::size_t i = 0; i < travel_.size(); ++i) travel_[i] += row[i] * way;
    }
    for (std::int64_t k = 0; k < unheld_powers_.rows(); ++k) {
        double way = 0;
        for (std::int64_t j = 1; j < n_terms_; ++j) way += std::abs(unheld_powers_(k, j));
        for (std::size_t i = 0; i < travel_.size(); ++i)
            travel_[i] +=
                way * std::abs(modes_->gap_by_pair()(modes_->first_free() + k, static_cast<std::int64_t>(i)));
    }
    for (const ContactModes::Harmonic &load : modes_->loads())
        for (std::size_t i = 0; puts_aside_ && i < travel_.size(); ++i)
            travel_[i] += std::abs(scale(load)) * turned(load.frequency(omega_)) *
                          (std::abs(load.real.gap[i]) + std::abs(load.imag.gap[i]));
}

// Coordinates as powers of s: the free motion of the modes that are resolved, and all that is steady.
void ModalPieces::fill_powers(double duration) {
    double turn = 0;
    for (const ContactModes::Mode &m : modes_->modes())
        if (m.speed * duration <= longest_turn) turn = std::max(turn, m.speed * duration);
    for (const ContactModes::Harmonic &load : modes_->loads())
        turn = std::max(turn, load.frequency(omega_) * duration);
    turn = std::max(turn, modes_->free_speed() * duration);
    const std::int64_t more =
        modes_->free_block().rows() > 0 ? 5 : 3; // by a load, a free motion is two powers on
    n_terms_ = std::min(taylor_terms(turn, truncation) + more, max_polynomial_degree + 1);
    powers_.reset(modes_->size(), n_terms_);
    while (static_cast<std::int64_t>(inverse_.size()) < n_terms_)
        inverse_.push_back(1 / static_cast<double>(inverse_.size() + 1));
    for (std::int64_t j = 0; j < powers_.rows(); ++j) powers_(j, 0) = constant_[j];
    add_free_powers(duration);
    for (std::size_t l = 0; l < steady_.size(); ++l)
        if (!steady_[l].empty()) add_steady_powers(l, duration);
    expand_free(at_now_.data() + modes_->first_free(), false, duration, unheld_powers_);
    for (std::int64_t k = 0; k < n_terms_; ++k)
        std::copy_n(unheld_powers_.col(k), unheld_powers_.rows(), powers_.col(k) + modes_->first_free());
}

void ModalPieces::expand_free(const double *from, bool changed, double duration, Matrix &powers) const {
    const Matrix &block = modes_->free_block();
    const std::int64_t n = block.rows(), first = modes_->first_free();
    Matrix load(n, n_terms_);
    if (!changed) std::copy_n(modes_->constant_load().coordinates.data() + first, n, load.col(0));
    for (const ContactModes::Harmonic &of : modes_->loads()) {
        const vector<Complex> z =
            changed ? changed_load_powers(parameter_, of.part, omega_, force_scale_, now_, duration, n_terms_)
                    : load_powers(of.part, omega_, force_scale_, now_, duration, n_terms_);
        for (std::size_t k = 0; k < z.size(); ++k)
            for (std::int64_t i = 0; i < n; ++i)
                load(i, static_cast<std::int64_t>(k)) += z[k].real() * of.real.coordinates[first + i] -
                                                         z[k].imag() * of.imag.coordinates[first + i];
    }
    powers.reset(n, n_terms_);
    std::copy_n(from, n, powers.col(0));
    for (std::int64_t k = 0; k + 1 < n_terms_ && n > 0; ++k) {
        const double part = duration / static_cast<double>(k + 1);
        for (std::int64_t i = 0; i < n; ++i) powers(i, k + 1) = part * load(i, k);
        gemv('N', part, block, powers.col(k), 1.0, powers.col(k + 1));
    }
}

// z (rate duration)^k / k! of all modes that are resolved, power by power: what is done to one is done to its
// neighbours at once.
void ModalPieces::add_free_powers(double duration) {
    first_.clear();
    for (vector<double> *v : {&re_, &im_, &turn_re_, &turn_im_}) v->clear();
    for (const ContactModes::Mode &m : modes_->modes()) {
        if (m.speed * duration > longest_turn) continue;
        first_.push_back(m.first);
        re_.push_back(present_[m.first]);
        im_.push_back(m.is_pair ? present_[m.first + 1] : 0.0);
        turn_re_.push_back(m.rate.real() * duration);
        turn_im_.push_back(m.rate.imag() * duration);
    }
    const std::size_t n = first_.size();
    double *re = re_.data(), *im = im_.data();
    const double *a = turn_re_.data(), *b = turn_im_.data();
    for (std::int64_t k = 0; k < n_terms_; ++k) {
        double *power = powers_.col(k);
        for (std::size_t i = 0; i < n; ++i) {
            power[first_[i]] += re[i];
            if (b[i] != 0) power[first_[i] + 1] += im[i];
        }
        const double part = inverse_[static_cast<std::size_t>(k)];
        for (std::size_t i = 0; i < n; ++i) {
            const double turned = (re[i] * a[i] - im[i] * b[i]) * part;
            im[i] = (re[i] * b[i] + im[i] * a[i]) * part;
            re[i] = turned;
        }
    }
}

const Matrix &ModalPieces::coefficient() {
    coefficient_ = product('N', 'N', modes_->displacement(), powers_);
    add_put_aside(&ContactModes::Load::following, coefficient_);
    keep_fast();
    return coefficient_;
}

void ModalPieces::keep_fast() {
    fast_.rate.clear();
    const Matrix &rows = modes_->displacement();
    const double size = norm2(modes_->size(), at_now_.data());
    std::vector<const ContactModes::Mode *> kept;
    for (const ContactModes::Mode &m : modes_->modes()) {
        if (m.speed * duration_ <= longest_turn) continue;
        const double *z = present_.data() + m.first;
        if (std::sqrt(z[0] * z[0] + (m.is_pair ? z[1] * z[1] : 0.0)) > unnoticed * size) kept.push_back(&m);
    }
    fast_.cosine.reset(rows.rows(), static_cast<std::int64_t>(kept.size()));
    fast_.sine.reset(rows.rows(), static_cast<std::int64_t>(kept.size()));
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const ContactModes::Mode &m = *kept[k];
        fast_.rate.push_back(m.rate);
        const double re = present_[m.first], im = m.is_pair ? present_[m.first + 1] : 0;
        for (std::int64_t j = 0; j < rows.rows(); ++j) { // columns Re v and -Im v
            const double a = rows(j, m.first), b = m.is_pair ? -rows(j, m.first + 1) : 0;
            fast_.cosine(j, static_cast<std::int64_t>(k)) = a * re - b * im;
            fast_.sine(j, static_cast<std::int64_t>(k)) = a * im + b * re;
        }
    }
}

void ModalPieces::advance_free(double share) {
    const std::int64_t n = unheld_powers_.rows();
    if (!changed_unheld_.empty())
        expand_free(changed_unheld_.data(), true, duration_, changed_unheld_powers_);
    const auto sum = [&](const Matrix &powers, double *to) {
        std::fill_n(to, n, 0.0);
        for (std::int64_t k = n_terms_ - 1; k >= 0; --k)
            for (std::int64_t i = 0; i < n; ++i) to[i] = to[i] * share + powers(i, k);
    };
    sum(unheld_powers_, present_.data() + modes_->first_free());
    if (!changed_unheld_.empty()) sum(changed_unheld_powers_, changed_unheld_.data());
}

void ModalPieces::advance(double duration) {
    if (modes_->free_block().rows() > 0) advance_free(duration / duration_);
    now_ += duration;
    steady_at(now_, at_now_, nullptr);
    turn_free(free_, present_);
    for (std::size_t j = 0; j < at_now_.size(); ++j) at_now_[j] += present_[j];
}

// The free part from the beginning of the stay to now.
void ModalPieces::turn_free(const vector<double> &from, vector<double> &to) const {
    for (const ContactModes::Mode &m : modes_->modes()) {
        const Complex factor = std::exp(m.rate * (now_ - start_));
        const std::size_t j = static_cast<std::size_t>(m.first);
        const Complex z = factor * Complex(from[j], m.is_pair ? from[j + 1] : 0.0);
        to[j] = z.real();
        if (m.is_pair) to[j + 1] = z.imag();
    }
}

vector<double> ModalPieces::changed_now() const {
    vector<double> motion, changed, free(changed_free_.size());
    steady_at(now_, motion, &changed);
    turn_free(changed_free_, free);
    for (std::size_t j = 0; j < changed.size(); ++j) changed[j] += free[j];
    std::copy(changed_unheld_.begin(), changed_unheld_.end(),
              changed.begin() + static_cast<std::ptrdiff_t>(modes_->first_free()));
    return changed;
}

void ModalPieces::leave(FlowState &state, FlowState &change) {
    modes_->to_state(at_now_.data(), state.y.data(), state.v.data());
    std::fill(state.v.begin() + model_.n_massive(), state.v.end(), 0.0);
    if (puts_aside_) {
        gemv('N', 1.0, modes_->displacement(), at_now_.data(), 0.0, state.y.data());
        put_aside(&ContactModes::Load::following, now_, aside_);
        for (std::size_t i = 0; i < aside_.size(); ++i)
            state.y[static_cast<std::size_t>(model_.n_moving()) + i] += aside_[i];
    }
    state.time = now_;
    if (parameter_ != FlowParameter::none) {
        const vector<double> changed = changed_now();
        modes_->to_state(changed.data(), change.y.data(), change.v.data());
        change.time = now_;
    }
    modes_ = nullptr;
}

} // namespace plm
