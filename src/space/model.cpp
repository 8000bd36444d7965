#include "space/model.hpp"
#include "linalg/error.hpp"
#include "space/memory_estimate.hpp"
#include <algorithm>

namespace plm {
namespace {

// Largest k_n given by the caller, 0 if all are left to the library.
double largest_given(const vector<double> &contact_stiffness) {
    double largest = 0;
    for (double k : contact_stiffness) largest = std::max(largest, k);
    return largest;
}

double median(vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

} // namespace

Model::Model(const ModelInput &input, const SpaceOptions &options, const HostSolver *host, Watch watch)
    : Model(input, options, fitting_solver(input, options, host, watch), watch) {}

Model::Model(const ModelInput &input, const SpaceOptions &options, const Solver &solver, Watch watch)
    : Structure(input, {input.contact.n_pairs(), Contact::n_directions},
                largest_given(input.contact.stiffness), solver, watch),
      contact_(input.contact), space_options_(options) {
    solve_attachment(watch);
    resolve_contact_stiffness();
}

// By blocks of columns: the host is heard between them.
void Model::solve_attachment(Watch watch) {
    constexpr std::int64_t block = 64;
    attachment_ = gap_rows().columns();
    const std::int64_t n = attachment_.cols();
    for (std::int64_t first = 0; first < n; first += block) {
        watch.step("contact flexibility", 0.8 + 0.2 * static_cast<double>(first) / static_cast<double>(n));
        Field some = attachment_.columns(first, std::min(block, n - first));
        solve(some);
        attachment_.put(first, some);
    }
}

// diag(B K^-1 B^T) without rigid-body motion, of the pairs that see more than that.
vector<double> Model::elastic_flexibility() const {
    const Matrix rigid_gap = n_rigid() > 0 ? gap_rows().of(rigid_modes()) : Matrix(gap_rows().n_rows(), 0);
    const auto rows = gap_rows().rows();
    vector<double> flexibility;
    for (std::int64_t i = 0; i < n_pairs(); ++i) {
        const std::int64_t row = Contact::normal_row(i);
        double whole = 0, rigid = 0;
        for (const GapRows::Term &t : rows[static_cast<std::size_t>(row)])
            whole += t.coefficient * attachment_.at(t.dof, row);
        for (std::int64_t j = 0; j < rigid_gap.cols(); ++j)
            rigid += rigid_gap(row, j) * rigid_gap(row, j) / shift();
        // below 1e-13 the difference is rounding: this pair sees rigid motion only
        if (whole - rigid > 1e-13 * whole) flexibility.push_back(whole - rigid);
    }
    return flexibility;
}

void Model::resolve_contact_stiffness() {
    if (n_pairs() == 0) return;
    const vector<double> flexibility = elastic_flexibility();
    if (!flexibility.empty()) local_stiffness_ = 1 / median(flexibility);
    for (std::int64_t i = 0; i < n_pairs(); ++i) {
        if (contact_.stiffness[i] != PLM_AUTO_STIFFNESS) continue;
        if (!(local_stiffness_ > 0))
            throw Error(PLM_ERR_ARGUMENT,
                        format("PLM_AUTO_STIFFNESS of pair %lld: the bodies are rigid at the "
                               "contact, so there is no local stiffness to go by; give k_n",
                               static_cast<long long>(i)))
                .argument("stiffness")
                .index(i);
        contact_.stiffness[i] = 10 * local_stiffness_;
    }
}

} // namespace plm
