#include "orbits/branch_bytes.hpp"
#include "orbits/curve_progress_bytes.hpp"
#include "orbits/orbit_point.hpp"
#include "reduction/compression.hpp"
#include "reduction/reduced_model_bytes.hpp"
#include "reduction/widened_model.hpp"
#include "space/model_bytes.hpp"

namespace plm {
namespace {

constexpr std::int64_t most_periods = 1 << 20, least_point = 200; // bytes of a point at least
constexpr int most_beside = 4;                                    // closed curves beside curves beside ...
constexpr std::int64_t least_curve = 48, most_curves = 64;        // of a record: bytes of each, and how many

// The flows of the points that were read: they share the contact sets that they pass.
class ReadMotions {
  public:
    explicit ReadMotions(std::shared_ptr<const ReducedModel> reduced) : reduced_(std::move(reduced)) {}

    void read(ByteReader &bytes, BranchPoint &point) {
        KeptOrbit kept;
        bytes(kept.start.y);
        bytes(kept.start.v);
        bytes(kept.tolerance);
        bytes(kept.shares);
        bytes.require(reduced_->same_static, "an exact motion on a model that has none");
        bytes.require(point.omega > 0 && kept.tolerance >= 0 && kept.tolerance < 1,
                      "an exact motion of no period");
        if (!flow_ || reduced_->structural != 0) { // which is of one frequency
            flow_ = std::make_shared<const FlowModel>(reduced_, point.omega);
            modes_ = std::make_shared<ContactModesKept>(flow_);
        }
        require_length(bytes, kept.start.y, flow_->size());
        require_length(bytes, kept.start.v, flow_->size());
        require_length(bytes, kept.shares, reduced_->n_pairs());
        point.motion = motion_of(flow_, modes_, point, std::move(kept));
    }

  private:
    std::shared_ptr<const ReducedModel> reduced_;
    std::shared_ptr<const FlowModel> flow_;
    std::shared_ptr<ContactModesKept> modes_;
};

template <class Bytes, class P> void pass_coordinates(Bytes &bytes, const ReducedModel &m, P &p) {
    bytes(p.omega);
    bytes(p.eta_0);
    bytes(p.eta);
    require_length(bytes, p.eta_0, m.static_size());
    bytes.require(p.omega > 0 && p.eta.rows() == m.size() && p.eta.cols() % 2 == 0,
                  "a motion of another basis");
    bytes.integer(p.n_harmonics, 0, p.eta.cols() / 2);
    bytes(p.contact_motion);
    bool has_stiffness = p.contact_stiffness != nullptr;
    bytes(has_stiffness);
    if (!has_stiffness) return bytes.require(p.contact_motion.empty(), "a motion of pairs without stiffness");
    vector<double> stiffness;
    if constexpr (!Bytes::reads) stiffness = *p.contact_stiffness;
    bytes(stiffness);
    require_length(bytes, stiffness, m.n_pairs());
    bytes.require(p.contact_motion.rows() == m.n_pairs() && p.contact_motion.cols() % 2 == 1,
                  "a motion of other pairs");
    if constexpr (Bytes::reads)
        p.contact_stiffness = std::make_shared<const vector<double>>(std::move(stiffness));
}

template <class Bytes, class P> void pass_facts(Bytes &bytes, P &p) {
    bytes(p.harmonic_tail);
    bytes(p.harmonic_error);
    bytes(p.force_scale);
    bytes.integer(p.period_multiple, 1, most_periods);
    bytes(p.damping_ratio);
    bytes.integer(p.bifurcation, bifurcation::none, bifurcation::neimark_sacker);
    bytes(p.multipliers);
    bytes(p.multiplier_error);
    bytes(p.arclength);
    bytes(p.residual);
    bytes.integer(p.iterations, 0, INT64_MAX);
    bytes.integer(p.n_switching, 0, INT64_MAX);
}

template <class Bytes, class B> void pass_ending(Bytes &bytes, B &b) {
    bytes.integer(b.end_reason, 0, INT32_MAX);
    bytes.integer(b.newton_work.iterations, 0, INT64_MAX);
    bytes.integer(b.newton_work.factorizations, 0, INT64_MAX);
    bytes(b.newton_work.seconds);
    bytes.integer(b.failed_steps, 0, INT64_MAX);
    bytes(b.seconds);
    bytes(b.unknowns_used);
    bytes(b.sampled);
    pass_warnings(bytes, b.warnings);
    bytes(b.is_mode);
}

void write_curve(ByteWriter &bytes, const Branch &branch);

void write_record(ByteWriter &bytes, const SweepRecord &record) {
    bytes(record.options);
    bytes.size(static_cast<std::int64_t>(record.curves.size()), least_curve);
    for (const FollowedCurve &followed : record.curves) {
        bytes(followed.curve != nullptr);
        if (followed.curve) write_curve(bytes, *followed.curve);
        pass_warnings(bytes, followed.warnings);
        bytes(followed.allowed);
        bytes(followed.work);
        write_progress(bytes, followed.progress);
    }
}

void write_curve(ByteWriter &bytes, const Branch &branch) {
    const ReducedModel &m = branch.reduced();
    bytes(static_cast<std::int64_t>(fingerprint(*uncompressed(branch.reduced_model()))));
    bytes(m.from != nullptr);
    if (m.from) write_compressed(bytes, m);
    bytes(branch.force_scale());
    bytes(branch.period_multiple());
    bytes.size(static_cast<std::int64_t>(branch.points().size()), least_point);
    for (const BranchPoint &p : branch.points()) {
        pass_coordinates(bytes, m, p);
        pass_facts(bytes, p);
        KeptOrbit kept;
        const bool exact = kept_orbit(p, kept);
        bytes(exact);
        if (!exact) continue;
        bytes(kept.start.y);
        bytes(kept.start.v);
        bytes(kept.tolerance);
        bytes(kept.shares);
    }
    pass_ending(bytes, branch);
    bytes(branch.beside != nullptr);
    if (branch.beside) write_curve(bytes, *branch.beside);
    bytes(branch.record != nullptr);
    if (branch.record) write_record(bytes, *branch.record);
}

// That of the basis, or with P_0 in the place of P, as exact motions have it.
std::shared_ptr<const ReducedModel> model_with(std::uint64_t print,
                                               const std::shared_ptr<const ReducedModel> &basis) {
    if (print == fingerprint(*basis)) return basis;
    if (!basis->same_static && print == fingerprint(*widened(basis))) return widened(basis);
    throw Error(status::argument,
                "the bytes are those of a branch on another basis, or on the basis before it was built anew; "
                "read them with the basis that the branch was computed on")
        .argument("bytes");
}

std::shared_ptr<Branch> read_curve(ByteReader &bytes, const std::shared_ptr<const ReducedModel> &basis,
                                   int depth);

// n_points: of the curve that it goes with.
std::shared_ptr<const SweepRecord>
read_record(ByteReader &bytes, const std::shared_ptr<const ReducedModel> &basis, std::int64_t n_points) {
    const auto record = std::make_shared<SweepRecord>();
    bytes(record->options);
    const std::int64_t n = bytes.size(0, least_curve);
    bytes.require(n >= 1 && n <= most_curves, "a sweep of no curve, or of too many");
    for (std::int64_t k = 0; k < n; ++k) {
        FollowedCurve followed;
        bool has_own = false;
        bytes(has_own);
        bytes.require(has_own || k == n - 1, "a curve that is not there");
        if (has_own) followed.curve = read_curve(bytes, basis, most_beside);
        pass_warnings(bytes, followed.warnings);
        bytes(followed.allowed);
        bytes.integer(followed.work, 0, most_work);
        followed.progress = read_progress(
            bytes, has_own ? static_cast<std::int64_t>(followed.curve->points().size()) : n_points);
        record->curves.push_back(std::move(followed));
    }
    return record;
}

std::shared_ptr<Branch> read_curve(ByteReader &bytes, const std::shared_ptr<const ReducedModel> &basis,
                                   int depth) {
    std::int64_t print = 0, periods = 1;
    bytes(print);
    std::shared_ptr<const ReducedModel> model = model_with(static_cast<std::uint64_t>(print), basis);
    bool compressed = false;
    bytes(compressed);
    if (compressed) model = read_compressed(bytes, std::move(model));
    double force = 0;
    bytes(force);
    bytes.integer(periods, 1, most_periods);
    const auto branch = std::make_shared<Branch>(model, force, periods);
    ReadMotions motions(model);
    const std::int64_t n = bytes.size(0, least_point);
    bytes.require(n >= 1, "no points");
    for (std::int64_t k = 0; k < n; ++k) {
        BranchPoint p;
        pass_coordinates(bytes, *model, p);
        pass_facts(bytes, p);
        bool exact = false;
        bytes(exact);
        if (exact) motions.read(bytes, p);
        branch->append(std::move(p));
    }
    pass_ending(bytes, *branch);
    bool beside = false;
    bytes(beside);
    bytes.require(!beside || depth < most_beside, "curves beside curves without end");
    if (beside) branch->beside = read_curve(bytes, basis, depth + 1);
    bool recorded = false;
    bytes(recorded);
    bytes.require(!recorded || depth == 0, "a sweep within a sweep");
    if (recorded) branch->record = read_record(bytes, basis, n);
    return branch;
}

} // namespace

void write_branch(ByteWriter &bytes, const Branch &branch) {
    write_curve(bytes, branch);
}

std::shared_ptr<Branch> read_branch(ByteReader &bytes, const std::shared_ptr<const ReducedModel> &basis) {
    return read_curve(bytes, basis, 0);
}

} // namespace plm
