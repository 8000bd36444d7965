#include "space/model.hpp"
#include "linalg/error.hpp"
#include "space/memory_estimate.hpp"
#include <algorithm>
#include <utility>

namespace plm {
namespace {

// Largest k_n given by the caller, 0 if all are left to the library.
double largest_given(const vector<double> &contact_stiffness) {
    double largest = 0;
    for (double k : contact_stiffness) largest = std::max(largest, k);
    return largest;
}

// Of a contact area, for what its stiffness is compared with.
constexpr std::int64_t pairs_looked_at = 16;

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
      contact_(input.contact), space_options_(options), rest_forces_(input.rest_forces) {
    move_gaps();
    resolve_contact_stiffness(watch);
}

Model::Model(const Model &built, const ModelInput &loads, Watch watch)
    : Structure(built, loads, watch), contact_(built.contact_), local_stiffness_(built.local_stiffness_),
      known_modes_(built.known_modes_), space_options_(built.space_options_),
      rest_forces_(loads.rest_forces) {
    contact_.motion = loads.contact.motion;
    if (const StaticResponses *known = built.responses_.known()) known_modes_ = known->modes;
    move_gaps();
}

KnownMotion Model::known_motion(std::int64_t output, double omega, double scale) const {
    if (!space_options_.absolute_outputs || output < n_dof()) return {};
    KnownMotion known = base_motion_of(output, omega);
    for (auto &part : known) part.second *= scale;
    return known;
}

// With the base, beside what moves them anyhow.
void Model::move_gaps() {
    for (const RowMotion &base : row_motions()) {
        GapHarmonic &gaps = contact_.motion[base.part];
        gaps.real.resize(static_cast<std::size_t>(n_pairs()), 0.0);
        gaps.imag.resize(static_cast<std::size_t>(n_pairs()), 0.0);
        for (std::int64_t i = 0; i < n_pairs(); ++i) {
            const std::size_t pair = static_cast<std::size_t>(i),
                              row = static_cast<std::size_t>(Contact::normal_row(i));
            gaps.real[pair] += base.real[row];
            gaps.imag[pair] += base.imag[row];
        }
    }
}

std::shared_ptr<const ExactModes> Model::exact_modes_up_to(std::int64_t wanted, double cutoff, Watch watch,
                                                           ModeSearch search) const {
    watch.step("open modes", 0.0);
    search.cancelled = [watch] { return watch.cancelled("open modes", 0.3); };
    const bool keep_rest = std::exchange(search.keep_rest, search.keep_rest || cutoff > 0);
    wanted = std::min(wanted, n_free());
    StructureModes found;
    for (;;) {
        found = lowest_modes(wanted, search);
        search.known = &found;
        const std::int64_t count = static_cast<std::int64_t>(found.values.size());
        const bool are_all = count < wanted || wanted == n_free();
        if (are_all || found.values.back() >= cutoff * cutoff) {
            if (!keep_rest) found.rest.reset();
            return std::make_shared<const ExactModes>(exact_modes(*this, std::move(found), are_all));
        }
        wanted = std::min(n_free(), wanted + wanted / 2 + 10);
    }
}

std::shared_ptr<const ExactModes> Model::looked_over(const ExactModes &modes, Watch watch) const {
    ModeSearch search;
    search.known = &modes;
    return exact_modes_up_to(modes.count(), 0, watch, search);
}

// Whose modes cannot all be found has its rigid-body motion at least; a space asks for what it needs.
std::shared_ptr<const ExactModes> Model::modes_at_hand(Watch watch) const {
    if (known_modes_) return known_modes_;
    try {
        ModeSearch search;
        search.keep_rest = true; // a space mostly asks for more, and counts those that matter to it
        search.look_for_missed = !(space_options_.verify_counts && tells_inertia());
        return exact_modes_up_to(std::max(modes_anyhow, n_rigid() + 1), 0, watch, search);
    } catch (const Error &e) {
        if (e.status() != status::eigensolver) throw;
        StructureModes rigid{vector<double>(n_rigid(), 0.0), rigid_modes(), nullptr};
        if (n_rigid() == 0) rigid.vectors = zeros(0);
        return std::make_shared<const ExactModes>(exact_modes(*this, std::move(rigid), false));
    }
}

std::shared_ptr<const StaticResponses> Model::responses(Watch watch) const {
    return responses_.get([&] { return static_responses(*this, modes_at_hand(watch), watch); });
}

// diag(B K^-1 B^T) without rigid-body motion, of the pairs that see more than that.
vector<double> Model::elastic_flexibility(Watch watch) const {
    const std::shared_ptr<const StaticResponses> r = responses(watch);
    const vector<double> elastic = r->elastic_energies(shift()), whole = r->whole_energies(shift());
    vector<double> flexibility;
    for (std::int64_t i = 0; i < n_pairs(); ++i) {
        const std::int64_t row = Contact::normal_row(i);
        // below 1e-13 the difference is rounding: this pair sees rigid motion only
        if (elastic[row] > 1e-13 * whole[row]) flexibility.push_back(elastic[row]);
    }
    return flexibility;
}

// The same of pairs spread evenly, in a structure without rigid-body modes.
vector<double> Model::flexibility_of_some() const {
    Matrix unit(contact_.n_rows(), pairs_looked_at);
    for (std::int64_t j = 0; j < pairs_looked_at; ++j)
        unit(Contact::normal_row((2 * j + 1) * n_pairs() / (2 * pairs_looked_at)), j) = 1;
    const Field forces = gap_rows().forces(unit);
    Field x = forces;
    solve(x);
    return column_products(forces, x);
}

void Model::resolve_contact_stiffness(Watch watch) {
    if (n_pairs() == 0) return;
    const vector<double> &k = contact_.stiffness;
    const bool all_given = std::find(k.begin(), k.end(), auto_stiffness) == k.end(),
               some_tell = all_given && n_pairs() > pairs_looked_at && shift() == 0;
    const vector<double> flexibility = some_tell ? flexibility_of_some() : elastic_flexibility(watch);
    if (!flexibility.empty()) local_stiffness_ = 1 / median(flexibility);
    for (std::int64_t i = 0; i < n_pairs(); ++i) {
        if (contact_.stiffness[i] != auto_stiffness) continue;
        if (!(local_stiffness_ > 0))
            throw Error(status::argument,
                        format("PLM_AUTO_STIFFNESS of pair %lld: the bodies are rigid at the "
                               "contact, so there is no local stiffness to go by; give k_n",
                               static_cast<long long>(i)))
                .argument("stiffness")
                .index(i);
        contact_.stiffness[i] = 10 * local_stiffness_;
    }
}

} // namespace plm
