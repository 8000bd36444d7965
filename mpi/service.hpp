// What a host's handle holds: what its ranks handed over, and the steps in which the brain tells the others
// what to do.
#pragma once
#include "mpi/executor.hpp"
#include <functional>

namespace plm::mpi {

constexpr std::int32_t of_preload = -1;

struct Load {
    std::int64_t dof;
    std::int32_t harmonic; // or of_preload
    double real, imag;
};

/// A gap row comes whole, from whichever rank has it: its coefficients, and its pair's stiffness and gap.
struct GapRow {
    double stiffness, gap;
    std::int64_t terms;
};
struct GapTerm {
    std::int64_t dof;
    double coefficient;
};

/// Of one rank, base 0, checked.
struct Parts {
    std::vector<std::int64_t> owned;
    MatrixParts matrices;
    std::vector<GapRow> rows;
    std::vector<GapTerm> terms;
    std::vector<Load> loads;
};

/// Receives the entries of a field at the DOFs that this rank owns (ascending, base 0). 0: success.
using FieldReceiver = std::function<std::int32_t(const std::vector<std::int64_t> &dof, const double *value)>;

class Service {
  public:
    /// Throws where the host has not started MPI, or has ended it.
    static void require_mpi_running();
    /// Collective, before all else; mine: what has befallen this rank. Throws on all ranks alike.
    void start(MPI_Comm host, std::int64_t n_dof, const Verdict &mine);
    /// Collective, the last of it.
    void close();

    Team &team() { return team_; }
    std::int64_t n_dof() const { return n_dof_; }
    Parts parts;
    FieldReceiver receiver;
    /// A call of this rank alone has failed; all hear of it when they assemble.
    void remember(const Verdict &failure);

    // --- the brain's; the others are in serve()
    /// Sums the parts of all ranks up; `all` receives gap rows and loads of all ranks. Throws.
    void assemble(Parts &all);
    /// Throws what befell a rank.
    void perform(Call call);
    /// Hands each rank its entries of n_dof values.
    void deliver_field(const double *values);
    /// Sends the others home; `outcome` is what serve() says there.
    void dismiss(const Verdict &outcome);
    bool is_dismissed() const { return dismissed_; }
    bool is_assembled() const { return assembled_; }

    /// Of the others: does what the brain says until it dismisses them, with this.
    Verdict serve();

  private:
    enum : std::int64_t { to_assemble = -1, to_deliver = -2, to_dismiss = -3 };
    struct Order {
        std::int64_t what = 0;
        CallSizes sizes;
        Verdict outcome;
    };
    void make_room(const CallSizes &sizes);
    void step(const Order &order, Call call);
    void assemble_here(Parts &all);
    void receive_field(const double *values);

    Team team_;
    std::int64_t n_dof_ = 0;
    Verdict failed_;
    bool assembled_ = false, dismissed_ = false;
    std::unique_ptr<Executor> executor_;
    CallSizes room_; // of the arrays below, the same numbers on all ranks
    std::vector<std::int64_t> number_;
    std::vector<double> factor_, in_, out_;
};

} // namespace plm::mpi
