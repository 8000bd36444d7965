// Operations with the matrices, and what is to be known of them.
#include "mpi/executor.hpp"
#include <algorithm>
#include <cmath>
#include <limits>

namespace plm::mpi {
namespace {

/// Numbers by size, sixteen classes for each power of two: of the middle one any number of ranks says the
/// same.
class SizeCount {
  public:
    SizeCount() : count_(static_cast<std::size_t>((highest - lowest) * 16), 0) {}
    void add(double x) {
        const int power = std::clamp(std::ilogb(x), lowest, highest - 1);
        const int part = std::clamp(static_cast<int>((std::ldexp(x, -power) - 1) * 16), 0, 15);
        ++count_[static_cast<std::size_t>((power - lowest) * 16 + part)];
    }
    std::vector<double> &counts() { return count_; }
    double median() const {
        double all = 0, below = 0;
        for (double c : count_) all += c;
        if (all == 0) return 0;
        std::size_t k = 0;
        while (2 * (below + count_[k]) < all) below += count_[k++];
        return std::ldexp(1 + (static_cast<double>(k % 16) + 0.5) / 16, static_cast<int>(k / 16) + lowest);
    }

  private:
    static constexpr int lowest = -300, highest = 301;
    std::vector<double> count_;
};

constexpr double none = std::numeric_limits<double>::infinity();

/// What a rank says of its rows: sums, and the smallest and largest of all.
struct RowFacts {
    double sum[5] = {0, 0, 0, 0, 0}; // free DOFs, those with mass, trace of M, of K, of the third kind below
    double least[3] = {none, none, none}; // K_ii; first DOF without anything; first with a row of K alone
    double most[3] = {0, 0, 0};           // entries of M, K, C
};

} // namespace

void Executor::facts(const Call &call) {
    RowFacts f, all;
    SizeCount *ratios = nullptr;
    std::unique_ptr<SizeCount> kept;
    team_.together([&] {
        kept = std::make_unique<SizeCount>();
        ratios = kept.get();
        for (std::int64_t i = 0; i < n(); ++i) {
            if (fixed(i)) continue;
            const double m = matrices_.diagonal(i, {1, 0, 0}), k = matrices_.diagonal(i, {0, 1, 0});
            const auto dof = static_cast<double>(rows_.owned()[static_cast<std::size_t>(i)]);
            f.sum[0] += 1, f.sum[1] += m > 0, f.sum[2] += m, f.sum[3] += k;
            f.least[0] = std::min(f.least[0], k);
            if (m > 0 && k > 0) ratios->add(k / m);
            if (m > 0 || k > 0) continue;
            if (matrices_.row_of_stiffness_is_empty(i))
                f.least[1] = std::min(f.least[1], dof);
            else
                f.least[2] = std::min(f.least[2], dof), f.sum[4] += 1;
        }
        const Weights each[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        for (int w = 0; w < (matrices_.has_damping() ? 3 : 2); ++w) f.most[w] = matrices_.largest(each[w]);
    });
    team_.sum_to_brain(ratios->counts().data(), ratios->counts().size());
    require_mpi(MPI_Reduce(f.sum, all.sum, 5, MPI_DOUBLE, MPI_SUM, 0, team_.comm()), "MPI_Reduce");
    require_mpi(MPI_Reduce(f.least, all.least, 3, MPI_DOUBLE, MPI_MIN, 0, team_.comm()), "MPI_Reduce");
    require_mpi(MPI_Reduce(f.most, all.most, 3, MPI_DOUBLE, MPI_MAX, 0, team_.comm()), "MPI_Reduce");
    if (!team_.is_brain()) return;
    const auto first = [](double dof) { return dof == none ? -1 : dof; };
    const double said[13] = {all.sum[0],
                             all.sum[1],
                             all.sum[2],
                             all.sum[3],
                             all.least[0] == none ? 0 : all.least[0],
                             ratios->median(),
                             first(all.least[1]),
                             first(all.least[2]),
                             all.sum[4],
                             matrices_.has_damping() ? 1.0 : 0.0,
                             all.most[0],
                             all.most[1],
                             all.most[2]};
    std::copy_n(said, 13, call.out);
}

void Executor::apply(const Call &call) {
    const std::int64_t *v = call.number;
    const Weights w{call.factor[0], call.factor[1], call.factor[2]};
    const double *y = nullptr;
    double *x = nullptr;
    team_.together([&] {
        if (v[0] == v[2])
            throw Error(status::internal, "a block is multiplied into itself; please report this");
        x = written(v[0], v[1], v[4]), y = columns(v[2], v[3], v[4]);
        if (w.c != 0 && !matrices_.has_damping())
            throw Error(status::state, "no rank has added entries of PLM_DAMPING");
    });
    for (std::int64_t first = 0; first < v[4]; first += Exchange::width)
        matrices_.apply(team_, w, std::min(Exchange::width, v[4] - first), y + first * n(), n(),
                        x + first * n(), n());
}

void Executor::energy(const Call &call) {
    const std::int64_t *v = call.number, cols = v[2];
    const Weights w{call.factor[0], call.factor[1], call.factor[2]};
    std::vector<double> sums, all;
    const double *x = nullptr;
    team_.together([&] {
        x = columns(v[0], v[1], cols);
        sums.resize(static_cast<std::size_t>(3 * cols));
        if (team_.is_brain()) all.resize(sums.size() * static_cast<std::size_t>(team_.size()));
    });
    for (std::int64_t first = 0; first < cols; first += Exchange::width)
        matrices_.energy(team_, w, std::min(Exchange::width, cols - first), x + first * n(), n(),
                         sums.data() + 3 * first);
    const int count = static_cast<int>(sums.size());
    require_mpi(MPI_Gather(sums.data(), count, MPI_DOUBLE, all.data(), count, MPI_DOUBLE, 0, team_.comm()),
                "MPI_Gather");
    if (!team_.is_brain()) return;
    for (std::int64_t j = 0; j < cols; ++j) {
        Exact total;
        double size = 0;
        for (std::int64_t r = 0; r < team_.size(); ++r) {
            const double *one = all.data() + 3 * (j + r * cols);
            total.add(one[0]), total.low += one[1], size += one[2];
        }
        call.out[2 * j] = total.high + total.low, call.out[2 * j + 1] = size;
    }
}

void Executor::residual(const Call &call) {
    const std::int64_t *v = call.number, cols = v[4];
    const double *x = nullptr, *y = nullptr;
    team_.together([&] { x = columns(v[0], v[1], cols), y = columns(v[2], v[3], cols); });
    for (std::int64_t first = 0; first < cols; first += Exchange::width)
        matrices_.residual(team_, call.factor[0], std::min(Exchange::width, cols - first), x + first * n(),
                           y + first * n(), n(), n(), call.in + first, call.out + first);
    team_.sum_to_brain(call.out, static_cast<std::size_t>(cols));
    for (std::int64_t j = 0; j < cols; ++j) call.out[j] = std::sqrt(call.out[j]);
}

void Executor::diagonal(const Call &call) {
    const std::int64_t count = call.number[0];
    const Weights w{call.factor[0], call.factor[1], call.factor[2]};
    for (std::int64_t k = 0; k < count; ++k) {
        const std::int64_t i = rows_.local(call.number[1 + k]);
        call.out[k] = i >= 0 ? matrices_.diagonal(i, w) : 0;
    }
    team_.sum_to_brain(call.out, static_cast<std::size_t>(count));
}

} // namespace plm::mpi
