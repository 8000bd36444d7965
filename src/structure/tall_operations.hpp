// What a host does with tall things that it keeps: one callback, an operation at a time (plm_tall_fn of
// plm.h, where each has its numbers told).
#pragma once
#include "structure/tall.hpp"
#include <cstdint>
#include <functional>

namespace plm {

namespace tall_operation {
enum : std::int32_t {
    end,
    free_handles,
    facts,
    fill,
    copy,
    combine,
    gram,
    apply,
    factor,
    solve,
    responses,
    rows,
    set_rows,
    look,
    energy,
    residual,
    diagonal
};
}

/// The host's side, for as long as somebody has blocks or factors there.
class TallOperations {
  public:
    /// 0, or a code that fails the call.
    using Function = std::function<int(std::int32_t operation, const std::int64_t *number,
                                       const double *factor, const double *small_in, double *small_out)>;

    explicit TallOperations(Function function) : function_(std::move(function)) {}
    /// Tells the host that this was all.
    ~TallOperations();
    TallOperations(const TallOperations &) = delete;

    using Numbers = vector<std::int64_t>;
    /// PLM_ERR_CALLBACK where it fails. Handles that nobody has any more go first.
    void run(std::int32_t operation, const Numbers &number, const vector<double> &factor = {},
             const double *small_in = nullptr, double *small_out = nullptr);
    /// A number that no block or factor has had.
    std::int64_t new_handle();
    /// Waits for nobody and throws nothing: destructors call it.
    void drop(std::int64_t handle) noexcept { dropped_.push_back(handle); }

  private:
    void free_dropped();

    Function function_;
    std::int64_t last_ = 0;
    std::size_t living_ = 0; // handles that may be dropped: there is room for all of them
    vector<std::int64_t> dropped_;
    bool was_run_ = false;
};

/// The structure that the operations stand for, over n_dof DOFs. PLM_ERR_CALLBACK where its facts are none.
std::unique_ptr<Tall> tall_by_host(std::shared_ptr<TallOperations> operations, std::int64_t n_dof);

/// The largest absolute entries of M, K and C that its host told of, 0: not known.
struct TallScales {
    double mass = 0, stiffness = 0, damping = 0;
};
TallScales scales_of(const Tall &by_host);

} // namespace plm
