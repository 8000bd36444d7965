#include "paths/metric.hpp"
#include "linalg/dense.hpp"
#include <cmath>

namespace plm {

PathState difference(const PathState &a, const PathState &b) {
    PathState d = a;
    add(-1, b, d);
    return d;
}

void add(double factor, const PathState &b, PathState &a) {
    for (std::size_t i = 0; i < a.x.size(); ++i) a.x[i] += factor * b.x[i];
    a.parameter += factor * b.parameter;
}

void scale_by(double factor, PathState &a) {
    for (double &v : a.x) v *= factor;
    a.parameter *= factor;
}

double Metric::dot(const vector<double> &a, const vector<double> &b) const {
    if (!weights) return plm::dot(static_cast<std::int64_t>(a.size()), a.data(), b.data());
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (*weights)[i] * a[i] * b[i];
    return sum;
}

double Metric::product(const PathState &a, const PathState &b) const {
    return dot(a.x, b.x) / (scale * scale) + a.parameter * b.parameter / (width * width);
}

double Metric::length(const PathState &a) const {
    return std::sqrt(product(a, a));
}

double Metric::distance(const PathState &a, const PathState &b) const {
    return length(difference(a, b));
}

double Metric::cosine(const PathState &a, const PathState &b) const {
    return product(a, b) / std::sqrt(product(a, a) * product(b, b));
}

PathState tangent_at(Residual &system) {
    PathState tangent{vector<double>(system.size()), 1};
    system.parameter_derivative(tangent.x.data());
    system.solve(tangent.x.data(), 1);
    for (double &v : tangent.x) v = -v;
    return tangent;
}

vector<double> null_direction(Residual &system) {
    constexpr int iterations = 4; // the tangent is singular but for how well the point was located
    const std::int64_t n = system.size();
    vector<double> v = patternless_vector(n);
    for (int k = 0; k < iterations; ++k) {
        system.solve(v.data(), 1);
        const double length = norm2(n, v.data());
        for (double &c : v) c /= length;
    }
    return v;
}

PathState step_across(const Metric &metric, const PathState &tangent, const vector<double> &change) {
    PathState step{change, 0};
    scale_by(-1, step);
    add(-metric.product(tangent, step) / metric.product(tangent, tangent), tangent, step);
    return step;
}

double size_of(const Residual &system, const vector<double> &x) {
    const std::int64_t s = system.static_size();
    const double moving = norm2(system.size() - s, x.data() + s);
    return moving > 0 ? moving : norm2(system.size(), x.data());
}

} // namespace plm
