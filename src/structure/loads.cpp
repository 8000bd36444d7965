#include "structure/loads.hpp"
#include <algorithm>

namespace plm {
namespace {

void add_part(double factor, const vector<double> &part, vector<double> &sum) {
    if (sum.size() < part.size()) sum.resize(part.size(), 0.0);
    for (std::size_t j = 0; j < part.size(); ++j) sum[j] += factor * part[j];
}

template <class Factor> HarmonicLoad sum_of(const HarmonicLoads &loads, int harmonic, Factor factor) {
    HarmonicLoad sum;
    for (const auto &[part, load] : loads) {
        if (part.harmonic != harmonic) continue;
        add_part(factor(part), load.real, sum.real);
        add_part(factor(part), load.imag, sum.imag);
    }
    return sum;
}

} // namespace

HarmonicLoad load_at(const HarmonicLoads &loads, int harmonic, double omega) {
    return sum_of(loads, harmonic, [&](const LoadPart &part) { return part.growth(omega); });
}

HarmonicLoad load_change_at(const HarmonicLoads &loads, int harmonic, double omega) {
    return sum_of(loads, harmonic, [&](const LoadPart &part) { return part.growth_rate(omega); });
}

bool grow(const HarmonicLoads &loads) {
    return std::any_of(loads.begin(), loads.end(), [](const auto &entry) { return entry.first.power != 0; });
}

vector<double> projected(const Field &v, const Field &load) {
    if (load.empty()) return {};
    const Matrix c = gram(v, load);
    return vector<double>(c.data(), c.data() + c.rows());
}

HarmonicLoads projected(const Field &v, const HarmonicForces &loads) {
    HarmonicLoads reduced;
    for (const auto &[part, load] : loads) reduced[part] = {projected(v, load.real), projected(v, load.imag)};
    return reduced;
}

Field load_columns(const Field &preload, const HarmonicForces &excitation, Field all) {
    const auto take = [&](const Field &load) {
        if (!load.empty() && column_norms(load)[0] > 0) all.append(load);
    };
    take(preload);
    for (const auto &entry : excitation) {
        take(entry.second.real);
        take(entry.second.imag);
    }
    return all;
}

} // namespace plm
