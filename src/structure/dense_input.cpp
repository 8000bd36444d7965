#include "structure/dense_input.hpp"
#include "linalg/lapack.hpp"
#include "linalg/scale.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

using Int = long long; // for printf

[[noreturn]] void fail(Status status, std::int64_t position, const std::string &text) {
    throw Error(status, text).argument("value").index(position);
}

/// The caller's array as it is to be read.
class Entries {
  public:
    Entries(const DenseFormat &format, const double *value) : f_(format), value_(value) {}

    std::int64_t position(std::int64_t i, std::int64_t j) const { return i + j * f_.ld; }
    double operator()(std::int64_t i, std::int64_t j) const { return value_[position(i, j)]; }
    /// Of the lower triangle, i >= j, wherever it stands.
    std::int64_t lower_position(std::int64_t i, std::int64_t j) const {
        return f_.part == part::upper ? position(j, i) : position(i, j);
    }
    double lower(std::int64_t i, std::int64_t j) const { return value_[lower_position(i, j)]; }

    void check_finite() const {
        for (std::int64_t j = 0; j < f_.n; ++j) {
            const std::int64_t begin = f_.part == part::lower ? j : 0,
                               end = f_.part == part::upper ? j + 1 : f_.n;
            for (std::int64_t i = begin; i < end; ++i) {
                const double v = (*this)(i, j);
                if (std::isfinite(v) && !too_large(v)) continue;
                fail(status::matrix, position(i, j),
                     format(
                         "value[%lld], row %lld and column %lld counted from 0, is %g: no number, or beyond "
                         "%g where squares and products overflow; look at the reduction that made it",
                         Int(position(i, j)), Int(i), Int(j), v, largest_scale));
            }
        }
    }

    void check_symmetry() const {
        double largest = 0;
        for (std::int64_t j = 0; j < f_.n; ++j)
            largest = std::max(largest, largest_of(value_ + position(0, j), f_.n));
        for (std::int64_t j = 0; j < f_.n; ++j)
            for (std::int64_t i = j + 1; i < f_.n; ++i)
                if (std::abs((*this)(i, j) - (*this)(j, i)) > 1e-8 * largest)
                    fail(
                        status::matrix, position(i, j),
                        format("the matrix is not symmetric: %.10g in row %lld and column %lld (counted from "
                               "0) but %.10g at the mirrored place, more than 1e-8 of the largest entry %g "
                               "apart; pass PLM_LOWER or PLM_UPPER to use one triangle",
                               (*this)(i, j), Int(i), Int(j), (*this)(j, i), largest));
    }

    /// As a Cholesky factorization sees it after scaling to a unit diagonal: the reduction has rounded, and
    /// rigid-body motion and DOFs without mass are allowed.
    void check_semi_definite() const {
        constexpr double rounding = 1e-8;
        vector<double> scale(f_.n);
        for (std::int64_t i = 0; i < f_.n; ++i) {
            if ((*this)(i, i) < 0) not_semi_definite(i);
            scale[i] = std::sqrt((*this)(i, i));
        }
        Matrix scaled(f_.n, f_.n);
        for (std::int64_t j = 0; j < f_.n; ++j) {
            scaled(j, j) = 1 + rounding;
            for (std::int64_t i = j + 1; i < f_.n; ++i) {
                const double v = lower(i, j), size = scale[i] * scale[j];
                if (v != 0 && !(size > 0)) not_semi_definite(scale[i] > 0 ? j : i);
                if (size > 0) scaled(i, j) = v / size;
            }
        }
        DenseCholesky cholesky;
        if (!cholesky.factor(scaled)) not_semi_definite(cholesky.broke_at());
    }

    MatrixFormat layout() const {
        MatrixFormat layout;
        layout.n = f_.n, layout.part = part::lower, layout.negative_diagonal = !f_.semi_definite;
        return layout;
    }

    bool mostly_zero() const {
        std::int64_t zeros = 0; // of the lower triangle
        for (std::int64_t j = 0; j < f_.n; ++j)
            for (std::int64_t i = j; i < f_.n; ++i) zeros += lower(i, j) == 0;
        return zeros > f_.n * (f_.n + 1) / 4;
    }

  private:
    [[noreturn]] void not_semi_definite(std::int64_t dof) const {
        fail(status::not_positive_definite, dof,
             format("the matrix is indefinite, as DOF %lld (counted from 0) shows together with those before "
                    "it; mass and stiffness are positive semi-definite: look at signs and, of a "
                    "superelement, at the reduction that made them",
                    Int(dof)));
    }

    const DenseFormat &f_;
    const double *value_;
};

} // namespace

std::shared_ptr<const MatrixInput> make_dense_input(const DenseFormat &f, const double *value) {
    const Entries entries(f, value);
    entries.check_finite();
    if (f.part == part::full) entries.check_symmetry();
    if (f.semi_definite) entries.check_semi_definite();
    const bool without_zeros = entries.mostly_zero();
    vector<std::int64_t> start{0}, row;
    vector<double> kept;
    for (std::int64_t j = 0; j < f.n; ++j) {
        for (std::int64_t i = j; i < f.n; ++i) {
            const double v = entries.lower(i, j);
            if (without_zeros && v == 0) continue;
            row.push_back(i), kept.push_back(v);
        }
        start.push_back(static_cast<std::int64_t>(row.size()));
    }
    MatrixFormat layout = entries.layout();
    layout.nnz = start.back();
    return std::make_shared<const MatrixInput>(layout, start.data(), row.data(), kept.data());
}

} // namespace plm
