#include "reduction/basis.hpp"
#include "linalg/lapack.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/conditioning.hpp"
#include "reduction/load_vectors.hpp"
#include "reduction/pair_sampling.hpp"
#include "reduction/projection.hpp"
#include "reduction/static_basis.hpp"
#include "reduction/widened_model.hpp"
#include "space/massless.hpp"
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace plm {
namespace {

constexpr std::int64_t least_open_modes = 10;

// Kinds about contact need a pair, and no more vectors than pairs.
void check_pairs(const BasisOptions &o, std::int64_t n_pairs) {
    if (o.kind->needs_pairs && n_pairs == 0)
        throw Error(status::argument,
                    format("a basis of kind %s is about contact, and the model has no contact pair; "
                           "\"full\" does without",
                           o.kind->name))
            .argument("kind");
    if (o.kind->check) o.kind->check(o, n_pairs);
}

void check_parents(const Model &model, const Sampler *sampler, const Basis *parent, const BasisKind &kind) {
    if (kind.needs_sampler && !sampler)
        throw Error(status::state, "this kind of basis needs the samples of a sampler that has run")
            .argument("sampler");
    if (sampler && sampler->space()->model.get() != &model)
        throw Error(status::argument, "the sampler belongs to another model").argument("sampler");
    if (!parent) return;
    if (parent->model().get() != &model)
        throw Error(status::argument, "the parent basis belongs to another model").argument("parent");
    if (kind.any_parent) return;
    if (parent->options().kind->is_collected() || parent->options().kind->is_compressed())
        throw Error(status::argument, "the parent must be of kind \"craig_bampton\" or \"full\"")
            .argument("parent");
}

SelectionRule make_rule(const BasisOptions &o, const Sampler *sampler) {
    SelectionRule rule;
    rule.selection = o.kind->is_collected() ? o.selection : ModeSelection::below;
    if (o.n_harmonics > 0 || sampler)
        rule.n_harmonics = o.n_harmonics > 0 ? o.n_harmonics : sampler->n_harmonics();
    rule.below_factor = o.below_factor;
    rule.min_hz = o.frequency_min_hz > 0 || !sampler ? o.frequency_min_hz : sampler->window().min_hz;
    rule.max_hz = o.frequency_max_hz > 0 || !sampler ? o.frequency_max_hz : sampler->window().max_hz;
    if (!(rule.max_hz > 0))
        throw Error(status::argument,
                    "frequency_max_hz is needed when there is no sampler to give the window")
            .argument("frequency_max_hz");
    if (!(rule.min_hz < rule.max_hz))
        throw Error(status::argument, format("frequency_min_hz (%g) must be below frequency_max_hz (%g)",
                                             rule.min_hz, rule.max_hz))
            .argument("frequency_min_hz");
    return rule;
}

// A space that was read from bytes has no vectors: it does where there are no matrices to make one of.
bool serves(const Space &space, const Model &model) {
    return !space.vectors.is_absent() || !model.is_whole();
}

std::shared_ptr<const Space> choose_space(const std::shared_ptr<const Model> &model, const Sampler *sampler,
                                          const Basis *parent, const BasisOptions &o, double highest_hz,
                                          Watch watch, std::shared_ptr<const Space> known) {
    const double highest = 2 * M_PI * highest_hz;
    if (o.kind->make_space) return o.kind->make_space(model, o, highest, watch);
    if (o.kind->is_collected() && parent) {
        if (parent->space()->highest_frequency < highest * (1 - 1e-9))
            watch.log(
                1,
                format(
                    "the parent basis is made for frequencies up to %.6g Hz, modes are taken up to %.6g Hz",
                    parent->space()->highest_frequency / (2 * M_PI), highest_hz));
        return parent->space();
    }
    if (parent && parent->space()->is_contact_space && serves(*parent->space(), *model) &&
        parent->space()->highest_frequency >= highest * (1 - 1e-9))
        return parent->space();
    if (sampler && sampler->space()->highest_frequency >= highest * (1 - 1e-9)) return sampler->space();
    return make_contact_space(model, highest, least_open_modes, watch,
                              sampler ? sampler->space() : std::move(known));
}

// The sampler's dominant modes in the coordinates of another space.
std::vector<vector<double>> dominant_coordinates(const Sampler &sampler, const Space &space) {
    std::vector<vector<double>> result;
    const Space &source = *sampler.space();
    for (const DominantMode &d : sampler.dominant()) {
        if (&source == &space) {
            result.push_back(d.coordinates);
            continue;
        }
        const auto works = [&](const Field &forces) { return gram(space.vectors, forces); };
        const Matrix c = coordinates_of(*space.model, combine(source.vectors, d.coordinates), works,
                                        space.lambda, space.n_massless);
        result.emplace_back(c.data(), c.data() + space.size());
    }
    return result;
}

struct Reduction {
    std::shared_ptr<const ReducedModel> reduced;
    BasisReport report;
};

// |q - P eta|_M / |q|_M (paper, eq. (12), (13)); P is M-orthonormal.
double mass_residual(const Model &model, const SpaceVectors &p, const Field &q) {
    const double size = column_products(q, model.mass_times(q))[0];
    if (!(size > 0)) return 0;
    Field remainder = q;
    for (int pass = 0; pass < 2; ++pass)
        add_combination(-1.0, p, gram(p, model.mass_times(remainder)), remainder);
    return std::sqrt(std::max(0.0, column_products(remainder, model.mass_times(remainder))[0]) / size);
}

Reduction reduce_to_vectors(const Space &space, const Sampler *sampler, const SelectionRule &rule,
                            const BasisOptions &o, Watch watch) {
    const RestState &rest = *rest_of(space);
    Reduction r;
    const auto dominant =
        o.kind->needs_sampler ? dominant_coordinates(*sampler, space) : std::vector<vector<double>>();
    CollectedModes collected = o.kind->collect({space, sampler, dominant, rest, rule, o}, watch);
    r.report.samples = std::move(collected.samples);
    r.report.equivalent_share = std::move(collected.equivalent_share);
    r.report.n_rest_modes = collected.n_rest_modes;
    Matrix columns = std::move(collected.columns);
    r.report.n_collected = columns.cols();
    watch.step("basis", 0.0);
    if (o.load_vectors && !o.kind->has_load_vectors) {
        const Matrix loads = load_vectors(space);
        if (!loads.empty()) columns.append(loads);
    }
    Conditioned conditioned = condition_columns(space, columns, o.svd_tolerance);
    r.report.singular_values = std::move(conditioned.singular_values);
    if (!collected.lost.empty())
        warn_of_lost_modes(r.report.samples, collected.lost, conditioned.coordinates, rule, watch);
    watch.step("basis", 0.3);
    StaticBasis statics;
    if (o.static_augmentation) statics = make_static_basis(space, conditioned.coordinates, rest.coordinates);
    watch.step("basis", 0.5);
    r.reduced = project(space, conditioned.coordinates, statics);
    watch.step("basis", 0.9);
    r.report.preload_residual_mass = relative_remainder(conditioned.coordinates, rest.coordinates);
    return r;
}

} // namespace

Basis::Basis(std::shared_ptr<const Model> model, std::shared_ptr<const Sampler> sampler,
             std::shared_ptr<const Basis> parent, const BasisOptions &options, Watch host,
             const Responses *responses, std::shared_ptr<const Space> known)
    : model_(std::move(model)), sampler_(std::move(sampler)), options_(options) {
    const auto start = std::chrono::steady_clock::now();
    const BasisKind &kind = *options_.kind;
    check_pairs(options_, model_->n_pairs());
    check_parents(*model_, sampler_.get(), parent.get(), kind);
    if (kind.is_compressed()) {
        compress_parent(parent.get(), responses);
        choose_pairs();
        report_.setup_seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        return;
    }
    Warnings warnings;
    const Watch watch = host.keeping(warnings);
    const SelectionRule rule = make_rule(options_, sampler_.get());
    window_min_hz_ = rule.min_hz;
    window_max_hz_ = rule.max_hz;
    const bool estimated = sampler_ && sampler_->options().window_max_hz == 0;
    estimated_min_ = estimated && options_.frequency_min_hz == 0;
    estimated_max_ = estimated && options_.frequency_max_hz == 0;
    const double modes_hz = kind.highest_hz ? kind.highest_hz(options_, rule) : rule.highest_hz();
    space_ = choose_space(model_, sampler_.get(), parent.get(), options_,
                          std::max(modes_hz, rule.highest_hz()), watch, std::move(known));
    if (kind.is_collected()) {
        Reduction r = reduce_to_vectors(*space_, sampler_.get(), rule, options_, watch);
        reduced_ = std::move(r.reduced);
        report_ = std::move(r.report);
    } else {
        watch.step("basis", 0.5);
        reduced_ = project_whole(*space_);
        report_.n_collected = space_->size();
    }
    choose_pairs();
    report_.highest_frequency_hz = modes_hz;
    report_.n_harmonics = rule.n_harmonics;
    report_.warnings = std::move(warnings);
    report_.setup_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Basis::compress_parent(const Basis *parent, const Responses *responses) {
    if (!parent)
        throw Error(status::state,
                    "a basis of kind pod needs the basis its responses were computed on; set that "
                    "as its parent first")
            .argument("parent");
    if (!responses)
        throw Error(status::state, "a basis of kind pod needs responses; set those of its parent first")
            .argument("responses");
    if (!of_one_basis(responses->of, parent->reduced()))
        throw Error(status::argument,
                    "the responses were computed on another basis than the parent, or it was "
                    "built anew in between; set both from one build")
            .argument("responses");
    sampler_ = parent->sampler();
    space_ = parent->space();
    window_min_hz_ = options_.frequency_min_hz > 0 ? options_.frequency_min_hz : parent->window_min_hz();
    window_max_hz_ = options_.frequency_max_hz > 0 ? options_.frequency_max_hz : parent->window_max_hz();
    estimated_min_ = parent->estimated_min_ && options_.frequency_min_hz == 0;
    estimated_max_ = parent->estimated_max_ && options_.frequency_max_hz == 0;
    if (!(window_min_hz_ < window_max_hz_))
        throw Error(status::argument, format("frequency_min_hz (%g) must be below frequency_max_hz (%g)",
                                             window_min_hz_, window_max_hz_))
            .argument("frequency_min_hz");
    Compressed c = options_.kind->compress(*responses, options_);
    reduced_ = std::move(c.reduced);
    report_.singular_values = std::move(c.singular_values);
    report_.n_collected = parent->reduced()->size();
    report_.highest_frequency_hz = parent->report().highest_frequency_hz;
    report_.n_harmonics = parent->report().n_harmonics;
}

// Half as much again in either direction: a resonance further off is not that of the dominant mode. Upwards
// the basis must still hold modes for the contact there; bands hold none outside the window.
SweepRange Basis::sweep_range() const {
    constexpr double reach = 1.5;
    SweepRange range{window_min_hz_, window_max_hz_, window_min_hz_, window_max_hz_};
    if (options_.kind->is_collected() && options_.selection == ModeSelection::bands) return range;
    if (estimated_min_) range.least_hz = window_min_hz_ / reach;
    if (estimated_max_)
        range.most_hz =
            std::max(window_max_hz_, std::min(reach * window_max_hz_, report_.highest_frequency_hz / reach));
    return range;
}

double Basis::preload_residual() const {
    return *preload_residual_.get([&] {
        if (!options_.kind->is_collected()) return 0.0;
        const RestState &rest = *rest_of(*space_);
        if (!(norm2(space_->size(), rest.coordinates.data()) > 0)) return 0.0;
        return projection_residual(*this, false, false, rest.displacement);
    });
}

void Basis::choose_pairs() {
    if (options_.n_pairs_carried > 0)
        reduced_ = sample_pairs(reduced_, *space_, options_.pair_rule, options_.n_pairs_carried,
                                2 * M_PI * window_max_hz_);
}

std::shared_ptr<const Basis> unreduced_basis(const std::shared_ptr<const Basis> &basis, Watch watch,
                                             std::shared_ptr<const Space> known) {
    if (basis->options().kind == &basis_kinds::full && !basis->reduced()->all_pairs) return basis;
    return *basis->unreduced_.get([&] {
        BasisOptions o = basis->options();
        o.kind = &basis_kinds::full;
        o.n_pairs_carried = 0;
        o.frequency_min_hz = basis->window_min_hz();
        o.frequency_max_hz = basis->window_max_hz();
        auto whole = std::make_shared<Basis>(basis->model(), basis->sampler(), basis, o, watch, nullptr,
                                             std::move(known));
        whole->estimated_min_ = basis->estimated_min_; // a sweep may go on beyond what was not asked for
        whole->estimated_max_ = basis->estimated_max_;
        return std::shared_ptr<const Basis>(std::move(whole));
    });
}

double projection_residual(const Basis &basis, bool is_static, bool use_mass, const Field &q) {
    const SpaceVectors &p = is_static ? basis.reduced()->static_vectors() : basis.reduced()->vectors;
    return use_mass ? mass_residual(*basis.model(), p, q) : euclidean_remainder(p.formed(), q);
}

} // namespace plm
