// The tall operations of plm.h on the rows of this rank. Every rank runs the same one at the same time; what
// is small comes from the brain and goes back to it.
#pragma once
#include "mpi/mumps_factor.hpp"
#include <cstdlib>
#include <map>
#include <memory>

namespace plm::mpi {

/// The numbers are those of PLM_TALL_... in plm.h.
enum class Operation : std::int32_t {
    end = 0,
    free = 1,
    facts = 2,
    fill = 3,
    copy = 4,
    combine = 5,
    gram = 6,
    apply = 7,
    factor = 8,
    solve = 9,
    responses = 10,
    rows = 11,
    set_rows = 12,
    look = 13,
    energy = 14,
    residual = 15,
    diagonal = 16
};

/// One operation. Of the pointers the first three hold the same on all ranks; `out` is the brain's result,
/// elsewhere room for a share of it.
struct Call {
    Operation operation = Operation::end;
    const std::int64_t *number = nullptr;
    const double *factor = nullptr, *in = nullptr;
    double *out = nullptr;
};

/// How many numbers a call has, for those who hear of it.
struct CallSizes {
    std::int64_t number = 0, factor = 0, in = 0;
    std::int64_t out = 0;  // that `out` must have room for on ranks other than the brain
    bool in_stays = false; // `in` is as long as the structure: the brain alone has it
};
/// Throws for an operation that does not exist.
CallSizes sizes_of(Operation operation, const std::int64_t *number);

class Executor {
  public:
    explicit Executor(Team &team) : team_(team) {}
    Executor(const Executor &) = delete;
    Executor &operator=(const Executor &) = delete;
    /// Collective, before all else.
    void begin(Rows rows, MatrixParts &parts);
    /// Collective; throws on all ranks alike.
    void run(const Call &call);
    /// Collective: gives up all blocks and factors.
    void end();
    const Rows &rows() const { return rows_; }

  private:
    struct Released {
        void operator()(double *p) const { std::free(p); }
    };
    struct Block {
        std::int64_t cols = 0, room = 0; // columns, and for how many there is memory
        std::unique_ptr<double, Released> data;
    };
    /// Columns of a block; throws where they do not exist.
    double *columns(std::int64_t number, std::int64_t first, std::int64_t count);
    /// The same to be written, made or made longer where need be.
    double *written(std::int64_t number, std::int64_t first, std::int64_t count);
    void extend(Block &block, std::int64_t cols);
    void give_up(Block block);
    MumpsFactor &factor(std::int64_t number);
    std::int64_t n() const { return rows_.count(); }
    bool fixed(std::int64_t row) const { return matrices_.fixed(row); }

    void free(const Call &call);
    void facts(const Call &call);
    void fill(const Call &call);
    void copy(const Call &call);
    void combine(const Call &call);
    void gram(const Call &call);
    void apply(const Call &call);
    void make_factor(const Call &call);
    void solve(const Call &call);
    void responses(const Call &call);
    void rows(const Call &call);
    void set_rows(const Call &call);
    void all_rows(const Call &call);
    void set_all_rows(const Call &call);
    void look(const Call &call);
    void energy(const Call &call);
    void residual(const Call &call);
    void diagonal(const Call &call);

    Team &team_;
    Rows rows_;
    Matrices matrices_;
    KeptOrder order_;
    std::map<std::int64_t, Block> blocks_;
    std::vector<Block>
        spare_; // memory of blocks given up, for the next ones: new memory costs more than a copy
    std::map<std::int64_t, std::unique_ptr<MumpsFactor>> factors_;
};

} // namespace plm::mpi
