// plm.hpp - libplm for C++17 and later: handles that clean up after themselves, exceptions, containers,
// lambdas.
//
// Header only, over plm.h alone; nothing is exported, any compiler will do. What a function computes is said
// in plm.h beside the C function of the same name; this page says only what C++ adds:
//
//   - Model, Sampler, Basis, Hbm, Branch, Transient and Study are move-only and may outlive one another and
//     the Context in any order.
//   - A failure throws plm::Error with everything the context knows about it. An outcome (a status above 0:
//     PLM_WARNING, PLM_NOT_CONVERGED, PLM_TRUNCATED, PLM_CANCELLED) does not throw: what returns no result
//     returns it, a Branch keeps it as status(), and Context::on_outcome hears of every one with its text. A
//     cancelled call without a result throws plm::Cancelled.
//   - Arrays in: any contiguous container (std::vector, std::array, std::span, Eigen vectors, {1, 2, 3});
//     its size is checked. Arrays out: std::vector, matrices by columns.
//   - An exception that leaves a callback stops the call under way and is thrown again by it, and so is one
//     in a log callback; libplm never sees it.
//
// The core of the library has names in namespace plm, too; the inline namespace keeps the two apart in a
// static link.
#ifndef PLM_PLM_HPP
#define PLM_PLM_HPP

#include "plm/plm.h"
#include <array>
#include <complex>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace plm {
inline namespace cpp {

// ---- Errors ----------------------------------------------------------------------------------------------

/// Where and why a call failed.
struct ErrorDetails {
    plm_status status = PLM_ERR_INTERNAL;
    std::int32_t reason = PLM_REASON_NONE; // PLM_REASON_...
    std::int64_t index = -1;               // offending position in the argument, -1: none
    std::int64_t library_code = 0;         // of LAPACK, the factorization or a callback
    std::string function, argument;        // of plm.h
};

class Error : public std::runtime_error {
  public:
    Error(const std::string &text, ErrorDetails details)
        : std::runtime_error(text), details_(std::make_shared<const ErrorDetails>(std::move(details))) {}
    plm_status status() const noexcept { return details_->status; }
    std::int32_t reason() const noexcept { return details_->reason; }
    std::int64_t index() const noexcept { return details_->index; }
    std::int64_t library_code() const noexcept { return details_->library_code; }
    const std::string &function() const noexcept { return details_->function; }
    const std::string &argument() const noexcept { return details_->argument; }

  private:
    std::shared_ptr<const ErrorDetails> details_; // shared: copying an exception must not throw
};

/// The progress callback stopped a call that has no partial result.
class Cancelled : public Error {
  public:
    using Error::Error;
};

// ---- Arrays and matrices ---------------------------------------------------------------------------------

/// A look at someone else's contiguous array; lives as long as the call it is an argument of.
template <class T> class View {
  public:
    View() = default;
    View(std::nullptr_t) {}
    View(const T *data, std::int64_t size) : data_(data), size_(size) {}
    View(std::initializer_list<T> list) : View(list.begin(), static_cast<std::int64_t>(list.size())) {}
    template <
        class C,
        class = std::enable_if_t<std::is_same_v<
            std::remove_cv_t<std::remove_pointer_t<decltype(std::data(std::declval<const C &>()))>>, T>>>
    View(const C &container) : View(std::data(container), static_cast<std::int64_t>(std::size(container))) {}
    const T *data() const { return data_; }
    std::int64_t size() const { return size_; }

  private:
    const T *data_ = nullptr;
    std::int64_t size_ = 0;
};
using Reals = View<double>;

/// A look at integers of 32 or 64 bits; the C function with the same width is called.
class Indices {
  public:
    Indices() = default;
    Indices(std::initializer_list<std::int32_t> list) : narrow_(list) {}
    template <class C, class = std::enable_if_t<std::is_convertible_v<const C &, View<std::int32_t>>>,
              class = void>
    Indices(const C &container) : narrow_(container) {}
    template <class C, class = std::enable_if_t<std::is_convertible_v<const C &, View<std::int64_t>>>>
    Indices(const C &container) : wide_(container), is_wide_(true) {}
    bool is_wide() const { return is_wide_; }
    std::int64_t size() const { return is_wide_ ? wide_.size() : narrow_.size(); }
    const std::int32_t *narrow() const { return narrow_.data(); }
    const std::int64_t *wide() const { return wide_.data(); }

  private:
    View<std::int32_t> narrow_;
    View<std::int64_t> wide_;
    bool is_wide_ = false;
};

/// A sparse matrix in the caller's arrays, as Model::set_matrix takes it; made by csc, csr or triplets.
struct Sparse {
    std::int32_t storage = PLM_CSC, part = PLM_FULL, index_base = 0, ownership = PLM_COPY;
    Indices a, b;
    Reals value;

    Sparse lower() const { return with(&Sparse::part, PLM_LOWER); } // only the lower triangle is stored
    Sparse upper() const { return with(&Sparse::part, PLM_UPPER); }
    Sparse base(std::int32_t index_base_) const { return with(&Sparse::index_base, index_base_); }
    /// The arrays stay unchanged and alive until Model::build.
    Sparse borrowed() const { return with(&Sparse::ownership, PLM_BORROW); }

  private:
    Sparse with(std::int32_t Sparse::*field, std::int32_t x) const {
        Sparse s = *this;
        s.*field = x;
        return s;
    }
};
inline Sparse sparse(std::int32_t storage, Indices a, Indices b, Reals value) {
    Sparse s;
    s.storage = storage, s.a = a, s.b = b, s.value = value;
    return s;
}
inline Sparse csc(Indices col_ptr, Indices row, Reals value) {
    return sparse(PLM_CSC, col_ptr, row, value);
}
inline Sparse csr(Indices row_ptr, Indices column, Reals value) {
    return sparse(PLM_CSR, row_ptr, column, value);
}
inline Sparse triplets(Indices row, Indices column, Reals value) {
    return sparse(PLM_TRIPLETS, row, column, value);
}

/// A dense matrix by columns.
template <class T> struct Dense {
    std::int64_t rows = 0, cols = 0;
    std::vector<T> values;
    const T &operator()(std::int64_t i, std::int64_t j) const {
        return values[static_cast<std::size_t>(i + j * rows)];
    }
    const T *column(std::int64_t j) const { return values.data() + j * rows; }
};

/// A factorization of the host, made by the function given to Context::set_solver.
class Factorization {
  public:
    virtual ~Factorization() = default;
    /// x (n x n_rhs, leading dimension ld) becomes the solution. Throw on failure.
    virtual void solve(double *x, std::int64_t n_rhs, std::int64_t ld) = 0;
    /// Of the matrix factored, by which the number of modes is verified; -1: this solver cannot tell.
    virtual std::int64_t negative_eigenvalues() { return -1; }
};
/// The matrix it factors: lower triangle by columns, base 0.
struct LowerTriangle {
    std::int64_t n;
    const std::int64_t *col_ptr, *row;
    const double *value;
    bool positive_definite;
};

/// A superelement's way to the structure it was reduced from: column-major, without padding, full = T
/// reduced.
struct Recovery {
    std::int64_t n_dof, n_columns;
    const double *reduced; // n_dof x n_columns
    std::int64_t n_full;
    double *full; // n_full x n_columns, to be filled
};

// ---- The machinery ---------------------------------------------------------------------------------------

namespace detail {

inline std::size_t index(std::int64_t n) {
    return static_cast<std::size_t>(n);
}

/// A text of unknown length: get(capacity, buffer, needed) is a plm function that copies it out.
template <class Get> plm_status read_text(Get get, std::string &text) {
    std::int64_t needed = 0;
    plm_status s = get(std::int64_t(0), nullptr, &needed);
    if (s != PLM_OK) return s;
    text.assign(index(needed > 0 ? needed : 1), '\0');
    s = get(static_cast<std::int64_t>(text.size()), &text[0], &needed);
    text.resize(std::strlen(text.c_str()));
    return s;
}

/// The C context with the callbacks of its owner; shared by all handles made in it.
class State {
  public:
    using Log = std::function<void(int, std::string_view)>;
    using Progress = std::function<bool(std::string_view, double)>;
    using Outcome = std::function<void(plm_status, std::string_view)>;
    using Factor = std::function<std::unique_ptr<Factorization>(const LowerTriangle &)>;
    using Recover = std::function<void(const Recovery &)>;
    using Write = std::function<void(std::string_view)>;

    State() = default;
    State(const State &) = delete;
    State &operator=(const State &) = delete;
    ~State() { plm_context_destroy(&context); }

    /// Throws what a callback threw during the call, else an Error when the call failed; tells of outcomes.
    void check(plm_status status, const char *function) {
        if (thrown) std::rethrow_exception(std::exchange(thrown, nullptr));
        if (status < 0) fail(status, function);
        if (status > 0 && status != PLM_CANCELLED && outcome) outcome(status, last_text(status, function));
    }
    /// For calls that have no result when they were cancelled.
    plm_status finished(plm_status status, const char *function) {
        check(status, function);
        if (status == PLM_CANCELLED) fail(status, function);
        return status;
    }

    /// What the context keeps of the last call; false when that was another one: a dead handle, a call from
    /// inside a callback or beside another thread's are not heard of.
    bool details(plm_status status, const char *function, ErrorDetails &d) const {
        read_text([&](auto... x) { return plm_context_get_error_function(context, x...); }, d.function);
        plm_context_get_error_info(context, &d.status, &d.reason, &d.index, &d.library_code);
        if (d.function == function && d.status == status) return true;
        d = ErrorDetails();
        d.status = status, d.function = function;
        return false;
    }
    std::string last_text(plm_status status, const char *function) const {
        ErrorDetails d;
        std::string text;
        if (details(status, function, d)) {
            read_text([&](auto... x) { return plm_context_get_error_text(context, x...); }, text);
            return text;
        }
        read_text([&](auto... x) { return plm_status_text(status, x...); }, text);
        return std::string(function) + ": " + text;
    }

    [[noreturn]] void fail(plm_status status, const char *function) const {
        ErrorDetails d;
        if (details(status, function, d))
            read_text([&](auto... x) { return plm_context_get_error_argument(context, x...); }, d.argument);
        const std::string text = last_text(status, function);
        if (status == PLM_CANCELLED) throw Cancelled(text, std::move(d));
        throw Error(text, std::move(d));
    }

    void install() {
        const bool any = log || progress;
        check(plm_context_set_log(context, log ? on_log : nullptr, this), "plm_context_set_log");
        check(plm_context_set_progress(context, any ? on_progress : nullptr, this),
              "plm_context_set_progress");
    }
    void install_solver() {
        check(factor ? plm_context_set_solver(context, on_factor, on_solve, on_free, this)
                     : plm_context_set_solver(context, nullptr, nullptr, nullptr, nullptr),
              "plm_context_set_solver");
        if (factor) check(plm_context_set_inertia(context, on_inertia), "plm_context_set_inertia");
    }

    /// Kept as long as the context, for models may outlive their C++ objects.
    void install_recovery(plm_model *model, std::int64_t n_full, Recover f) {
        recoveries.push_back(std::make_unique<OwnRecovery>(OwnRecovery{this, std::move(f)}));
        check(plm_model_set_recovery(model, n_full, on_recover, recoveries.back().get()),
              "plm_model_set_recovery");
    }

    struct OwnWriter {
        State *state;
        Write write;
    };
    static std::int32_t on_write(plm_context *, std::int64_t n, const void *bytes, void *user) noexcept {
        const auto *w = static_cast<const OwnWriter *>(user);
        const std::string_view piece(static_cast<const char *>(bytes), static_cast<std::size_t>(n));
        return w->state->guarded([&] { w->write(piece); }) ? 0 : 1;
    }

    plm_context *context = nullptr;
    Log log;
    Progress progress;
    Factor factor;
    Outcome outcome;
    std::exception_ptr thrown; // by a callback, to be thrown again after the call

  private:
    struct OwnRecovery {
        State *state;
        Recover run;
    };
    std::vector<std::unique_ptr<OwnRecovery>> recoveries;

    /// Runs a callback; keeps its exception. False when there is one, of this or of an earlier callback.
    template <class F> bool guarded(F f) noexcept {
        if (thrown) return false;
        try {
            f();
            return true;
        } catch (...) {
            thrown = std::current_exception();
            return false;
        }
    }
    static void on_log(plm_context *, std::int32_t level, const char *text, void *user) noexcept {
        auto *s = static_cast<State *>(user);
        s->guarded([&] { s->log(level, text); });
    }
    static std::int32_t on_progress(plm_context *, const char *stage, double fraction, void *user) noexcept {
        auto *s = static_cast<State *>(user);
        bool stop = false;
        const bool fine = s->guarded([&] { stop = s->progress && s->progress(stage, fraction); });
        return stop || !fine;
    }
    static std::int32_t on_factor(plm_context *, std::int64_t n, const std::int64_t *col_ptr,
                                  const std::int64_t *row, const double *value,
                                  std::int32_t positive_definite, void **out, void *user) noexcept {
        auto *s = static_cast<State *>(user);
        const bool fine = s->guarded([&] {
            *out = s->factor(LowerTriangle{n, col_ptr, row, value, positive_definite != 0}).release();
        });
        return fine ? 0 : 1;
    }
    static std::int32_t on_solve(plm_context *, void *f, std::int64_t n_rhs, double *x, std::int64_t ld,
                                 void *user) noexcept {
        auto *s = static_cast<State *>(user);
        return s->guarded([&] { static_cast<Factorization *>(f)->solve(x, n_rhs, ld); }) ? 0 : 1;
    }
    static std::int32_t on_inertia(plm_context *, void *f, std::int64_t *negative, void *user) noexcept {
        auto *s = static_cast<State *>(user);
        return s->guarded([&] { *negative = static_cast<Factorization *>(f)->negative_eigenvalues(); }) ? 0
                                                                                                        : 1;
    }
    static std::int32_t on_recover(plm_context *, std::int64_t n_dof, std::int64_t n_columns,
                                   const double *reduced, std::int64_t n_full, double *full,
                                   void *user) noexcept {
        const auto *r = static_cast<const OwnRecovery *>(user);
        return r->state->guarded([&] { r->run(Recovery{n_dof, n_columns, reduced, n_full, full}); }) ? 0 : 1;
    }
    static void on_free(plm_context *, void *f, void *) noexcept { delete static_cast<Factorization *>(f); }
};
using StatePtr = std::shared_ptr<State>;

/// The C functions of each handle.
template <class C> struct Api;
#define PLM_HPP_SETTERS(noun)                                                                                \
    static constexpr const char *name = #noun;                                                               \
    static constexpr auto destroy = plm_##noun##_destroy;                                                    \
    static constexpr auto set_int = plm_##noun##_set_int;                                                    \
    static constexpr auto set_double = plm_##noun##_set_double;                                              \
    static constexpr auto set_string = plm_##noun##_set_string;
#define PLM_HPP_GETTERS(noun)                                                                                \
    static constexpr auto get_int = plm_##noun##_get_int;                                                    \
    static constexpr auto get_double = plm_##noun##_get_double;                                              \
    static constexpr auto get_string = plm_##noun##_get_string;
#define PLM_HPP_ARRAYS(noun)                                                                                 \
    static constexpr auto get_array = plm_##noun##_get_array;                                                \
    static constexpr auto get_int_array = plm_##noun##_get_int_array;
template <> struct Api<plm_model> { PLM_HPP_SETTERS(model) PLM_HPP_GETTERS(model) PLM_HPP_ARRAYS(model) };
template <> struct Api<plm_sampler> {
    PLM_HPP_SETTERS(sampler) PLM_HPP_GETTERS(sampler) PLM_HPP_ARRAYS(sampler)
};
template <> struct Api<plm_basis> { PLM_HPP_SETTERS(basis) PLM_HPP_GETTERS(basis) PLM_HPP_ARRAYS(basis) };
template <> struct Api<plm_hbm> { PLM_HPP_SETTERS(hbm) PLM_HPP_GETTERS(hbm) };
template <> struct Api<plm_branch> {
    static constexpr const char *name = "branch";
    static constexpr auto destroy = plm_branch_destroy;
    PLM_HPP_GETTERS(branch) PLM_HPP_ARRAYS(branch)
};
template <> struct Api<plm_transient> {
    PLM_HPP_SETTERS(transient) PLM_HPP_GETTERS(transient) PLM_HPP_ARRAYS(transient)
};
template <> struct Api<plm_study> { PLM_HPP_SETTERS(study) PLM_HPP_GETTERS(study) PLM_HPP_ARRAYS(study) };
#undef PLM_HPP_SETTERS
#undef PLM_HPP_GETTERS
#undef PLM_HPP_ARRAYS

template <class T> inline constexpr bool always_false = false;

/// What all handles share: ownership, results by key.
template <class C> class Handle {
  public:
    Handle(Handle &&other) noexcept
        : state_(std::move(other.state_)), handle_(std::exchange(other.handle_, nullptr)) {}
    Handle &operator=(Handle &&other) noexcept {
        std::swap(state_, other.state_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    Handle(const Handle &) = delete;
    Handle &operator=(const Handle &) = delete;
    ~Handle() { Api<C>::destroy(&handle_); }

    /// The C handle, for functions of plm.h; stays owned here.
    C *c_handle() const { return handle_; }

    std::int64_t get_int(const char *key) const {
        std::int64_t x = 0;
        check(Api<C>::get_int(handle_, key, &x), "get_int");
        return x;
    }
    double get_double(const char *key) const {
        double x = 0;
        check(Api<C>::get_double(handle_, key, &x), "get_double");
        return x;
    }
    std::string get_string(const char *key) const {
        std::string x;
        check(read_text([&](auto... a) { return Api<C>::get_string(handle_, key, a...); }, x), "get_string");
        return x;
    }
    std::vector<double> get_array(const char *key) const {
        return array<double>(key, Api<C>::get_array, "get_array");
    }
    std::vector<std::int64_t> get_int_array(const char *key) const {
        return array<std::int64_t>(key, Api<C>::get_int_array, "get_int_array");
    }
    /// T: an integer, double, std::string, std::vector<double> or std::vector<std::int64_t>.
    template <class T> T get(const char *key) const {
        if constexpr (std::is_integral_v<T>)
            return static_cast<T>(get_int(key));
        else if constexpr (std::is_floating_point_v<T>)
            return static_cast<T>(get_double(key));
        else if constexpr (std::is_same_v<T, std::string>)
            return get_string(key);
        else if constexpr (std::is_same_v<T, std::vector<double>>)
            return get_array(key);
        else if constexpr (std::is_same_v<T, std::vector<std::int64_t>>)
            return get_int_array(key);
        else
            static_assert(always_false<T>,
                          "results are integers, doubles, strings and vectors of these numbers");
    }

  protected:
    Handle(StatePtr state, C *handle) : state_(std::move(state)), handle_(handle) {}

    std::vector<char> bytes(plm_status (*write)(C *, std::int64_t, void *, std::int64_t *)) const {
        std::int64_t needed = 0;
        check(write(handle_, 0, nullptr, &needed), "write");
        std::vector<char> all(index(needed));
        check(write(handle_, needed, all.data(), &needed), "write");
        return all;
    }
    /// By one of the functions that take a plm_write_fn.
    template <class W, class... A> void hand_to(State::Write f, const char *verb, W write, A... a) const {
        State::OwnWriter writer{&living(), std::move(f)};
        check(write(handle_, a..., State::on_write, &writer), verb);
    }
    void check(plm_status status, const char *verb) const {
        if (status != PLM_OK || (state_ && state_->thrown)) living().check(status, full_name(verb).c_str());
    }
    plm_status finished(plm_status status, const char *verb) const {
        return status == PLM_OK && !state_->thrown ? status
                                                   : living().finished(status, full_name(verb).c_str());
    }
    /// Refuses an array that has not the size the function needs.
    void require_size(std::int64_t size, std::int64_t needed, const char *verb, const char *argument) const {
        if (size == needed) return;
        ErrorDetails d;
        d.status = PLM_ERR_ARGUMENT, d.function = full_name(verb), d.argument = argument;
        throw Error(d.function + ": " + argument + " has " + std::to_string(size) + " entries, needed are " +
                        std::to_string(needed),
                    d);
    }
    /// Real and imaginary parts of unknown number: get(capacity, real, imag, count) copies them out.
    template <class Get> std::vector<std::complex<double>> complex_array(Get get, const char *verb) const {
        std::int64_t n = 0;
        check(get(std::int64_t(0), nullptr, nullptr, &n), verb);
        std::vector<double> real(index(n)), imag(index(n));
        if (n > 0) check(get(n, real.data(), imag.data(), &n), verb);
        std::vector<std::complex<double>> values;
        for (std::size_t i = 0; i < real.size(); ++i) values.emplace_back(real[i], imag[i]);
        return values;
    }
    static std::string full_name(const char *verb) { return std::string("plm_") + Api<C>::name + "_" + verb; }
    State &living() const {
        if (state_) return *state_;
        ErrorDetails d; // moved from
        d.status = PLM_ERR_HANDLE, d.function = std::string("plm_") + Api<C>::name;
        throw Error(d.function + ": this object was moved from", d);
    }

    StatePtr state_;
    C *handle_;

  private:
    template <class T, class Read> std::vector<T> array(const char *key, Read read, const char *verb) const {
        std::int64_t n = 0;
        check(read(handle_, key, 0, nullptr, &n), verb);
        std::vector<T> x(index(n));
        if (n > 0) check(read(handle_, key, n, x.data(), &n), verb);
        return x;
    }
};

/// A handle that has options, too. Self: the class made from it, returned by set for chains of calls.
template <class Self, class C> class WithOptions : public Handle<C> {
  public:
    Self &set(const char *key, const char *value) {
        return done(Api<C>::set_string(h(), key, value), "set_string");
    }
    Self &set(const char *key, const std::string &value) { return set(key, value.c_str()); }
    /// An integer (bool included) or floating-point value.
    template <class T, class = std::enable_if_t<std::is_arithmetic_v<T>>>
    Self &set(const char *key, T value) {
        if constexpr (std::is_integral_v<T>)
            return done(Api<C>::set_int(h(), key, static_cast<std::int64_t>(value)), "set_int");
        else
            return done(Api<C>::set_double(h(), key, static_cast<double>(value)), "set_double");
    }

  protected:
    using Handle<C>::Handle;

  private:
    C *h() const { return this->c_handle(); }
    Self &done(plm_status status, const char *verb) {
        this->check(status, verb);
        return static_cast<Self &>(*this);
    }
};

} // namespace detail

// ---- Library ---------------------------------------------------------------------------------------------

inline std::string status_text(plm_status status) {
    std::string text;
    detail::read_text([&](auto... x) { return plm_status_text(status, x...); }, text);
    return text;
}
inline std::string build_info() {
    std::string text;
    detail::read_text([&](auto... x) { return plm_build_info(x...); }, text);
    return text;
}
/// Major, minor, patch.
inline std::array<int, 3> version() {
    std::array<std::int32_t, 3> v{};
    plm_version(&v[0], &v[1], &v[2]);
    return {v[0], v[1], v[2]};
}

/// A row of the table of options and results.
struct Key {
    std::string name, description, default_text, choices;
    std::int32_t type; // PLM_TYPE_...
    bool is_option;
    double minimum, maximum;
};
/// The table of a kind of handle, PLM_KIND_...; empty for an unknown kind.
inline std::vector<Key> keys(std::int32_t kind) {
    std::int32_t count = 0;
    plm_key_count(kind, &count);
    std::vector<Key> table;
    for (std::int32_t i = 0; i < count; ++i) {
        Key k{};
        std::int32_t is_option = 0;
        plm_key_info(kind, i, &k.type, &is_option, &k.minimum, &k.maximum);
        k.is_option = is_option != 0;
        const std::pair<std::int32_t, std::string *> fields[] = {{PLM_KEY_NAME, &k.name},
                                                                 {PLM_KEY_DESCRIPTION, &k.description},
                                                                 {PLM_KEY_DEFAULT, &k.default_text},
                                                                 {PLM_KEY_CHOICES, &k.choices}};
        for (const auto &field : fields)
            detail::read_text([&](auto... x) { return plm_key_text(kind, i, field.first, x...); },
                              *field.second);
        table.push_back(std::move(k));
    }
    return table;
}

/// Callbacks, solver and memory of a host; for one thread at a time. May be destroyed before what was made in
/// it.
class Context {
  public:
    Context() : Context([](plm_context **c) { return plm_context_create(PLM_API_VERSION, c); }) {}
    /// All arrays come from `allocate`, which must be able to serve until the last object made in this
    /// context is gone.
    Context(plm_allocate_fn allocate, plm_release_fn release, void *user)
        : Context([=](plm_context **c) {
              return plm_context_create_with_allocator(PLM_API_VERSION, allocate, release, user, c);
          }) {}
    Context(Context &&) noexcept = default;
    Context &operator=(Context &&) noexcept = default;

    /// f(level, text), level 0 detail, 1 information, 2 warning; the text lives during the call only.
    template <class F> void on_log(F f) {
        state()->log = std::move(f);
        state()->install();
    }
    /// f(stage, fraction) may return nothing, or true to cancel.
    template <class F> void on_progress(F f) {
        if constexpr (std::is_void_v<std::invoke_result_t<F &, std::string_view, double>>)
            state()->progress = [f = std::move(f)](std::string_view stage, double fraction) mutable {
                f(stage, fraction);
                return false;
            };
        else
            state()->progress = std::move(f);
        state()->install();
    }
    /// f(status, text) hears what should be looked at, of every call that is done with an outcome; the text
    /// lives during the call only. It may throw: what was computed is then lost.
    template <class F> void on_outcome(F f) { state()->outcome = std::move(f); }
    void silence() {
        state()->log = nullptr;
        state()->progress = nullptr;
        state()->install();
    }
    /// What a search may cost: seconds of one core, as operations are counted; 0: no limit.
    void set_effort(double seconds) {
        state()->check(plm_context_set_effort(c_handle(), seconds), "plm_context_set_effort");
    }
    /// How many threads a call may use; results are the same for any number.
    void set_threads(std::int32_t n) {
        state()->check(plm_context_set_threads(c_handle(), n), "plm_context_set_threads");
    }
    /// f(const LowerTriangle &) returns a std::unique_ptr<Factorization>; for models built afterwards.
    template <class F> void set_solver(F f) {
        state()->factor = std::move(f);
        state()->install_solver();
    }
    /// Back to the solver built in.
    void reset_solver() {
        state()->factor = nullptr;
        state()->install_solver();
    }

    plm_context *c_handle() const { return state()->context; }
    const detail::StatePtr &state() const {
        if (state_) return state_;
        ErrorDetails d;
        d.status = PLM_ERR_HANDLE, d.function = "plm_context";
        throw Error("plm_context: this object was moved from", d);
    }

  private:
    template <class Create, class = std::enable_if_t<std::is_invocable_v<Create, plm_context **>>>
    explicit Context(Create create) : state_(std::make_shared<detail::State>()) {
        state_->check(create(&state_->context), "plm_context_create");
    }
    detail::StatePtr state_;
};

// ---- Model -----------------------------------------------------------------------------------------------

struct Modes {
    std::vector<double> frequency_hz;
    Dense<double> shape; // n_dof x n, mass-normalised
};
struct Finding {
    std::int32_t severity; // 0 fact, 1 worth a look, 2 probably wrong
    double value;
    std::string text;
};

struct Response;
class Branch;
class Model : public detail::WithOptions<Model, plm_model> {
  public:
    Model(const Context &context, std::int64_t n_dof) : WithOptions(context.state(), nullptr), n_dof_(n_dof) {
        state_->check(plm_model_create(state_->context, n_dof, &handle_), "plm_model_create");
    }
    /// Takes over a model that a C function has made in the context.
    Model(const Context &context, plm_model *made, std::int64_t n_dof)
        : WithOptions(context.state(), made), n_dof_(n_dof) {}
    std::int64_t n_dof() const { return n_dof_; }

    /// which: PLM_MASS, PLM_STIFFNESS or PLM_DAMPING.
    void set_matrix(std::int32_t which, const Sparse &m) {
        const bool wide = m.a.is_wide();
        const char *verb = wide ? "set_matrix_i64" : "set_matrix_i32";
        const std::int64_t nnz = m.value.size();
        require_size(m.a.size(), m.storage == PLM_TRIPLETS ? nnz : n_dof_ + 1, verb, "a");
        require_size(m.b.size(), nnz, verb, "b");
        require_width(m.b, wide, verb, "b");
        check(wide ? plm_model_set_matrix_i64(handle_, which, m.storage, m.part, m.index_base, m.ownership,
                                              nnz, m.a.wide(), m.b.wide(), m.value.data())
                   : plm_model_set_matrix_i32(handle_, which, m.storage, m.part, m.index_base, m.ownership,
                                              nnz, m.a.narrow(), m.b.narrow(), m.value.data()),
              verb);
    }
    /// A superelement's: n_dof x n_dof, column-major; part: PLM_FULL, PLM_LOWER or PLM_UPPER of it is read.
    void set_dense_matrix(std::int32_t which, Reals value, std::int32_t part = PLM_FULL) {
        require_size(value.size(), n_dof_ * n_dof_, "set_dense_matrix", "value");
        check(plm_model_set_dense_matrix(handle_, which, part, value.data(), n_dof_), "set_dense_matrix");
    }
    void set_mass(const Sparse &m) { set_matrix(PLM_MASS, m); }
    void set_stiffness(const Sparse &k) { set_matrix(PLM_STIFFNESS, k); }
    void set_damping(const Sparse &c) { set_matrix(PLM_DAMPING, c); }
    void set_rayleigh_damping(double alpha, double beta) {
        check(plm_model_set_rayleigh_damping(handle_, alpha, beta), "set_rayleigh_damping");
    }
    void set_modal_damping(Reals ratio) {
        check(plm_model_set_modal_damping(handle_, ratio.size(), ratio.data()), "set_modal_damping");
    }
    void set_structural_damping(double eta) {
        check(plm_model_set_structural_damping(handle_, eta), "set_structural_damping");
    }
    void fix_dofs(Indices dof, std::int32_t index_base = 0) {
        check(dof.is_wide() ? plm_model_fix_dofs_i64(handle_, index_base, dof.size(), dof.wide())
                            : plm_model_fix_dofs_i32(handle_, index_base, dof.size(), dof.narrow()),
              dof.is_wide() ? "fix_dofs_i64" : "fix_dofs_i32");
    }
    /// Rows sum c_j q_j = 0: row_ptr (n + 1), dof and coefficient.
    void add_constraints(Indices row_ptr, Indices dof, Reals coefficient, std::int32_t index_base = 0) {
        const bool wide = row_ptr.is_wide();
        const char *verb = wide ? "add_constraints_i64" : "add_constraints_i32";
        if (row_ptr.size() < 1) require_size(row_ptr.size(), 1, verb, "row_ptr");
        const std::int64_t n = row_ptr.size() - 1;
        const std::int64_t nnz = (wide ? row_ptr.wide()[n] : std::int64_t(row_ptr.narrow()[n])) - index_base;
        require_size(dof.size(), nnz, verb, "dof");
        require_width(dof, wide, verb, "dof");
        require_size(coefficient.size(), nnz, verb, "coefficient");
        check(wide ? plm_model_add_constraints_i64(handle_, index_base, n, row_ptr.wide(), dof.wide(),
                                                   coefficient.data())
                   : plm_model_add_constraints_i32(handle_, index_base, n, row_ptr.narrow(), dof.narrow(),
                                                   coefficient.data()),
              verb);
    }
    /// Outputs sum c_j q_j: row_ptr (n + 1), dof and coefficient. The number of the first, to stand for a
    /// DOF.
    std::int64_t add_outputs(Indices row_ptr, Indices dof, Reals coefficient, std::int32_t index_base = 0) {
        const bool wide = row_ptr.is_wide();
        const char *verb = wide ? "add_outputs_i64" : "add_outputs_i32";
        if (row_ptr.size() < 1) require_size(row_ptr.size(), 1, verb, "row_ptr");
        const std::int64_t n = row_ptr.size() - 1;
        const std::int64_t nnz = (wide ? row_ptr.wide()[n] : std::int64_t(row_ptr.narrow()[n])) - index_base;
        require_size(dof.size(), nnz, verb, "dof");
        require_width(dof, wide, verb, "dof");
        require_size(coefficient.size(), nnz, verb, "coefficient");
        std::int64_t first = 0;
        check(wide ? plm_model_add_outputs_i64(handle_, index_base, n, row_ptr.wide(), dof.wide(),
                                               coefficient.data(), &first)
                   : plm_model_add_outputs_i32(handle_, index_base, n, row_ptr.narrow(), dof.narrow(),
                                               coefficient.data(), &first),
              verb);
        return first;
    }
    /// Nodes that follow a reference node rigidly. DOFs: 3 or 6 of the reference node, and 3 or 6 of every
    /// other (base - 1: none); coordinates: 3, 3 x n.
    void add_rigid_link(Indices reference_dof, Reals reference_xyz, Indices dependent_dof,
                        Reals dependent_xyz, std::int32_t index_base = 0) {
        const bool wide = dependent_dof.is_wide();
        const char *verb = wide ? "add_rigid_link_i64" : "add_rigid_link_i32";
        const std::int64_t n = dependent_xyz.size() / 3;
        const std::int32_t per_reference = require_reference(reference_dof, reference_xyz, wide, verb),
                           per_dependent = dependent_dof.size() > 3 * n ? 6 : 3;
        require_size(dependent_xyz.size(), 3 * n, verb, "dependent_xyz");
        require_size(dependent_dof.size(), per_dependent * n, verb, "dependent_dof");
        check(wide ? plm_model_add_rigid_link_i64(handle_, index_base, per_reference, reference_dof.wide(),
                                                  reference_xyz.data(), n, per_dependent,
                                                  dependent_dof.wide(), dependent_xyz.data())
                   : plm_model_add_rigid_link_i32(handle_, index_base, per_reference, reference_dof.narrow(),
                                                  reference_xyz.data(), n, per_dependent,
                                                  dependent_dof.narrow(), dependent_xyz.data()),
              verb);
    }
    /// Where the DOFs are, for the audit: 3 or 6 of every node (base - 1: none); xyz: 3 x n.
    void set_coordinates(Indices dof, Reals xyz, std::int32_t index_base = 0) {
        const bool wide = dof.is_wide();
        const char *verb = wide ? "set_coordinates_i64" : "set_coordinates_i32";
        const std::int64_t n = xyz.size() / 3;
        const std::int32_t per_node = dof.size() > 3 * n ? 6 : 3;
        require_size(xyz.size(), 3 * n, verb, "xyz");
        require_size(dof.size(), per_node * n, verb, "dof");
        check(wide
                  ? plm_model_set_coordinates_i64(handle_, index_base, n, per_node, dof.wide(), xyz.data())
                  : plm_model_set_coordinates_i32(handle_, index_base, n, per_node, dof.narrow(), xyz.data()),
              verb);
    }
    /// RBE3: a reference node of 3 or 6 DOFs by the rigid motion that fits nodes best; dof, xyz: 3 x n;
    /// weight: n or {} (all alike).
    void add_distributing_coupling(Indices reference_dof, Reals reference_xyz, Indices dof, Reals xyz,
                                   Reals weight = {}, std::int32_t index_base = 0) {
        const bool wide = dof.is_wide();
        const char *verb = wide ? "add_distributing_coupling_i64" : "add_distributing_coupling_i32";
        const std::int64_t n = xyz.size() / 3;
        const std::int32_t per_reference = require_reference(reference_dof, reference_xyz, wide, verb);
        require_size(xyz.size(), 3 * n, verb, "xyz");
        require_size(dof.size(), 3 * n, verb, "dof");
        if (weight.data()) require_size(weight.size(), n, verb, "weight");
        check(wide ? plm_model_add_distributing_coupling_i64(handle_, index_base, per_reference,
                                                             reference_dof.wide(), reference_xyz.data(), n,
                                                             dof.wide(), xyz.data(), weight.data())
                   : plm_model_add_distributing_coupling_i32(handle_, index_base, per_reference,
                                                             reference_dof.narrow(), reference_xyz.data(), n,
                                                             dof.narrow(), xyz.data(), weight.data()),
              verb);
    }
    /// Nodes onto faces that do not match them: DOFs and coordinates 3 x n, those of the surface's nodes
    /// 3 x n_surface; face_ptr (n_faces + 1), face_node. Returns the distance of every node from the surface.
    std::vector<double> add_tie(Indices dependent_dof, Reals dependent_xyz, Indices surface_dof,
                                Reals surface_xyz, Indices face_ptr, Indices face_node, double tolerance,
                                std::int32_t index_base = 0) {
        const bool wide = dependent_dof.is_wide();
        const char *verb = wide ? "add_tie_i64" : "add_tie_i32";
        const std::int64_t n = dependent_xyz.size() / 3, n_surface = surface_xyz.size() / 3,
                           n_faces = face_ptr.size() - 1;
        require_size(dependent_dof.size(), 3 * n, verb, "dependent_dof");
        require_size(surface_dof.size(), 3 * n_surface, verb, "surface_dof");
        if (n_faces < 0) require_size(face_ptr.size(), 1, verb, "face_ptr");
        for (const auto &[array, name] :
             {std::make_pair(surface_dof, "surface_dof"), std::make_pair(face_ptr, "face_ptr"),
              std::make_pair(face_node, "face_node")})
            require_width(array, wide, verb, name);
        const std::int64_t end = wide ? face_ptr.wide()[n_faces] : std::int64_t(face_ptr.narrow()[n_faces]);
        require_size(face_node.size(), end - index_base, verb, "face_node");
        std::vector<double> distance(static_cast<std::size_t>(n));
        check(wide ? plm_model_add_tie_i64(handle_, index_base, n, dependent_dof.wide(), dependent_xyz.data(),
                                           n_surface, surface_dof.wide(), surface_xyz.data(), n_faces,
                                           face_ptr.wide(), face_node.wide(), tolerance, distance.data())
                   : plm_model_add_tie_i32(handle_, index_base, n, dependent_dof.narrow(),
                                           dependent_xyz.data(), n_surface, surface_dof.narrow(),
                                           surface_xyz.data(), n_faces, face_ptr.narrow(), face_node.narrow(),
                                           tolerance, distance.data()),
              verb);
        return distance;
    }
    /// A surface for contact, DOFs and coordinates 3 x n (no DOF at all: a rigid wall; face_ptr empty:
    /// nodes alone); its number.
    std::int64_t add_surface(Indices dof, Reals xyz, Indices face_ptr = {}, Indices face_node = {},
                             Reals area = {}, std::int32_t index_base = 0) {
        const bool wide = dof.is_wide();
        const char *verb = wide ? "add_surface_i64" : "add_surface_i32";
        const std::int64_t n = xyz.size() / 3, n_faces = face_ptr.size() > 0 ? face_ptr.size() - 1 : 0;
        require_size(dof.size(), 3 * n, verb, "dof");
        if (area.size() > 0) require_size(area.size(), n, verb, "area");
        std::int64_t surface = -1;
        if (n_faces > 0) {
            require_width(face_ptr, wide, verb, "face_ptr");
            require_width(face_node, wide, verb, "face_node");
            const std::int64_t end =
                wide ? face_ptr.wide()[n_faces] : std::int64_t(face_ptr.narrow()[n_faces]);
            require_size(face_node.size(), end - index_base, verb, "face_node");
        }
        check(wide ? plm_model_add_surface_i64(handle_, index_base, n, dof.wide(), xyz.data(), area.data(),
                                               n_faces, face_ptr.wide(), face_node.wide(), &surface)
                   : plm_model_add_surface_i32(handle_, index_base, n, dof.narrow(), xyz.data(), area.data(),
                                               n_faces, face_ptr.narrow(), face_node.narrow(), &surface),
              verb);
        return surface;
    }
    /// options: a sum of PLM_SURFACE_...; PLM_OK or PLM_WARNING.
    plm_status add_surface_contact(std::int64_t slave, std::int64_t master, std::int32_t options,
                                   double stiffness, double search, double closed = 0) {
        return finished(
            plm_model_add_surface_contact(handle_, slave, master, options, stiffness, search, closed),
            "add_surface_contact");
    }
    /// N of all pairs added so far, PLM_KEEP_GAP of those that keep their gaps; empty removes it.
    void set_rest_force(Reals force) {
        check(plm_model_set_rest_force(handle_, force.size(), force.data()), "set_rest_force");
    }
    /// The host's operations in place of matrices; fn must not throw; nullptr removes it.
    void set_tall_operations(plm_tall_fn fn, void *user) {
        check(plm_model_set_tall_operations(handle_, fn, user), "set_tall_operations");
    }
    /// DOFs of the matrices that are Lagrange multipliers: their rows of K become constraints.
    void set_multipliers(Indices dof, std::int32_t index_base = 0) {
        check(dof.is_wide() ? plm_model_set_multipliers_i64(handle_, index_base, dof.size(), dof.wide())
                            : plm_model_set_multipliers_i32(handle_, index_base, dof.size(), dof.narrow()),
              dof.is_wide() ? "set_multipliers_i64" : "set_multipliers_i32");
    }
    /// A permutation of all DOFs: how the sparse factorization eliminates them, in place of the library's
    /// order.
    void set_elimination_order(Indices dof, std::int32_t index_base = 0) {
        check(dof.is_wide()
                  ? plm_model_set_elimination_order_i64(handle_, index_base, dof.size(), dof.wide())
                  : plm_model_set_elimination_order_i32(handle_, index_base, dof.size(), dof.narrow()),
              dof.is_wide() ? "set_elimination_order_i64" : "set_elimination_order_i32");
    }

    /// dof_a, dof_b, normal: 3 x n; stiffness: n (PLM_AUTO_STIFFNESS: chosen); gap: n or {} (zero).
    void add_node_pairs(Indices dof_a, Indices dof_b, Reals normal, Reals stiffness, Reals gap = {},
                        std::int32_t index_base = 0) {
        const bool wide = dof_a.is_wide();
        const char *verb = wide ? "add_node_pairs_i64" : "add_node_pairs_i32";
        const std::int64_t n = stiffness.size();
        require_size(dof_a.size(), 3 * n, verb, "dof_a");
        require_size(dof_b.size(), 3 * n, verb, "dof_b");
        require_width(dof_b, wide, verb, "dof_b");
        require_pairs(normal, gap, n, verb);
        check(wide ? plm_model_add_node_pairs_i64(handle_, index_base, n, dof_a.wide(), dof_b.wide(),
                                                  normal.data(), stiffness.data(), gap.data())
                   : plm_model_add_node_pairs_i32(handle_, index_base, n, dof_a.narrow(), dof_b.narrow(),
                                                  normal.data(), stiffness.data(), gap.data()),
              verb);
    }
    void add_ground_contacts(Indices dof, Reals normal, Reals stiffness, Reals gap = {},
                             std::int32_t index_base = 0) {
        const char *verb = dof.is_wide() ? "add_ground_contacts_i64" : "add_ground_contacts_i32";
        const std::int64_t n = stiffness.size();
        require_size(dof.size(), 3 * n, verb, "dof");
        require_pairs(normal, gap, n, verb);
        check(dof.is_wide() ? plm_model_add_ground_contacts_i64(handle_, index_base, n, dof.wide(),
                                                                normal.data(), stiffness.data(), gap.data())
                            : plm_model_add_ground_contacts_i32(handle_, index_base, n, dof.narrow(),
                                                                normal.data(), stiffness.data(), gap.data()),
              verb);
    }
    /// Rows of B: row_ptr (n + 1), dof and coefficient; stiffness: n.
    void add_gap_rows(Indices row_ptr, Indices dof, Reals coefficient, Reals stiffness, Reals gap = {},
                      std::int32_t index_base = 0) {
        const bool wide = row_ptr.is_wide();
        const char *verb = wide ? "add_gap_rows_i64" : "add_gap_rows_i32";
        const std::int64_t n = stiffness.size();
        require_size(row_ptr.size(), n + 1, verb, "row_ptr");
        const std::int64_t nnz = (wide ? row_ptr.wide()[n] : std::int64_t(row_ptr.narrow()[n])) - index_base;
        require_size(dof.size(), nnz, verb, "dof");
        require_width(dof, wide, verb, "dof");
        require_size(coefficient.size(), nnz, verb, "coefficient");
        if (gap.data()) require_size(gap.size(), n, verb, "gap");
        check(wide ? plm_model_add_gap_rows_i64(handle_, index_base, n, row_ptr.wide(), dof.wide(),
                                                coefficient.data(), stiffness.data(), gap.data())
                   : plm_model_add_gap_rows_i32(handle_, index_base, n, row_ptr.narrow(), dof.narrow(),
                                                coefficient.data(), stiffness.data(), gap.data()),
              verb);
    }

    /// Rows of B, n x n_dof, column-major; stiffness: n.
    void add_dense_gap_rows(Reals row, Reals stiffness, Reals gap = {}) {
        const std::int64_t n = stiffness.size();
        require_size(row.size(), n * n_dof_, "add_dense_gap_rows", "row");
        if (gap.data()) require_size(gap.size(), n, "add_dense_gap_rows", "gap");
        check(
            plm_model_add_dense_gap_rows(handle_, n, row.data(), n > 0 ? n : 1, stiffness.data(), gap.data()),
            "add_dense_gap_rows");
    }
    /// f(const Recovery &) fills n_full x n_columns; before the build. Throw on failure.
    template <class F> void set_recovery(std::int64_t n_full, F f) {
        living().install_recovery(handle_, n_full, std::move(f));
    }
    /// Motions in the model's DOFs (n_dof x k) on the whole structure.
    Dense<double> recover(Reals reduced) const {
        const std::int64_t n_full = get_int("n_full"), n = reduced.size() / n_dof_;
        require_size(reduced.size(), n * n_dof_, "recover", "reduced");
        Dense<double> full{n_full, n, std::vector<double>(detail::index(n_full * n))};
        finished(plm_model_recover(handle_, n, reduced.data(), n_full, full.values.data()), "recover");
        return full;
    }
    /// Amplitude of a DOF of the whole structure at every point of a branch of this model.
    std::vector<double> recover_amplitude(const Branch &branch, std::int64_t full_dof,
                                          std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                                          std::int32_t harmonic = 0) const;

    /// nullptr removes it.
    void set_preload(Reals force) {
        check(plm_model_set_preload(handle_, force.data() ? force.size() : n_dof_, force.data()),
              "set_preload");
    }
    /// F(t) = Re((real + i imag) exp(i h omega t)); real nullptr removes harmonic h.
    void set_excitation(std::int32_t harmonic, Reals real, Reals imag = {}) {
        if (imag.data()) require_size(imag.size(), n_dof_, "set_excitation", "imag");
        check(plm_model_set_excitation(handle_, harmonic, real.data() ? real.size() : n_dof_, real.data(),
                                       imag.data()),
              "set_excitation");
    }
    /// And omega^power Re((real + i imag) exp(i h omega t)), power 1 or 2: an unbalance has the power 2; real
    /// nullptr removes it.
    void set_growing_excitation(std::int32_t harmonic, std::int32_t power, Reals real, Reals imag = {}) {
        if (imag.data()) require_size(imag.size(), n_dof_, "set_growing_excitation", "imag");
        check(plm_model_set_growing_excitation(handle_, harmonic, power, real.data() ? real.size() : n_dof_,
                                               real.data(), imag.data()),
              "set_growing_excitation");
    }
    /// Motion of fixed DOFs, Re((real + i imag) exp(i h omega t)), zero at all others; quantity:
    /// PLM_DISPLACEMENT, PLM_VELOCITY or PLM_ACCELERATION. Results are relative to the base, but for outputs
    /// with the option "absolute_outputs"; real nullptr removes harmonic h.
    void set_base_motion(std::int32_t quantity, std::int32_t harmonic, Reals real, Reals imag = {}) {
        if (imag.data()) require_size(imag.size(), n_dof_, "set_base_motion", "imag");
        check(plm_model_set_base_motion(handle_, quantity, harmonic, real.data() ? real.size() : n_dof_,
                                        real.data(), imag.data()),
              "set_base_motion");
    }
    /// gap(t) = gap + Re((real + i imag) exp(i h omega t)) of all pairs added so far; real nullptr removes
    /// harmonic h.
    void set_gap_motion(std::int32_t harmonic, Reals real, Reals imag = {}) {
        if (imag.data()) require_size(imag.size(), real.size(), "set_gap_motion", "imag");
        check(plm_model_set_gap_motion(handle_, harmonic, real.size(), real.data(), imag.data()),
              "set_gap_motion");
    }

    /// PLM_OK or PLM_WARNING.
    plm_status build() { return finished(plm_model_build(handle_), "build"); }
    plm_status solve_rest() { return finished(plm_model_solve_rest(handle_), "solve_rest"); }
    /// The n lowest modes of PLM_SYSTEM_...; closed (n_pairs) for PLM_SYSTEM_GIVEN only.
    Modes modes(std::int32_t system, std::int64_t n, View<std::int32_t> closed = {}) const {
        if (closed.data()) require_size(closed.size(), get_int("n_pairs"), "get_modes", "closed");
        require_count(n, "get_modes", "n");
        Modes m;
        m.frequency_hz.resize(detail::index(n));
        m.shape = {n_dof_, n, std::vector<double>(detail::index(n * n_dof_))};
        finished(plm_model_get_modes(handle_, system, closed.data(), n, m.frequency_hz.data(),
                                     m.shape.values.data()),
                 "get_modes");
        return m;
    }
    /// Bytes that it will take at most at once, before the build; by phase: "memory_factor" and the others.
    double estimate_memory() {
        double bytes = 0;
        finished(plm_model_estimate_memory(handle_, &bytes), "estimate_memory");
        return bytes;
    }
    /// Natural frequencies of the open structure below frequency_hz, rigid-body modes included.
    std::int64_t count_modes(double frequency_hz) const {
        std::int64_t n = 0;
        finished(plm_model_count_modes(handle_, frequency_hz, &n), "count_modes");
        return n;
    }
    /// The whole way in one call: sampler, basis, curve and peak, as accurate as asked.
    Response compute_response(std::int64_t dof, std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                              double accuracy = 1e-3) const;
    std::vector<Finding> audit() const {
        std::int64_t n = 0;
        finished(plm_model_audit(handle_, &n), "audit");
        std::vector<Finding> all;
        for (std::int64_t i = 0; i < n; ++i) {
            Finding f{};
            check(
                detail::read_text(
                    [&](auto... x) { return plm_model_get_finding(handle_, i, &f.severity, &f.value, x...); },
                    f.text),
                "get_finding");
            all.push_back(std::move(f));
        }
        return all;
    }

  private:
    void require_pairs(Reals normal, Reals gap, std::int64_t n, const char *verb) const {
        require_size(normal.size(), 3 * n, verb, "normal");
        if (gap.data()) require_size(gap.size(), n, verb, "gap");
    }
    /// How many DOFs a reference node has.
    std::int32_t require_reference(const Indices &dof, Reals xyz, bool wide, const char *verb) const {
        const std::int32_t n = dof.size() > 3 ? 6 : 3;
        require_size(dof.size(), n, verb, "reference_dof");
        require_size(xyz.size(), 3, verb, "reference_xyz");
        require_width(dof, wide, verb, "reference_dof");
        return n;
    }
    /// Both index arrays of a call have the same width; an empty one fits any.
    void require_width(const Indices &x, bool wide, const char *verb, const char *argument) const {
        if (x.size() == 0 || x.is_wide() == wide) return;
        ErrorDetails d;
        d.status = PLM_ERR_ARGUMENT, d.function = full_name(verb), d.argument = argument;
        throw Error(d.function + ": " + argument + " has not the integer type of the array before it", d);
    }
    void require_count(std::int64_t n, const char *verb, const char *argument) const {
        if (n < 0) require_size(n, 0, verb, argument);
    }
    std::int64_t n_dof_;
};

// ---- Sampler and basis -----------------------------------------------------------------------------------

class Sampler : public detail::WithOptions<Sampler, plm_sampler> {
  public:
    explicit Sampler(const Model &model);
    void add_dominant_mode(std::int32_t system, std::int64_t mode) {
        check(plm_sampler_add_dominant_mode(handle_, system, mode), "add_dominant_mode");
    }
    plm_status run() { return finished(plm_sampler_run(handle_), "run"); }
};

namespace detail {
/// Of a range of Branch or of std::reference_wrapper<const Branch>.
template <class Curves> std::vector<plm_branch *> handles_of(const Curves &curves);
} // namespace detail

class Basis : public detail::WithOptions<Basis, plm_basis> {
  public:
    explicit Basis(const Model &model);
    /// What to_bytes() gave, built; without its model until attach().
    static Basis from_bytes(const Context &context, const std::vector<char> &bytes);
    std::vector<char> to_bytes() const { return bytes(plm_basis_write); }
    /// The same bytes to f(std::string_view), piece after piece; it throws on failure.
    template <class F> void write_to(F f) const { hand_to(std::move(f), "write_to", plm_basis_write_to); }
    /// The model that it was made of.
    void attach(const Model &model) { check(plm_basis_attach(handle_, model.c_handle()), "attach"); }
    /// What Branch::to_bytes() gave, of a curve computed on this basis.
    Branch read_branch(const std::vector<char> &bytes) const;
    void set_sampler(const Sampler &sampler) {
        check(plm_basis_set_sampler(handle_, sampler.c_handle()), "set_sampler");
    }
    void set_parent(const Basis &parent) {
        check(plm_basis_set_parent(handle_, parent.handle_), "set_parent");
    }
    void clear_parent() { check(plm_basis_set_parent(handle_, nullptr), "set_parent"); }
    /// For kind "pod": curves computed on the parent, read here; {} forgets them. A range of Branch or of
    /// std::reference_wrapper<const Branch>, or {curve, other}.
    template <class Curves = std::initializer_list<std::reference_wrapper<const Branch>>>
    void set_responses(const Curves &curves) {
        const std::vector<plm_branch *> handles = detail::handles_of(curves);
        check(plm_basis_set_responses(handle_, static_cast<std::int64_t>(handles.size()), handles.data()),
              "set_responses");
    }
    /// PLM_OK, or PLM_WARNING: see get_string("warning").
    plm_status build() { return finished(plm_basis_build(handle_), "build"); }
    /// P, or P_0 if is_static.
    Dense<double> vectors(bool is_static = false) const {
        const std::int64_t n = get_int(is_static ? "static_size" : "size");
        Dense<double> p{n_dof_, n, std::vector<double>(detail::index(n * n_dof_))};
        if (n > 0)
            check(plm_basis_get_vectors(handle_, is_static, 0, n, p.values.data(), n_dof_), "get_vectors");
        return p;
    }
    double residual(Reals q, bool is_static = false, bool use_mass = false) const {
        double r = 0;
        check(plm_basis_get_residual(handle_, is_static, use_mass, q.size(), q.data(), &r), "get_residual");
        return r;
    }

  private:
    friend class Hbm;
    Basis(detail::StatePtr state, plm_basis *handle, std::int64_t n_dof)
        : WithOptions(std::move(state), handle), n_dof_(n_dof) {}
    std::int64_t n_dof_;
};

// ---- Response --------------------------------------------------------------------------------------------

struct Energy {          // means over the period
    double energy;       // mechanical, with the potential of the pre-load; less that of the structure at rest
    double contact_area; // closed share of the pairs
};
struct Contact { // over the cycle, each n_pairs x n_times
    Dense<double> penetration, force;
    Dense<std::int32_t> closed;
};

class Branch : public detail::Handle<plm_branch> {
  public:
    /// PLM_OK, PLM_WARNING, PLM_NOT_CONVERGED, PLM_TRUNCATED or PLM_CANCELLED, as the call that made it
    /// returned; get_string("warning") and get_string("end_text") say why.
    plm_status status() const { return status_; }
    std::int64_t size() const { return get_int("n_points"); }
    std::vector<double> frequency_hz() const { return get_array("frequency_hz"); }
    /// PLM_BIFURCATION_... of every point.
    std::vector<std::int64_t> bifurcation() const { return get_int_array("bifurcation"); }
    /// 1 stable, 0 unstable, -1 not computed, of every point.
    std::vector<std::int64_t> stable() const { return get_int_array("stable"); }

    /// measure: PLM_PEAK, PLM_HALF_PEAK_TO_PEAK, PLM_RMS or PLM_HARMONIC.
    std::vector<double> amplitude(std::int64_t dof, std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                                  std::int32_t harmonic = 0) const {
        std::int64_t n = size();
        std::vector<double> a(detail::index(n));
        check(plm_branch_get_amplitude(handle_, dof, measure, harmonic, n, a.data(), &n), "get_amplitude");
        return a;
    }
    /// (2H + 1) x n: a0, a1, b1, ..., aH, bH of the DOFs [first_dof, first_dof + n).
    Dense<double> coefficients(std::int64_t point, std::int64_t first_dof, std::int64_t n) const {
        const std::int64_t rows = 2 * get_int("n_harmonics") + 1;
        Dense<double> c{rows, n, std::vector<double>(detail::index(n > 0 ? rows * n : 0))};
        check(plm_branch_get_coefficients(handle_, point, first_dof, n, c.values.data()), "get_coefficients");
        return c;
    }
    /// Of an exact motion itself, not of its harmonics: q at n_times equidistant times of the period.
    std::vector<double> history(std::int64_t point, std::int64_t dof, std::int64_t n_times) const {
        std::vector<double> q(detail::index(n_times > 0 ? n_times : 0));
        check(plm_branch_get_history(handle_, point, dof, n_times, q.data()), "get_history");
        return q;
    }
    std::vector<double> field(std::int64_t point, double time_fraction) const {
        std::vector<double> q(detail::index(get_int("n_dof")));
        check(plm_branch_get_field(handle_, point, time_fraction, static_cast<std::int64_t>(q.size()),
                                   q.data()),
              "get_field");
        return q;
    }
    Contact contact(std::int64_t point, std::int64_t n_times) const {
        const std::int64_t z = get_int("n_pairs");
        const std::size_t total = detail::index(n_times > 0 ? z * n_times : 0);
        Contact c{{z, n_times, std::vector<double>(total)},
                  {z, n_times, std::vector<double>(total)},
                  {z, n_times, std::vector<std::int32_t>(total)}};
        check(plm_branch_get_contact(handle_, point, n_times, c.penetration.values.data(),
                                     c.force.values.data(), c.closed.values.data()),
              "get_contact");
        return c;
    }
    std::vector<double> closed_share(std::int64_t point) const {
        std::vector<double> share(detail::index(get_int("n_pairs")));
        check(plm_branch_get_closed_share(handle_, point, static_cast<std::int64_t>(share.size()),
                                          share.data()),
              "get_closed_share");
        return share;
    }
    Energy energy(std::int64_t point) const {
        Energy e{};
        finished(plm_branch_get_energy(handle_, point, &e.energy, &e.contact_area), "get_energy");
        return e;
    }
    /// Floquet multipliers, largest modulus first; empty where they were not computed (option "stability").
    std::vector<std::complex<double>> multipliers(std::int64_t point) const {
        return complex_array([&](auto... x) { return plm_branch_get_multipliers(handle_, point, x...); },
                             "get_multipliers");
    }
    double periodicity_defect(std::int64_t point) const {
        double defect = 0;
        finished(plm_branch_get_periodicity_defect(handle_, point, &defect), "get_periodicity_defect");
        return defect;
    }
    std::vector<char> to_bytes() const { return bytes(plm_branch_write); }
    /// The same bytes to f(std::string_view), piece after piece; it throws on failure.
    template <class F> void write_to(F f) const { hand_to(std::move(f), "write_to", plm_branch_write_to); }
    /// A page of text about the curve: peak, stability, error, warnings and the rest.
    std::string describe() const {
        std::string text;
        check(detail::read_text([&](auto... a) { return plm_branch_describe(handle_, a...); }, text),
              "describe");
        return text;
    }
    /// The curve as comma-separated text, with the amplitude of this DOF.
    void write_csv(const std::string &path, std::int64_t dof, std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                   std::int32_t harmonic = 0) const {
        check(plm_branch_write_csv(handle_, dof, measure, harmonic, path.c_str()), "write_csv");
    }
    /// The same text to f(std::string_view).
    template <class F>
    void write_csv_to(F f, std::int64_t dof, std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                      std::int32_t harmonic = 0) const {
        hand_to(std::move(f), "write_csv_to", plm_branch_write_csv_to, dof, measure, harmonic);
    }
    double full_residual(std::int64_t point) const {
        double r = 0;
        finished(plm_branch_get_full_residual(handle_, point, &r), "get_full_residual");
        return r;
    }

  private:
    friend class Model;
    friend class Basis;
    friend class Hbm;
    friend class Study;
    template <class Curves> friend std::vector<plm_branch *> detail::handles_of(const Curves &);
    Branch(detail::StatePtr state, plm_branch *handle, plm_status status)
        : Handle(std::move(state), handle), status_(status) {}
    plm_status status_;
};

namespace detail {
template <class Curves> std::vector<plm_branch *> handles_of(const Curves &curves) {
    std::vector<plm_branch *> handles;
    for (const Branch &b : curves) handles.push_back(b.handle_);
    return handles;
}
} // namespace detail

struct ErrorParts { // corrected less computed
    double basis, contact, harmonics;
    double sum() const { return basis + contact + harmonics; }
};
struct ErrorEstimate {
    ErrorParts amplitude, frequency_hz;
};
struct Peak {
    double frequency_hz, amplitude;
    Branch branch; // of one point
};
struct Isolated {
    Branch branch;
    std::array<double, 2> force_range; // force scales between which it exists, NaN where unknown
};

struct Refined {
    Basis basis;
    double error; // of the reduction, estimated
};

class Hbm : public detail::WithOptions<Hbm, plm_hbm> {
  public:
    explicit Hbm(const Basis &basis);
    Branch sweep() {
        plm_branch *b = nullptr;
        const plm_status s = plm_hbm_sweep(handle_, &b);
        return deliver(s, b, "sweep");
    }
    /// Sweeps write the curve to this file after every so many points, and at their end; 0: no longer.
    void save_every(std::int64_t n_points, const std::string &path = "") {
        check(plm_hbm_save_every(handle_, n_points, path.c_str()), "save_every");
    }
    /// Goes on with a curve that was cancelled, ended by "max_points" or effort, or was saved on its way.
    Branch resume(const Branch &branch) {
        plm_branch *b = nullptr;
        const plm_status s = plm_hbm_resume(handle_, branch.handle_, &b);
        return deliver(s, b, "resume");
    }
    Branch solve(double frequency_hz) { return solve(frequency_hz, nullptr, 0); }
    /// First guess: point `point` of `start`.
    Branch solve(double frequency_hz, const Branch &start, std::int64_t point) {
        return solve(frequency_hz, start.handle_, point);
    }
    Peak find_peak(const Branch &branch, std::int64_t dof, std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                   std::int32_t harmonic = 0) {
        double hz = 0, amplitude = 0;
        plm_branch *b = nullptr;
        const plm_status s =
            plm_hbm_find_peak(handle_, branch.handle_, dof, measure, harmonic, &hz, &amplitude, &b);
        return {hz, amplitude, deliver(s, b, "find_peak")};
    }
    /// How wrong a point of `branch` is, without the unreduced solution; NaN where that cannot be told.
    ErrorEstimate estimate_error(const Branch &branch, std::int64_t point, std::int64_t dof,
                                 std::int32_t measure = PLM_HALF_PEAK_TO_PEAK, std::int32_t harmonic = 0) {
        double a[3] = {}, f[3] = {};
        finished(plm_hbm_estimate_error(handle_, branch.handle_, point, dof, measure, harmonic, a, f),
                 "estimate_error");
        return {{a[0], a[1], a[2]}, {f[0], f[1], f[2]}};
    }
    /// A small basis on which the curve's error of reduction is estimated to be below `tolerance`, whatever
    /// the basis of this hbm; where it cannot be reached, `error` says what is left.
    Refined refine_basis(std::int64_t dof, double tolerance, std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                         std::int32_t harmonic = 0) {
        double error = 0;
        plm_basis *b = nullptr;
        const plm_status s = plm_hbm_refine_basis(handle_, dof, measure, harmonic, tolerance, &b, &error);
        Basis basis(state_, b, n_dof_); // first of all: check may throw
        finished(s, "refine_basis");
        return {std::move(basis), error};
    }

    /// The curve that leaves `branch` at a located branch point or period doubling, see Branch::bifurcation.
    Branch switch_branch(const Branch &branch, std::int64_t point, bool mirrored = false) {
        plm_branch *b = nullptr;
        const plm_status s = plm_hbm_switch_branch(handle_, branch.handle_, point, mirrored, &b);
        return deliver(s, b, "switch_branch");
    }
    /// A curve at each of these force scales, in their order; none where a level has no first motion. Where
    /// one ended early a branch says so.
    std::vector<Branch> sweep_levels(Reals force_scale) {
        std::int64_t n = 0;
        finished(plm_hbm_sweep_levels(handle_, force_scale.size(), force_scale.data(), &n), "sweep_levels");
        return found(n);
    }
    /// Isolated branches beside the whole main curve; force_max 0: eight times "force_scale".
    std::vector<Isolated> find_isolated(const Branch &main_branch, double force_max = 0) {
        std::int64_t n = 0;
        finished(plm_hbm_find_isolated(handle_, main_branch.handle_, force_max, &n), "find_isolated");
        return found();
    }
    /// What the last search of this hbm found, or the curve beside that of Model::compute_response whose
    /// highest stable motion is "larger_amplitude" at "larger_frequency_hz".
    std::vector<Isolated> found() {
        const std::int64_t n = get_int("n_found");
        std::vector<Isolated> all;
        for (std::int64_t i = 0; i < n; ++i) {
            std::array<double, 2> range{};
            Branch b = found(i, range.data());
            all.push_back({std::move(b), range});
        }
        return all;
    }
    /// The phase-resonant backbones: resonance against force, see "point_force_scale" of their points.
    std::vector<Branch> find_backbones(double force_max = 0) {
        std::int64_t n = 0;
        finished(plm_hbm_find_backbones(handle_, force_max, &n), "find_backbones");
        return found(n);
    }
    /// Branches on none of the known ones, by marching in time from rest and from n_states states: 1, 2, 4,
    /// ... times the largest response on the known ones. known: a range of Branch or of
    /// std::reference_wrapper<const Branch>, or {curve, other}.
    template <class Curves = std::initializer_list<std::reference_wrapper<const Branch>>>
    std::vector<Branch> find_by_marching(const Curves &known, std::int64_t n_frequencies,
                                         std::int64_t n_states) {
        const std::vector<plm_branch *> curves = detail::handles_of(known);
        std::int64_t n = 0;
        finished(plm_hbm_find_by_marching(handle_, static_cast<std::int64_t>(curves.size()), curves.data(),
                                          n_frequencies, n_states, &n),
                 "find_by_marching");
        return found(n);
    }
    /// The curve of folds over frequency and force scale from a located fold.
    Branch track_fold(const Branch &branch, std::int64_t point, double force_min, double force_max) {
        plm_branch *b = nullptr;
        const plm_status s = plm_hbm_track_fold(handle_, branch.handle_, point, force_min, force_max, &b);
        return deliver(s, b, "track_fold");
    }
    /// Motion without excitation, from mode 1, 2, ... about the contact at rest until the DOF's first
    /// harmonic reaches amplitude_max; 0: to a hundred times the amplitude at which a pair first opens or
    /// closes.
    Branch find_nonlinear_mode(std::int64_t mode, std::int64_t dof, double amplitude_max = 0) {
        plm_branch *b = nullptr;
        const plm_status s = plm_hbm_find_nonlinear_mode(handle_, mode, dof, amplitude_max, &b);
        return deliver(s, b, "find_nonlinear_mode");
    }

  private:
    friend class Model;
    Hbm(detail::StatePtr state, plm_hbm *handle, std::int64_t n_dof)
        : WithOptions(std::move(state), handle), n_dof_(n_dof) {}
    Branch found(std::int64_t i, double *force_range) {
        plm_branch *b = nullptr;
        const plm_status s = plm_hbm_get_found(handle_, i, force_range, &b);
        return deliver(s, b, "get_found");
    }
    std::vector<Branch> found(std::int64_t n) {
        std::vector<Branch> all;
        for (std::int64_t i = 0; i < n; ++i) all.push_back(found(i, nullptr));
        return all;
    }
    Branch solve(double frequency_hz, plm_branch *start, std::int64_t point) {
        plm_branch *b = nullptr;
        const plm_status s = plm_hbm_solve(handle_, frequency_hz, start, point, &b);
        return deliver(s, b, "solve");
    }
    Branch deliver(plm_status status, plm_branch *b, const char *verb) const {
        Branch branch(state_, b, status); // first of all: check may throw
        check(status, verb);
        if (!b) living().fail(status, full_name(verb).c_str()); // stopped before the first point
        return branch;
    }
    std::int64_t n_dof_;
};

struct Response {
    double frequency_hz, amplitude; // of the peak
    double error;                   // of it by the basis, relative, estimated; NaN: not known
    Branch curve;
    Hbm hbm; // that computed it
};

// ---- Transient -------------------------------------------------------------------------------------------

struct MotionState {
    std::vector<double> q, v; // displacement and velocity of all DOFs
};

class Transient : public detail::WithOptions<Transient, plm_transient> {
  public:
    /// The full model, by implicit time steps.
    explicit Transient(const Model &model) : Transient(model, nullptr) {}
    /// The reduced model, by its exact flow.
    Transient(const Model &model, const Basis &basis) : Transient(model, basis.c_handle()) {}

    /// The DOFs whose motion the next runs record; {} records none.
    void observe(Indices dof, std::int32_t index_base = 0) {
        check(dof.is_wide() ? plm_transient_observe_i64(handle_, index_base, dof.size(), dof.wide())
                            : plm_transient_observe_i32(handle_, index_base, dof.size(), dof.narrow()),
              dof.is_wide() ? "observe_i64" : "observe_i32");
    }
    /// q and v: n_dof or nullptr (zero), at the beginning of a period.
    void set_state(Reals q, Reals v = {}) {
        if (q.data() && v.data()) require_size(v.size(), q.size(), "set_state", "v");
        const std::int64_t n = q.data() ? q.size() : v.data() ? v.size() : n_dof_;
        finished(plm_transient_set_state(handle_, n, q.data(), v.data()), "set_state");
    }
    /// State, frequency and force scale of a point of a response curve.
    void start_at(const Branch &branch, std::int64_t point) {
        finished(plm_transient_start_at(handle_, branch.c_handle(), point), "start_at");
    }
    /// PLM_OK, or PLM_CANCELLED: what was marched is kept.
    plm_status run() {
        const plm_status s = plm_transient_run(handle_);
        check(s, "run");
        return s;
    }
    /// PLM_OK, or PLM_NOT_CONVERGED or PLM_CANCELLED: see "periodicity_defect".
    plm_status find_periodic() {
        const plm_status s = plm_transient_find_periodic(handle_);
        check(s, "find_periodic");
        return s;
    }
    MotionState state() const {
        MotionState now;
        now.q.resize(detail::index(n_dof_)), now.v.resize(detail::index(n_dof_));
        check(plm_transient_get_state(handle_, n_dof_, now.q.data(), now.v.data()), "get_state");
        return now;
    }
    /// Displacement of the observed DOF number `observed` at the instants get_array("time").
    std::vector<double> history(std::int64_t observed) const {
        std::int64_t n = 0;
        check(plm_transient_get_history(handle_, observed, 0, nullptr, &n), "get_history");
        std::vector<double> values(detail::index(n));
        if (n > 0) check(plm_transient_get_history(handle_, observed, n, values.data(), &n), "get_history");
        return values;
    }
    /// Floquet multipliers of the motion find_periodic found.
    std::vector<std::complex<double>> multipliers() const {
        return complex_array([&](auto... x) { return plm_transient_get_multipliers(handle_, x...); },
                             "get_multipliers");
    }

  private:
    Transient(const Model &model, plm_basis *basis);
    std::int64_t n_dof_;
};

// ---- Study -----------------------------------------------------------------------------------------------

struct StudyPoints { // of a curve, of the amplitude looked at
    std::vector<double> frequency_hz, amplitude;
};

/// Results by key have one entry per method: get_array("curve_error_l2"), get_int_array("basis_size"), ...
class Study : public detail::WithOptions<Study, plm_study> {
  public:
    /// In the place of a method's index.
    static constexpr std::int64_t reference = -1;

    explicit Study(const Model &model);
    void set_output(std::int64_t dof, std::int32_t measure = PLM_HALF_PEAK_TO_PEAK,
                    std::int32_t harmonic = 0) {
        check(plm_study_set_output(handle_, dof, measure, harmonic), "set_output");
    }
    void set_force_levels(Reals scale) {
        check(plm_study_set_force_levels(handle_, scale.size(), scale.data()), "set_force_levels");
    }
    void set_reference(const Hbm &hbm) {
        check(plm_study_set_reference(handle_, hbm.c_handle()), "set_reference");
    }
    /// Back to the unreduced structure.
    void reset_reference() { check(plm_study_set_reference(handle_, nullptr), "set_reference"); }

    // Methods; the result is the method's index, from 0. Options are read here: hbm and motion may change
    // afterwards.
    std::int64_t add_response(const std::string &name, const Hbm &hbm) {
        std::int64_t i = 0;
        check(plm_study_add_response(handle_, name.c_str(), hbm.c_handle(), &i), "add_response");
        return i;
    }
    /// size 0: as many columns as "pod_tolerance" asks for.
    std::int64_t add_compressed(const std::string &name, const Hbm &hbm, std::int64_t size = 0) {
        std::int64_t i = 0;
        check(plm_study_add_compressed(handle_, name.c_str(), hbm.c_handle(), size, &i), "add_compressed");
        return i;
    }
    std::int64_t add_refined(const std::string &name, const Hbm &hbm, double tolerance) {
        std::int64_t i = 0;
        check(plm_study_add_refined(handle_, name.c_str(), hbm.c_handle(), tolerance, &i), "add_refined");
        return i;
    }
    std::int64_t add_marching(const std::string &name, const Transient &motion, std::int64_t n_frequencies) {
        std::int64_t i = 0;
        check(plm_study_add_marching(handle_, name.c_str(), motion.c_handle(), n_frequencies, &i),
              "add_marching");
        return i;
    }

    /// PLM_OK; PLM_WARNING: a method failed or ended early, see outcome; PLM_CANCELLED: the methods run until
    /// then are there.
    plm_status run() {
        const plm_status s = plm_study_run(handle_);
        check(s, "run");
        return s;
    }
    // Of a method, or Study::reference.
    std::string name(std::int64_t index) const { return text(plm_study_get_name, index, "get_name"); }
    std::string outcome(std::int64_t index) const {
        return text(plm_study_get_outcome, index, "get_outcome");
    }
    Branch curve(std::int64_t index, std::int64_t level = 0) const {
        plm_branch *b = nullptr;
        const plm_status s = plm_study_get_curve(handle_, index, level, &b);
        Branch branch(state_, b, s); // first of all: check may throw
        check(s, "get_curve");
        return branch;
    }
    StudyPoints points(std::int64_t index, std::int64_t level = 0) const {
        std::int64_t n = 0;
        check(plm_study_get_points(handle_, index, level, 0, nullptr, nullptr, &n), "get_points");
        StudyPoints p{std::vector<double>(detail::index(n)), std::vector<double>(detail::index(n))};
        if (n > 0)
            check(
                plm_study_get_points(handle_, index, level, n, p.frequency_hz.data(), p.amplitude.data(), &n),
                "get_points");
        return p;
    }
    /// report.md, table.csv and the curves, into a folder that is made if its parent exists.
    void write(const std::string &folder) const { check(plm_study_write(handle_, folder.c_str()), "write"); }

  private:
    template <class Read> std::string text(Read read, std::int64_t index, const char *verb) const {
        std::string x;
        check(detail::read_text([&](auto... a) { return read(handle_, index, a...); }, x), verb);
        return x;
    }
};

// The constructors read protected members of another handle only through these two.
namespace detail {
template <class C> struct Access : Handle<C> {
    static const StatePtr &state(const Handle<C> &h) {
        (h.*(&Access::living))();
        return h.*(&Access::state_);
    }
};
} // namespace detail

inline Sampler::Sampler(const Model &model) : WithOptions(detail::Access<plm_model>::state(model), nullptr) {
    check(plm_sampler_create(model.c_handle(), &handle_), "create");
}
inline Basis::Basis(const Model &model)
    : WithOptions(detail::Access<plm_model>::state(model), nullptr), n_dof_(model.n_dof()) {
    check(plm_basis_create(model.c_handle(), &handle_), "create");
}
inline Basis Basis::from_bytes(const Context &context, const std::vector<char> &bytes) {
    const detail::StatePtr &state = context.state();
    plm_basis *read = nullptr;
    state->check(plm_basis_read(state->context, static_cast<std::int64_t>(bytes.size()), bytes.data(), &read),
                 "plm_basis_read");
    Basis basis(state, read, 0);
    basis.n_dof_ = basis.get_int("n_dof");
    return basis;
}
inline Branch Basis::read_branch(const std::vector<char> &bytes) const {
    plm_branch *read = nullptr;
    check(plm_branch_read(handle_, static_cast<std::int64_t>(bytes.size()), bytes.data(), &read),
          "plm_branch_read");
    return Branch(state_, read, PLM_OK);
}
inline Hbm::Hbm(const Basis &basis)
    : WithOptions(detail::Access<plm_basis>::state(basis), nullptr), n_dof_(basis.n_dof_) {
    check(plm_hbm_create(basis.c_handle(), &handle_), "create");
}
inline Response Model::compute_response(std::int64_t dof, std::int32_t measure, double accuracy) const {
    double hz = 0, amplitude = 0, error = 0;
    plm_branch *curve = nullptr;
    plm_hbm *solver = nullptr;
    const plm_status s =
        plm_model_compute_response(handle_, dof, measure, accuracy, &hz, &amplitude, &error, &curve, &solver);
    Response r{hz, amplitude, error, Branch(state_, curve, s),
               Hbm(state_, solver, n_dof_)}; // check may throw
    finished(s, "compute_response");
    return r;
}
inline std::vector<double> Model::recover_amplitude(const Branch &branch, std::int64_t full_dof,
                                                    std::int32_t measure, std::int32_t harmonic) const {
    std::int64_t n = branch.size();
    std::vector<double> a(detail::index(n));
    finished(
        plm_model_recover_amplitude(handle_, branch.c_handle(), full_dof, measure, harmonic, n, a.data(), &n),
        "recover_amplitude");
    return a;
}
inline Transient::Transient(const Model &model, plm_basis *basis)
    : WithOptions(detail::Access<plm_model>::state(model), nullptr), n_dof_(model.n_dof()) {
    check(plm_transient_create(model.c_handle(), basis, &handle_), "create");
}
inline Study::Study(const Model &model) : WithOptions(detail::Access<plm_model>::state(model), nullptr) {
    check(plm_study_create(model.c_handle(), &handle_), "create");
}

} // namespace cpp
} // namespace plm

#endif // PLM_PLM_HPP
