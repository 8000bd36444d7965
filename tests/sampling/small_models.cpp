#include "small_models.hpp"
#include "structure/matrix_input.hpp"

namespace test {
namespace {

std::shared_ptr<const plm::MatrixInput> to_input(int n, const std::function<double(int, int)> &entry) {
    std::vector<std::int64_t> row, col;
    std::vector<double> value;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            if (entry(i, j) != 0) row.push_back(i), col.push_back(j), value.push_back(entry(i, j));
    plm::MatrixFormat f;
    f.n = n;
    f.nnz = static_cast<std::int64_t>(value.size());
    f.storage = plm::storage::triplets;
    return std::make_shared<plm::MatrixInput>(f, row.data(), col.data(), value.data());
}

} // namespace

std::shared_ptr<const plm::Model> make_model(const exact::Structure &s, const ModelExtras &extras,
                                             const plm::SpaceOptions &options) {
    plm::ModelInput input;
    input.n_dof = s.n;
    input.mass = to_input(s.n, [&](int i, int j) {
        return !extras.mass.empty() ? extras.mass[i * s.n + j] : i == j ? s.mass[i] : 0.0;
    });
    input.stiffness = to_input(s.n, [&](int i, int j) { return s.stiffness[i * s.n + j]; });
    if (extras.explicit_damping)
        input.damping_matrix = to_input(s.n, [&](int i, int j) { return s.damping[i * s.n + j]; });
    input.damping.alpha = extras.alpha;
    input.damping.beta = extras.beta;
    input.damping.structural = extras.structural;
    input.damping.modal_ratio.assign(extras.modal_ratio.begin(), extras.modal_ratio.end());
    for (int p = 0; p < s.z; ++p)
        for (int j = 0; j < s.n; ++j) {
            if (s.gap_rows[p * s.n + j] == 0) continue;
            input.gap_row.push_back(p);
            input.gap_dof.push_back(j);
            input.gap_coefficient.push_back(s.gap_rows[p * s.n + j]);
        }
    input.contact.stiffness.assign(s.contact_stiffness.begin(), s.contact_stiffness.end());
    input.contact.initial_gap.assign(s.gap.begin(), s.gap.end());
    input.preload.assign(s.preload.begin(), s.preload.end());
    input.excitation[1].real.assign(s.force.begin(), s.force.end());
    return std::make_shared<plm::Model>(input, options, nullptr, plm::Watch());
}

exact::Structure breathing_crack() {
    constexpr double spring = 1e4, bending = 2e4;
    exact::Structure s;
    s.n = 2, s.z = 5; // displacement of the middle of the section, rotation
    s.mass = {1, 25};
    s.stiffness = {spring, -3 * spring, -3 * spring, 9 * spring + bending};
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= 1e-4;
    for (int i = 0; i < s.z; ++i) s.gap_rows.insert(s.gap_rows.end(), {1.0, i - 2.0});
    s.contact_stiffness.assign(s.z, spring);
    s.gap.assign(s.z, 0.0);
    s.force = {0, 1};
    s.preload.assign(s.n, 0.0);
    return s;
}

exact::Structure two_chains(int n, int n_pairs, double contact_stiffness, bool supported) {
    exact::Structure s;
    s.n = 2 * n;
    s.z = n_pairs;
    s.mass.resize(s.n);
    s.stiffness.assign(s.n * s.n, 0.0);
    const auto spring = [&](int i, int j, double k) {
        s.stiffness[i * s.n + i] += k;
        s.stiffness[j * s.n + j] += k;
        s.stiffness[i * s.n + j] -= k;
        s.stiffness[j * s.n + i] -= k;
    };
    for (int i = 0; i < n; ++i) {
        s.mass[i] = 1 + 0.01 * i;
        s.mass[n + i] = 1.3 - 0.005 * i;
        if (i > 0) spring(i - 1, i, 100), spring(n + i - 1, n + i, 130 + i);
        spring(i, n + i, 0.02);
    }
    if (supported) s.stiffness[0] += 100, s.stiffness[n * s.n + n] += 150;
    s.damping = s.stiffness;
    for (double &c : s.damping) c *= 1e-3;
    s.gap_rows.assign(s.z * s.n, 0.0);
    for (int p = 0; p < s.z; ++p) {
        const int i = n - n_pairs + p;
        s.gap_rows[p * s.n + i] = 1;
        s.gap_rows[p * s.n + n + i] = -1;
    }
    s.contact_stiffness.assign(s.z, contact_stiffness);
    s.gap.assign(s.z, 0.0);
    s.force.assign(s.n, 0.0);
    s.force[n - 1] = 1;
    s.preload.assign(s.n, 0.0);
    return s;
}

plm::Matrix dense_stiffness(const exact::Structure &s, const plm::PairStates &states) {
    plm::Matrix k(s.n, s.n);
    for (int i = 0; i < s.n; ++i)
        for (int j = 0; j < s.n; ++j) {
            k(i, j) = s.stiffness[i * s.n + j];
            for (int p = 0; p < s.z; ++p)
                if (states.is_closed(p))
                    k(i, j) += s.contact_stiffness[p] * s.gap_rows[p * s.n + i] * s.gap_rows[p * s.n + j];
        }
    return k;
}

plm::SymmetricEigen dense_modes(const exact::Structure &s, const plm::PairStates &states) {
    plm::Matrix m(s.n, s.n);
    for (int i = 0; i < s.n; ++i) m(i, i) = s.mass[i];
    return plm::symmetric_eigen_general(dense_stiffness(s, states), m);
}

Failure failure_of(const std::function<void()> &call) {
    Failure f;
    try {
        call();
    } catch (const plm::Error &e) {
        f.thrown = true;
        f.status = e.status();
        f.argument = e.argument();
    }
    return f;
}

} // namespace test
