// A basis as bytes: the reduced equations with P, the contact space in its small matrices (it judges curves)
// and the structure without its matrices. What is read sweeps without any of these; attached to the model
// it is again all that it was.
#include "reduction/basis.hpp"
#include "reduction/basis_kind.hpp"
#include "reduction/reduced_model_bytes.hpp"
#include "reduction/widened_model.hpp"
#include "space/model_bytes.hpp"
#include <algorithm>
#include <cmath>
#include <iterator>

namespace plm {
namespace {

template <class Bytes, class O> void pass_options(Bytes &bytes, O &o) {
    std::string kind;
    if constexpr (!Bytes::reads) kind = o.kind->name;
    bytes(kind);
    if constexpr (Bytes::reads) {
        const auto known = std::find_if(std::begin(basis_kinds::all), std::end(basis_kinds::all),
                                        [&](const BasisKind *k) { return kind == k->name; });
        bytes.require(known != std::end(basis_kinds::all), "a kind of basis that this library does not know");
        o.kind = *known;
    }
    bytes.integer(o.selection, 0, 1);
    bytes.integer(o.n_harmonics, 0, 1 << 20);
    bytes(o.frequency_min_hz);
    bytes(o.frequency_max_hz);
    bytes(o.below_factor);
    bytes(o.svd_tolerance);
    bytes(o.static_augmentation);
    bytes(o.load_vectors);
    bytes(o.pod_tolerance);
    bytes.integer(o.pod_size, 0, INT64_MAX);
    bytes(o.equivalent_amplitude);
    bytes.integer(o.n_discontinuities, 0, INT64_MAX);
    bytes(o.rest_factor);
    bytes.integer(o.n_snapshots, 0, INT64_MAX);
    bytes(o.snapshot_tolerance);
    bytes.integer(o.n_pairs_carried, 0, INT64_MAX);
    bytes.integer(o.pair_rule, 0, 1);
    bytes.integer(o.n_fixed_modes, 0, INT64_MAX);
}

template <class Bytes, class R> void pass_report(Bytes &bytes, R &r) {
    pass_list(bytes, r.samples, 40, [&](auto &sample) {
        bytes(sample.frequency_hz);
        bytes(sample.kept);
        require_length(bytes, sample.kept, static_cast<std::int64_t>(sample.frequency_hz.size()));
        bytes.integer(sample.matched, -1, static_cast<std::int64_t>(sample.frequency_hz.size()));
        bytes(sample.matched_mac);
        bytes(sample.matched_kept);
    });
    bytes.integer(r.n_collected, 0, INT64_MAX);
    bytes.integer(r.n_rest_modes, 0, INT64_MAX);
    bytes(r.singular_values);
    bytes(r.equivalent_share);
    bytes(r.preload_residual_mass);
    pass_warnings(bytes, r.warnings);
    bytes(r.setup_seconds);
    bytes(r.highest_frequency_hz);
    bytes.integer(r.n_harmonics, 0, 1 << 20);
}

template <class Bytes> void require_frequency(Bytes &bytes, double hz) {
    bytes.require(std::isfinite(hz) && hz >= 0, "a frequency that is none");
}

} // namespace

template <class Self, class Bytes> void Basis::pass(Self &self, Bytes &bytes) {
    pass_report(bytes, self.report_);
    bytes(self.window_min_hz_);
    bytes(self.window_max_hz_);
    for (double hz : {self.window_min_hz_, self.window_max_hz_, self.report_.highest_frequency_hz})
        require_frequency(bytes, hz);
    bytes(self.estimated_min_);
    bytes(self.estimated_max_);
}

void Basis::write(ByteWriter &bytes) const {
    model_->write(bytes);
    BasisOptions resolved = options_; // without the sampler that said how many
    resolved.n_harmonics = report_.n_harmonics;
    pass_options(bytes, resolved);
    pass(*this, bytes);
    bytes(preload_residual());
    space_->write(bytes);
    write_whole(bytes, *reduced_);
}

Basis::Basis(ByteReader &bytes) : model_(std::make_shared<const Model>(bytes)) {
    pass_options(bytes, options_);
    pass(*this, bytes);
    double residual = 0;
    bytes(residual);
    preload_residual_.get([&] { return residual; });
    space_ = Space::read(bytes, model_);
    reduced_ = read_whole(bytes, model_);
}

namespace {

/// But for rounding: what the library chose itself is a number of the structure, and another number of ranks
/// sums its parts in another order.
bool is_same_stiffness(const vector<double> &a, const vector<double> &b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](double x, double y) { return std::abs(x - y) <= 1e-9 * std::abs(y); });
}

} // namespace

Basis::Basis(const Basis &read, std::shared_ptr<const Model> model)
    : model_(std::move(model)), options_(read.options_), report_(read.report_), space_(read.space_),
      window_min_hz_(read.window_min_hz_), window_max_hz_(read.window_max_hz_),
      estimated_min_(read.estimated_min_), estimated_max_(read.estimated_max_) {
    if (read.model_->is_whole())
        throw Error(status::state,
                    "the basis has its model already; only one that was read from bytes is attached")
            .argument("basis");
    if (model_->fingerprint() != read.model_->fingerprint() ||
        !is_same_stiffness(model_->contact().stiffness, read.model_->contact().stiffness) ||
        model_->contact().initial_gap != read.model_->contact().initial_gap)
        throw Error(status::argument,
                    "the model is another one than the basis was made of: its matrices, supports, "
                    "constraints or contact differ; attach the same one, or build a basis on this one")
            .argument("model");
    if (model_->fingerprint_of_loads() != read.model_->fingerprint_of_loads())
        throw Error(status::argument,
                    "the loads or the damping of the model are others than those that the basis was made "
                    "with; set them as they were, or build a basis on this model")
            .argument("model");
    preload_residual_.get([&] { return read.preload_residual(); });
    const auto own = std::make_shared<ReducedModel>(*read.reduced_);
    own->model = model_;
    own->vectors = formed_beside(*model_, own->vectors);
    if (!own->same_static) own->vectors_0 = formed_beside(*model_, own->vectors_0);
    if (!own->same_static) keep_widened(*own, loads_when_widened(*read.reduced_));
    reduced_ = own;
}

} // namespace plm
