#include "dense.hpp"
#include <cmath>
#include <utility>

namespace extreme {

std::vector<Complex> solve_dense(std::vector<Complex> a, std::vector<Complex> b) {
    const int n = static_cast<int>(b.size());
    for (int k = 0; k < n; ++k) {
        int p = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(a[i * n + k]) > std::abs(a[p * n + k])) p = i;
        for (int j = 0; j < n; ++j) std::swap(a[k * n + j], a[p * n + j]);
        std::swap(b[k], b[p]);
        for (int i = k + 1; i < n; ++i) {
            const Complex f = a[i * n + k] / a[k * n + k];
            if (f == 0.0) continue;
            for (int j = k; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
            b[i] -= f * b[k];
        }
    }
    for (int i = n - 1; i >= 0; --i) {
        for (int j = i + 1; j < n; ++j) b[i] -= a[i * n + j] * b[j];
        b[i] /= a[i * n + i];
    }
    return b;
}

double determinant(std::vector<double> a, int n) {
    double d = 1;
    for (int k = 0; k < n; ++k) {
        int p = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(a[i * n + k]) > std::abs(a[p * n + k])) p = i;
        if (p != k) {
            for (int j = 0; j < n; ++j) std::swap(a[k * n + j], a[p * n + j]);
            d = -d;
        }
        d *= a[k * n + k];
        for (int i = k + 1; i < n && a[k * n + k] != 0; ++i) {
            const double f = a[i * n + k] / a[k * n + k];
            for (int j = k; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
        }
    }
    return d;
}

double linear_peak(const exact::Structure &s, const std::vector<bool> &closed, double omega, int dof,
                   const std::vector<double> *full_mass) {
    const int n = s.n;
    std::vector<Complex> k(n * n), d(n * n), rest(n), moving(n);
    for (int i = 0; i < n; ++i) {
        rest[i] = s.preload.empty() ? 0.0 : s.preload[i];
        moving[i] = s.force[i];
        for (int j = 0; j < n; ++j) {
            double stiffness = s.stiffness[i * n + j];
            const double mass = full_mass ? (*full_mass)[i * n + j] : i == j ? s.mass[i] : 0.0;
            for (int p = 0; p < s.z; ++p)
                if (closed[p])
                    stiffness += s.contact_stiffness[p] * s.gap_rows[p * n + i] * s.gap_rows[p * n + j];
            k[i * n + j] = stiffness;
            d[i * n + j] = Complex(stiffness - omega * omega * mass, omega * s.damping[i * n + j]);
        }
        for (int p = 0; p < s.z; ++p)
            if (closed[p]) rest[i] += s.contact_stiffness[p] * s.gap_rows[p * n + i] * s.gap[p];
    }
    const double mean = solve_dense(k, rest)[dof].real();
    return std::abs(mean) + std::abs(solve_dense(d, moving)[dof]);
}

} // namespace extreme
