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
    for (const auto &[part, gaps] : contact.motion) {
        for (std::size_t i = 0; i < spring.size(); ++i) {
            const std::complex<double> force = spring[i] * Contact::moved(gaps, static_cast<std::int64_t>(i));
            real[i] = force.real();
            imag[i] = force.imag();
        }
        HarmonicLoad &load = loads[part];
        load.real.resize(space.lambda.size(), 0.0);
        gemv('T', 1.0, space.gap, real.data(), 1.0, load.real.data());
        if (part.harmonic == 0) continue;
        load.imag.resize(space.lambda.size(), 0.0);
        gemv('T', 1.0, space.gap, imag.data(), 1.0, load.imag.data());
    }
    return loads;
}

DrivingLoads driving_loads(const Space &space) {
    DrivingLoads loads;
    const HarmonicLoads drive = drive_of(space);
    const int driven = driven_harmonic(drive);
    std::vector<const HarmonicLoad *> of;
    for (const auto &[part, load] : drive)
        if (driven > 0 && part.harmonic == driven) loads.parts.push_back(part), of.push_back(&load);
    loads.rows.reset(std::max<std::int64_t>(2, 2 * static_cast<std::int64_t>(of.size())), space.size());
    for (std::size_t p = 0; p < of.size(); ++p)
        for (std::int64_t j = 0; j < space.size(); ++j) {
            const std::int64_t row = 2 * static_cast<std::int64_t>(p);
            loads.rows(row, j) = of[p]->real[static_cast<std::size_t>(j)];
            loads.rows(row + 1, j) = of[p]->imag.empty() ? 0.0 : of[p]->imag[static_cast<std::size_t>(j)];
        }
    return loads;
}

Matrix row_of(const Space &space, const vector<double> &shape) {
    Matrix row(1, space.size());
    std::copy_n(shape.data(), space.n_massive(), row.data());
    return row;
}

} // namespace plm
