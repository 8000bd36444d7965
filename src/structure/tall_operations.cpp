#include "structure/tall_operations.hpp"
#include "linalg/error.hpp"

namespace plm {
namespace {

constexpr const char *names[] = {"END",      "FREE",  "FACTS",  "FILL",     "COPY",      "COMBINE",
                                 "GRAM",     "APPLY", "FACTOR", "SOLVE",    "RESPONSES", "ROWS",
                                 "SET_ROWS", "LOOK",  "ENERGY", "RESIDUAL", "DIAGONAL"};

} // namespace

TallOperations::~TallOperations() {
    if (was_run_) function_(tall_operation::end, nullptr, nullptr, nullptr, nullptr);
}

std::int64_t TallOperations::new_handle() {
    dropped_.reserve(++living_);
    return ++last_;
}

// The host may not know some of them, where the operation that was to make them failed: whatever it answers,
// they are gone.
void TallOperations::free_dropped() {
    if (dropped_.empty()) return;
    Numbers number{static_cast<std::int64_t>(dropped_.size())};
    number.insert(number.end(), dropped_.begin(), dropped_.end());
    living_ -= dropped_.size();
    dropped_.clear();
    function_(tall_operation::free_handles, number.data(), nullptr, nullptr, nullptr);
}

void TallOperations::run(std::int32_t operation, const Numbers &number, const vector<double> &factor,
                         const double *small_in, double *small_out) {
    was_run_ = true;
    free_dropped();
    const int code = function_(operation, number.empty() ? nullptr : number.data(),
                               factor.empty() ? nullptr : factor.data(), small_in, small_out);
    if (code != 0)
        throw Error(status::callback,
                    format("the host's tall operation %s failed with code %d", names[operation], code))
            .argument("fn")
            .library_code(code);
}

} // namespace plm
