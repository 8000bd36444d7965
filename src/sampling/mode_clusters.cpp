#include "sampling/mode_clusters.hpp"
#include "linalg/lapack.hpp"
#include "space/rest.hpp"
#include "structure/driven_harmonic.hpp"
#include <algorithm>
#include <cmath>

namespace plm {
namespace {

constexpr double equal = 1e-6;  // eigenvalues, relative
constexpr double unseen = 1e-9; // of the largest row: what rounding leaves of modes that are not seen

double largest_row(const Matrix &a) {
    double most = 0;
    for (std::int64_t i = 0; i < a.rows(); ++i) {
        double sum = 0;
        for (std::int64_t j = 0; j < a.cols(); ++j) sum = std::hypot(sum, a(i, j));
        most = std::max(most, sum);
    }
    return most;
}

// Columns [first, end) by the singular vectors of what is seen of them; how many are.
std::int64_t turn(const Matrix &seen, std::int64_t first, std::int64_t end, Matrix &vectors) {
    const std::int64_t n = end - first;
    const Matrix group = vectors.columns(first, n);
    Matrix view = product('N', 'N', seen, group);
    const double size = largest_row(seen);
    if (!(size > 0)) return 0;
    for (std::int64_t k = 0; k < view.rows() * view.cols(); ++k) view.data()[k] /= size;
    const SymmetricEigen e = symmetric_eigen(product('T', 'N', view, view)); // ascending
    Matrix by(n, n);
    for (std::int64_t j = 0; j < n; ++j) std::copy_n(e.vectors.col(n - 1 - j), n, by.col(j));
    const Matrix turned = product('N', 'N', group, by);
    std::copy_n(turned.data(), turned.rows() * n, vectors.col(first));
    return std::count_if(e.values.begin(), e.values.end(), [](double v) { return v > unseen * unseen; });
}

} // namespace

std::int64_t cluster_end(const vector<double> &values, std::int64_t first) {
    const auto start = values.begin() + first; // what is free may have come out below zero
    return std::upper_bound(start + 1, values.end(), *start + equal * std::abs(*start)) - values.begin();
}

void align_clusters(const std::vector<const Matrix *> &seen, SpaceModes &modes) {
    const std::int64_t count = modes.vectors.cols();
    for (std::int64_t first = 0, end = 0; first < count; first = end) {
        end = cluster_end(modes.values, first);
        std::int64_t left = first; // to be turned
        for (const Matrix *by : seen)
            if (end - left > 1) left += turn(*by, left, end, modes.vectors);
    }
}

HarmonicLoads drive_of(const Space &space) {
    HarmonicLoads loads = space.excitation;
    const Contact &contact = space.model->contact();
    if (!contact.moves()) return loads;
    const vector<double> spring = contact.wall_springs(rest_of(space)->penetration);
    vector<double> real(spring.size()), imag(spring.size());
    for (const auto &[harmonic, part] : contact.motion) {
        for (std::size_t i = 0; i < spring.size(); ++i) {
            const std::complex<double> force = spring[i] * Contact::moved(part, static_cast<std::int64_t>(i));
            real[i] = force.real();
            imag[i] = force.imag();
        }
        HarmonicLoad &load = loads[harmonic];
        load.real.resize(space.lambda.size(), 0.0);
        gemv('T', 1.0, space.gap, real.data(), 1.0, load.real.data());
        if (harmonic == 0) continue;
        load.imag.resize(space.lambda.size(), 0.0);
        gemv('T', 1.0, space.gap, imag.data(), 1.0, load.imag.data());
    }
    return loads;
}

Matrix driving_loads(const Space &space) {
    Matrix loads(2, space.size());
    const HarmonicLoads drive = drive_of(space);
    const auto *driven = driven_harmonic(drive);
    if (!driven) return loads;
    const vector<double> *parts[] = {&driven->second.real, &driven->second.imag};
    for (std::int64_t i = 0; i < 2; ++i)
        for (std::size_t j = 0; j < parts[i]->size(); ++j)
            loads(i, static_cast<std::int64_t>(j)) = (*parts[i])[j];
    return loads;
}

Matrix row_of(const Space &space, const vector<double> &shape) {
    Matrix row(1, space.size());
    std::copy_n(shape.data(), space.n_massive(), row.data());
    return row;
}

} // namespace plm
