// Tall operations of the host in place of the model's matrices.
#include "capi/barrier.hpp"
#include "capi/model_input.hpp"
#include "structure/matrix_input.hpp"
#include "structure/tall_operations.hpp"

namespace plm::capi {
namespace {

static_assert(tall_operation::end == PLM_TALL_END);
static_assert(tall_operation::free_handles == PLM_TALL_FREE);
static_assert(tall_operation::facts == PLM_TALL_FACTS);
static_assert(tall_operation::fill == PLM_TALL_FILL);
static_assert(tall_operation::copy == PLM_TALL_COPY);
static_assert(tall_operation::combine == PLM_TALL_COMBINE);
static_assert(tall_operation::gram == PLM_TALL_GRAM);
static_assert(tall_operation::apply == PLM_TALL_APPLY);
static_assert(tall_operation::factor == PLM_TALL_FACTOR);
static_assert(tall_operation::solve == PLM_TALL_SOLVE);
static_assert(tall_operation::responses == PLM_TALL_RESPONSES);
static_assert(tall_operation::rows == PLM_TALL_ROWS);
static_assert(tall_operation::set_rows == PLM_TALL_SET_ROWS);
static_assert(tall_operation::look == PLM_TALL_LOOK);
static_assert(tall_operation::energy == PLM_TALL_ENERGY);
static_assert(tall_operation::residual == PLM_TALL_RESIDUAL);
static_assert(tall_operation::diagonal == PLM_TALL_DIAGONAL);

// How the core's operations reach the host's.
std::shared_ptr<TallOperations> operations_of(Context &context, plm_tall_fn fn, void *user) {
    const Context *owner = &context;
    return std::make_shared<TallOperations>(
        [owner, fn, user](std::int32_t operation, const std::int64_t *number, const double *factor,
                          const double *small_in, double *small_out) {
            const HostCode host(*owner);
            return fn(owner->handle, operation, number, factor, small_in, small_out, user);
        });
}

void take_operations(ModelInput &input, std::shared_ptr<TallOperations> operations) {
    for (std::shared_ptr<const MatrixInput> *one : {&input.mass, &input.stiffness}) {
        if (operations)
            *one = std::make_shared<const MatrixInput>(operations);
        else if (*one && (*one)->behind)
            one->reset();
    }
}

} // namespace
} // namespace plm::capi

using namespace plm::capi;

plm_status plm_model_set_tall_operations(plm_model *model, plm_tall_fn fn, void *user) {
    return call<ModelHandle>("plm_model_set_tall_operations", model, [&](ModelHandle &m) {
        require_open(m);
        take_operations(m.input, fn ? operations_of(m.context(), fn, user) : nullptr);
        return PLM_OK;
    });
}
