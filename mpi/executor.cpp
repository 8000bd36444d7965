#include "mpi/executor.hpp"
#include <algorithm>

namespace plm::mpi {

CallSizes sizes_of(Operation operation, const std::int64_t *v) {
    CallSizes s;
    const auto set = [&](std::int64_t number, std::int64_t factor = 0, std::int64_t in = 0,
                         std::int64_t out = 0) {
        s.number = number, s.factor = factor, s.in = in, s.out = out;
        return s;
    };
    switch (operation) {
    case Operation::end:
        return set(0);
    case Operation::free:
        return set(1 + v[0]);
    case Operation::facts:
        return set(0, 0, 0, 16);
    case Operation::fill:
        return set(3, 3);
    case Operation::copy:
        return set(4 + v[3]);
    case Operation::combine:
        return set(7, 2, v[6] ? v[2] : v[2] * v[5]);
    case Operation::gram:
        return set(8, 0, 0, v[6] ? v[2] : v[2] * v[5]);
    case Operation::apply:
        return set(5, 3);
    case Operation::factor:
        return set(4 + v[2] + 2 * v[3], 3, v[3], 8);
    case Operation::solve:
        return set(4);
    case Operation::responses:
        return set(6 + 2 * v[5], 0, v[5]);
    case Operation::rows:
        return v[3] < 0 ? set(4) : set(4 + v[3], 0, 0, v[3] * v[2]);
    case Operation::set_rows:
        set(4 + (v[3] < 0 ? 0 : v[3]), 1, v[3] < 0 ? 0 : v[3] * v[2]);
        s.in_stays = v[3] < 0;
        return s;
    case Operation::look:
        return set(3, 0, 0, 3);
    case Operation::energy:
        return set(3, 3, 0, 3 * v[2]);
    case Operation::residual:
        return set(5, 1, v[4], v[4]);
    case Operation::diagonal:
        return set(1 + v[0], 3, 0, v[0]);
    }
    throw Error(status::not_built,
                format("this libplm_mpi does not know the tall operation %d; it is older than libplm",
                       static_cast<int>(operation)));
}

void Executor::begin(Rows rows, MatrixParts &parts) {
    team_.together([&] { spare_.reserve(static_cast<std::size_t>(Exchange::width)); });
    rows_ = std::move(rows);
    matrices_ = Matrices(team_, rows_, parts);
}

void Executor::run(const Call &call) {
    switch (call.operation) {
    case Operation::end:
        return end();
    case Operation::free:
        return free(call);
    case Operation::facts:
        return facts(call);
    case Operation::fill:
        return fill(call);
    case Operation::copy:
        return copy(call);
    case Operation::combine:
        return combine(call);
    case Operation::gram:
        return gram(call);
    case Operation::apply:
        return apply(call);
    case Operation::factor:
        return make_factor(call);
    case Operation::solve:
        return solve(call);
    case Operation::responses:
        return responses(call);
    case Operation::rows:
        return call.number[3] < 0 ? all_rows(call) : rows(call);
    case Operation::set_rows:
        return call.number[3] < 0 ? set_all_rows(call) : set_rows(call);
    case Operation::look:
        return look(call);
    case Operation::energy:
        return energy(call);
    case Operation::residual:
        return residual(call);
    case Operation::diagonal:
        return diagonal(call);
    }
}

double *Executor::columns(std::int64_t number, std::int64_t first, std::int64_t count) {
    const auto found = blocks_.find(number);
    if (found == blocks_.end() || first < 0 || count < 0 || first + count > found->second.cols)
        throw Error(status::internal,
                    format("columns %lld to %lld of block %lld do not exist; please report this",
                           static_cast<long long>(first), static_cast<long long>(first + count),
                           static_cast<long long>(number)));
    return found->second.data.get() + first * n();
}

double *Executor::written(std::int64_t number, std::int64_t first, std::int64_t count) {
    Block &block = blocks_[number];
    const std::int64_t cols = std::max(block.cols, first + count);
    if (cols > block.room) extend(block, cols);
    if (first > block.cols) std::fill_n(block.data.get() + block.cols * n(), (first - block.cols) * n(), 0.0);
    block.cols = cols;
    return columns(number, first, count);
}

/// Large memory grows where it stands, or its pages move: realloc copies nothing then.
void Executor::extend(Block &block, std::int64_t cols) {
    const auto fits = std::find_if(spare_.begin(), spare_.end(),
                                   [&](const Block &b) { return b.room >= cols && b.room <= 2 * cols; });
    if (block.room == 0 && fits != spare_.end()) {
        block = std::move(*fits);
        spare_.erase(fits);
        return;
    }
    const auto bytes = static_cast<std::size_t>(std::max<std::int64_t>(1, cols * n())) * sizeof(double);
    auto *data = static_cast<double *>(std::realloc(block.data.get(), bytes));
    if (!data) throw std::bad_alloc();
    static_cast<void>(block.data.release());
    block.data.reset(data), block.room = cols;
}

/// Keeps no more than a block of right-hand sides has.
void Executor::give_up(Block block) {
    std::int64_t room = block.room;
    for (const Block &b : spare_) room += b.room;
    if (block.room > 0 && room <= Exchange::width) spare_.push_back(std::move(block));
}

MumpsFactor &Executor::factor(std::int64_t number) {
    const auto found = factors_.find(number);
    if (found == factors_.end())
        throw Error(status::internal, format("factorization %lld does not exist; please report this",
                                             static_cast<long long>(number)));
    return *found->second;
}

void Executor::end() {
    for (auto &entry : factors_) entry.second->release();
    factors_.clear();
    blocks_.clear();
    spare_.clear();
}

void Executor::free(const Call &call) {
    for (std::int64_t k = 1; k <= call.number[0]; ++k) {
        if (const auto block = blocks_.find(call.number[k]); block != blocks_.end()) {
            give_up(std::move(block->second));
            blocks_.erase(block);
        }
        const auto found = factors_.find(call.number[k]);
        if (found == factors_.end()) continue;
        found->second->release();
        factors_.erase(found);
    }
}

} // namespace plm::mpi
