// plm_mpi.hpp - plm_mpi.h for C++17 and later, beside plm.hpp and by its rules. Needs no mpi.h.
//
//     plm::Team team(MPI_Comm_c2f(comm), n_dof);                 all ranks
//     team.own_dofs(dof), add_entries(...), fix_dofs(...) ...    all ranks, each its own part
//     if (rank == 0) {
//         plm::Model model = team.create_model(ctx);             then model.build() ... as ever
//         team.dismiss();
//     } else
//         team.serve();                                          until rank 0 dismisses
//
// A failure throws plm::Error with the team's words. What throws on one rank leaves no rank waiting: where a
// Team goes, rank 0 dismisses the others, and the others serve until then. All ranks must let it go, however.
#ifndef PLM_PLM_MPI_HPP
#define PLM_PLM_MPI_HPP

#include "plm/plm.hpp"
#include "plm/plm_mpi.h"

namespace plm {
inline namespace cpp {

class Team {
  public:
    /// f(View<std::int64_t> dof, Reals value): a field at the DOFs that this rank owns.
    using Receive = std::function<void(View<std::int64_t>, Reals)>;

    /// Collective.
    Team(std::int32_t fortran_communicator, std::int64_t n_dof)
        : n_dof_(n_dof), receiver_(std::make_unique<Receiver>()) {
        check(plm_team_create(fortran_communicator, n_dof, &handle_), "plm_team_create");
    }
    Team(Team &&other) noexcept
        : handle_(std::exchange(other.handle_, nullptr)), n_dof_(other.n_dof_),
          receiver_(std::move(other.receiver_)) {}
    Team &operator=(Team &&other) noexcept {
        std::swap(handle_, other.handle_);
        std::swap(n_dof_, other.n_dof_);
        std::swap(receiver_, other.receiver_);
        return *this;
    }
    /// Collective.
    ~Team() { plm_team_destroy(&handle_); }

    std::int64_t n_dof() const { return n_dof_; }
    plm_team *c_handle() const { return handle_; }

    /// Integers of 32 bits are widened. index_base: 0 or 1, here and below.
    void own_dofs(Indices dof, std::int32_t index_base = 0) {
        const Wide d(dof);
        check(plm_team_own_dofs_i64(handle_, index_base, d.size(), d.data()), "plm_team_own_dofs_i64");
    }
    /// which: PLM_MASS, PLM_STIFFNESS or PLM_DAMPING; part: PLM_FULL, PLM_LOWER or PLM_UPPER.
    void add_entries(std::int32_t which, Indices row, Indices column, Reals value,
                     std::int32_t part = PLM_FULL, std::int32_t index_base = 0) {
        const char *function = "plm_team_add_entries_i64";
        require_size(row.size(), value.size(), function, "row");
        require_size(column.size(), value.size(), function, "column");
        const Wide r(row), c(column);
        check(plm_team_add_entries_i64(handle_, which, part, index_base, value.size(), r.data(), c.data(),
                                       value.data()),
              function);
    }
    void fix_dofs(Indices dof, std::int32_t index_base = 0) {
        const Wide d(dof);
        check(plm_team_fix_dofs_i64(handle_, index_base, d.size(), d.data()), "plm_team_fix_dofs_i64");
    }
    /// row_ptr has one entry more than there are rows.
    void add_gap_rows(Indices row_ptr, Indices dof, Reals coefficient, Reals stiffness, Reals gap,
                      std::int32_t index_base = 0) {
        const char *function = "plm_team_add_gap_rows_i64";
        require_size(row_ptr.size(), stiffness.size() + 1, function, "row_ptr");
        require_size(gap.size(), stiffness.size(), function, "gap");
        const Wide p(row_ptr), d(dof);
        require_size(dof.size(), p.data()[stiffness.size()], function, "dof");
        require_size(coefficient.size(), dof.size(), function, "coefficient");
        check(plm_team_add_gap_rows_i64(handle_, index_base, stiffness.size(), p.data(), d.data(),
                                        coefficient.data(), stiffness.data(), gap.data()),
              function);
    }
    void add_preload(Indices dof, Reals force, std::int32_t index_base = 0) {
        require_size(force.size(), dof.size(), "plm_team_add_preload_i64", "force");
        const Wide d(dof);
        check(plm_team_add_preload_i64(handle_, index_base, d.size(), d.data(), force.data()),
              "plm_team_add_preload_i64");
    }
    /// imag may be left out: zero.
    void add_excitation(std::int32_t harmonic, Indices dof, Reals real, Reals imag = {},
                        std::int32_t index_base = 0) {
        const char *function = "plm_team_add_excitation_i64";
        require_size(real.size(), dof.size(), function, "real");
        if (imag.size() > 0) require_size(imag.size(), dof.size(), function, "imag");
        const Wide d(dof);
        check(plm_team_add_excitation_i64(handle_, harmonic, index_base, d.size(), d.data(), real.data(),
                                          imag.size() > 0 ? imag.data() : nullptr),
              function);
    }
    /// Who receives fields on this rank; nullptr: nobody.
    void on_field(Receive f) {
        living().run = std::move(f);
        check(plm_team_set_field(handle_, living().run ? on_field_of : nullptr, receiver_.get()),
              "plm_team_set_field");
    }

    /// Rank 0.
    Model create_model(const Context &context) {
        plm_model *model = nullptr;
        check(plm_team_create_model(handle_, context.c_handle(), &model), "plm_team_create_model");
        return Model(context, model, n_dof_);
    }
    /// Rank 0: each rank's function receives its part of n_dof values.
    void deliver(Reals value) {
        check(plm_team_deliver(handle_, value.size(), value.data()), "plm_team_deliver");
    }
    /// Rank 0. The others throw where outcome is a failure.
    void dismiss(plm_status outcome = PLM_OK) {
        check(plm_team_dismiss(handle_, outcome), "plm_team_dismiss");
    }
    /// The other ranks. Returns what rank 0 gave as outcome.
    plm_status serve() {
        const plm_status outcome = plm_team_serve(handle_);
        check(outcome, "plm_team_serve");
        return outcome;
    }

  private:
    struct Receiver {
        Receive run;
        std::exception_ptr thrown;
    };
    class Wide {
      public:
        explicit Wide(const Indices &i) : data_(i.wide()), size_(i.size()) {
            if (i.is_wide() || size_ == 0) return;
            copy_.assign(i.narrow(), i.narrow() + size_);
            data_ = copy_.data();
        }
        Wide(const Wide &) = delete;
        const std::int64_t *data() const { return data_; }
        std::int64_t size() const { return size_; }

      private:
        std::vector<std::int64_t> copy_;
        const std::int64_t *data_;
        std::int64_t size_;
    };

    static std::int32_t on_field_of(plm_team *, std::int64_t n, const std::int64_t *dof, const double *value,
                                    void *user) noexcept {
        auto *receiver = static_cast<Receiver *>(user);
        try {
            receiver->run(View<std::int64_t>(dof, n), Reals(value, n));
            return 0;
        } catch (...) {
            receiver->thrown = std::current_exception();
            return 1;
        }
    }
    [[noreturn]] static void fail(plm_status status, const char *function, const char *argument,
                                  const std::string &text) {
        ErrorDetails d;
        d.status = status, d.function = function, d.argument = argument;
        throw Error(text, d);
    }
    Receiver &living() {
        if (!receiver_) fail(PLM_ERR_HANDLE, "plm_team", "", "plm_team: this object was moved from");
        return *receiver_;
    }
    /// What this rank's own function threw goes before what the team says of it.
    void check(plm_status status, const char *function) {
        if (living().thrown) std::rethrow_exception(std::exchange(living().thrown, nullptr));
        if (status >= 0) return;
        std::string text;
        detail::read_text([&](auto... x) { return plm_team_get_error_text(handle_, x...); }, text);
        if (text.empty()) {
            detail::read_text([&](auto... x) { return plm_status_text(status, x...); }, text);
            text = std::string(function) + ": " + text;
        }
        fail(status, function, "", text);
    }
    static void require_size(std::int64_t size, std::int64_t needed, const char *function,
                             const char *argument) {
        if (size != needed)
            fail(PLM_ERR_ARGUMENT, function, argument,
                 std::string(function) + ": " + argument + " has " + std::to_string(size) +
                     " entries, needed are " + std::to_string(needed));
    }

    plm_team *handle_ = nullptr;
    std::int64_t n_dof_;
    std::unique_ptr<Receiver> receiver_;
};

} // namespace cpp
} // namespace plm

#endif
