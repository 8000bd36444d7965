#include "structure/unheld_motion.hpp"
#include "linalg/lapack.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

// So little is a change of the gap on any reading.
constexpr double rounded_to = 1e-6;
// A lever of a thousandth may be meant; but not where much larger terms cancel.
constexpr double cancelled = 1e-2;

// Of each row: its terms before they cancel, the largest over the columns.
vector<double> sizes(const Matrix &terms) {
    vector<double> size(terms.rows(), 0.0);
    for (std::int64_t j = 0; j < terms.cols(); ++j)
        for (std::int64_t i = 0; i < terms.rows(); ++i) size[i] = std::max(size[i], terms(i, j));
    return size;
}

double largest_ratio(const Matrix &a, const vector<double> &size) {
    double largest = 0;
    for (std::int64_t i = 0; i < a.rows(); ++i)
        if (a(i, 0) != 0) largest = std::max(largest, std::abs(a(i, 0)) / size[i]);
    return largest;
}

// Beside heavy bodies the modes of a light one are large: a row is small beside what moves in this motion,
// too.
bool is_held(const GapRows &rows, const Field &motion, vector<double> size) {
    const Matrix answer = rows.of(motion), terms = rows.terms_of(motion);
    const double farthest = largest_entry(motion).size;
    const Matrix lengths = rows.terms_of(motion.filled(1, {1, 0, 0, 0}));
    for (std::size_t i = 0; i < size.size(); ++i)
        size[i] = std::min(size[i], farthest * lengths(static_cast<std::int64_t>(i), 0));
    const double miss = largest_ratio(answer, size);
    return !(miss < rounded_to || (miss < meant_as_zero && miss < cancelled * largest_ratio(terms, size)));
}

} // namespace

Field unheld_motion(const GapRows &rows, const Field &rigid_modes) {
    const std::int64_t n_rigid = rigid_modes.cols();
    if (n_rigid == 0 || rows.n_rows() == 0) return rigid_modes;
    const Matrix gaps = rows.of(rigid_modes);
    const vector<double> size = sizes(rows.terms_of(rigid_modes));
    Matrix scaled(std::max(gaps.rows(), n_rigid), n_rigid); // rows of zeros below: all directions are wanted
    for (std::int64_t j = 0; j < n_rigid; ++j)
        for (std::int64_t i = 0; i < gaps.rows(); ++i)
            scaled(i, j) = size[i] > 0 ? gaps(i, j) / size[i] : 0.0;
    const Matrix directions = thin_svd(scaled).vt.transposed(); // the last ones are held least
    std::int64_t first = n_rigid;
    while (first > 0 && !is_held(rows, combine(rigid_modes, directions.columns(first - 1, 1)), size)) --first;
    return combine(rigid_modes, directions.columns(first, n_rigid - first));
}

RowMiss largest_miss(const GapRows &rows, const Field &motions, const Field &rigid_modes) {
    RowMiss worst;
    if (rows.n_rows() == 0) return worst;
    const Matrix gaps = rows.of(motions);
    const vector<double> size = sizes(rows.terms_of(rigid_modes));
    for (std::int64_t j = 0; j < gaps.cols(); ++j)
        for (std::int64_t i = 0; i < gaps.rows(); ++i)
            if (size[i] > 0 && std::abs(gaps(i, j)) > worst.size * size[i])
                worst = {i, std::abs(gaps(i, j)) / size[i]};
    return worst;
}

Resultant resultant(const Field &load, const Field &motions, const Field &rigid_modes) {
    if (load.empty() || motions.cols() == 0) return {};
    const Matrix along = gram(motions, load);
    const double size = norm2(along.rows(), along.data());
    if (!(size > 0)) return {};
    const auto terms_in = [&](const Field &of) {
        double terms = 0;
        for (double sum : of.block().absolute_products(load.block())) terms = std::hypot(terms, sum);
        return terms;
    };
    const LargestEntry most = largest_entry(combine(motions, along));
    const double all = terms_in(rigid_modes);
    return {size / (size > exactly_zero * all ? terms_in(motions) : all), size * size / most.size, most.row};
}

} // namespace plm
