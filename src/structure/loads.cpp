#include "structure/loads.hpp"

namespace plm {

vector<double> projected(const Field &v, const Field &load) {
    if (load.empty()) return {};
    const Matrix c = gram(v, load);
    return vector<double>(c.data(), c.data() + c.rows());
}

HarmonicLoads projected(const Field &v, const std::map<int, HarmonicForce> &loads) {
    HarmonicLoads reduced;
    for (const auto &[harmonic, load] : loads)
        reduced[harmonic] = {projected(v, load.real), projected(v, load.imag)};
    return reduced;
}

Field load_columns(const Field &preload, const std::map<int, HarmonicForce> &excitation,
                   std::int64_t n_free) {
    Field all(n_free, 0);
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
