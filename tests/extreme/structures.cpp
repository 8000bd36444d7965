#include "structures.hpp"
#include <cmath>

namespace extreme {

exact::Structure empty(int n, int z) {
    exact::Structure s;
    s.n = n;
    s.z = z;
    s.mass.assign(n, 1.0);
    s.stiffness.assign(n * n, 0.0);
    s.damping.assign(n * n, 0.0);
    s.gap_rows.assign(z * n, 0.0);
    s.contact_stiffness.assign(z, 1.0);
    s.gap.assign(z, 0.0);
    s.force.assign(n, 0.0);
    s.preload.assign(n, 0.0);
    return s;
}

void add_spring(exact::Structure &s, int i, int j, double k, double c) {
    const int n = s.n;
    s.stiffness[i * n + i] += k;
    s.damping[i * n + i] += c;
    if (j < 0) return;
    s.stiffness[j * n + j] += k;
    s.stiffness[i * n + j] -= k;
    s.stiffness[j * n + i] -= k;
    s.damping[j * n + j] += c;
    s.damping[i * n + j] -= c;
    s.damping[j * n + i] -= c;
}

void set_contact(exact::Structure &s, double stiffness, double gap) {
    s.contact_stiffness.assign(s.z, stiffness);
    s.gap.assign(s.z, gap);
}

exact::Structure chain(int n, double zeta, const std::vector<int> &pairs) {
    exact::Structure s = empty(n, static_cast<int>(pairs.size()));
    const double first = 2 * std::sin(M_PI / (2 * (2 * n + 1))); // lowest frequency
    for (int i = 0; i < n; ++i) add_spring(s, i, i - 1, 1, 2 * zeta / first);
    for (int p = 0; p < s.z; ++p) {
        s.gap_rows[p * n + pairs[p]] = 1;
        if (pairs[p] + 1 < n) s.gap_rows[p * n + pairs[p] + 1] = -1;
    }
    s.force[n - 1] = 1;
    return s;
}

exact::Structure oscillator(double zeta, double contact_stiffness, double gap, double force, double preload) {
    exact::Structure s = empty(1, 1);
    add_spring(s, 0, -1, 1, 2 * zeta);
    s.gap_rows = {1};
    set_contact(s, contact_stiffness, gap);
    s.force = {force};
    s.preload = {preload};
    return s;
}

} // namespace extreme
