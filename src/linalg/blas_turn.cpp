#include "blas_turn.hpp"
#include <mutex>
#ifdef __linux__

// OpenBLAS's own, where the BLAS is one.
extern "C" {
[[gnu::weak]] void *blas_memory_alloc(int);
[[gnu::weak]] int openblas_get_parallel();
// Ours, where libplm.so carries an OpenBLAS.
[[gnu::weak]] int carried_blas_has_lock();
}

namespace plm {
namespace {

/// 0 threads: built without. A serial archive linked without that function is not told from one with threads:
/// turns are right for both.
bool take_turns() {
    static const bool needed = !carried_blas_has_lock && blas_memory_alloc &&
                               (!openblas_get_parallel || openblas_get_parallel() == 0);
    return needed;
}

std::mutex turn;

} // namespace

BlasTurn::BlasTurn() : taken_(take_turns()) {
    if (taken_) turn.lock();
}
BlasTurn::~BlasTurn() {
    if (taken_) turn.unlock();
}

} // namespace plm

#else

namespace plm {
BlasTurn::BlasTurn() : taken_(false) {}
BlasTurn::~BlasTurn() {}
} // namespace plm

#endif
