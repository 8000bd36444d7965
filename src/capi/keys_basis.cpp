#include "capi/handles.hpp"
#include "capi/keys.hpp"
#include "reduction/basis_kind.hpp"
#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>

namespace plm::capi {
namespace {

using H = BasisHandle;
using Ints = vector<std::int64_t>;
using Reals = vector<double>;

const Basis &core(const H &h) {
    return *built(h);
}
const BasisReport &report(const H &h) {
    return core(h).report();
}

Reals frequencies_hz(const H &h) {
    Reals f = core(h).reduced()->lambda;
    f.resize(f.size() - core(h).reduced()->n_massless);
    for (double &x : f) x = std::sqrt(std::max(0.0, x)) / (2 * M_PI);
    return f;
}

Ints pairs_carried(const H &h) {
    const ReducedModel &reduced = *core(h).reduced();
    if (reduced.all_pairs) return reduced.carried;
    Ints all;
    for (std::int64_t i = 0; i < reduced.n_pairs(); ++i) all.push_back(i);
    return all;
}

template <class Out, class Get> Out per_sample(const H &h, Get get) {
    Out out;
    for (const SampleSelection &s : report(h).samples) out.push_back(get(s));
    return out;
}
template <class Out, class Member> Out per_mode(const H &h, Member member) {
    Out out;
    for (const SampleSelection &s : report(h).samples)
        out.insert(out.end(), (s.*member).begin(), (s.*member).end());
    return out;
}

// The kinds stand for their place in the register.
Key kind_option() {
    const auto joined = [](const char *separator, auto text) {
        std::string list;
        for (const BasisKind *kind : basis_kinds::all) list += (list.empty() ? "" : separator) + text(*kind);
        return list;
    };
    static const std::string names = joined(",", [](const BasisKind &k) { return std::string(k.name); });
    static const std::string descriptions =
        joined("; ", [](const BasisKind &k) { return std::string(k.name) + ": " + k.description; });
    Key key{"kind", PLM_TYPE_STRING, true, descriptions.c_str(), 0, 0, names.c_str()};
    key.read_option = [](const void *o, Value &v) {
        const BasisKind *kind = static_cast<const BasisOptions *>(o)->kind;
        v.integer = std::find(std::begin(basis_kinds::all), std::end(basis_kinds::all), kind) -
                    std::begin(basis_kinds::all);
    };
    key.write_option = [](void *o, const Value &v) {
        static_cast<BasisOptions *>(o)->kind = basis_kinds::all[v.integer];
    };
    return key;
}

// "<kind>: " before the text of every option that only this kind reads.
void name_their_kinds(std::vector<Key> &keys) {
    static std::deque<std::string> texts; // the keys point at them
    for (const BasisKind *kind : basis_kinds::all)
        for (const std::string &name : split_words(kind->own_options)) {
            const auto key =
                std::find_if(keys.begin(), keys.end(), [&](const Key &k) { return k.name == name; });
            if (key == keys.end())
                throw Error(PLM_ERR_INTERNAL, format("kind %s reads an option that is no key", kind->name));
            texts.push_back(std::string(kind->name) + ": " + key->description);
            key->description = texts.back().c_str();
        }
}

void add_options(std::vector<Key> &keys) {
    using O = BasisOptions;
    keys.insert(
        keys.end(),
        {
            kind_option(),
            choice_option<&O::selection>(
                "selection", "bands,below",
                "modes kept of each sample or linear system: inside the bands [h f_min, h f_max] (paper), or "
                "all below the highest"),
            int_option<&O::n_harmonics>("n_harmonics", 0, 1000,
                                        "harmonics h of the bands; 0: the sampler's, 5 without one"),
            real_option<&O::frequency_min_hz>("frequency_min_hz", 0, huge,
                                              "lower end of the window (Hz); 0: the sampler's"),
            real_option<&O::frequency_max_hz>("frequency_max_hz", 0, huge,
                                              "upper end of the window (Hz); 0: the sampler's"),
            real_option<&O::below_factor>("below_factor", 0.1, 100,
                                          "selection below: up to this multiple of n_harmonics x window end"),
            real_option<&O::svd_tolerance>("svd_tolerance", 0, 0.5,
                                           "singular values below this share of the largest are dropped"),
            int_option<&O::load_vectors>(
                "load_vectors", 0, 1,
                "all but full and pod: 1: the static responses to the loads are in the basis, too"),
            int_option<&O::static_augmentation>(
                "static_augmentation", 0, 1,
                "1: the static response to the pre-load joins the basis of h = 0"),
            real_option<&O::pod_tolerance>("pod_tolerance", 0, 0.5,
                                           "share of the responses that may be left out, in the energy norm"),
            int_option<&O::pod_size>("pod_size", 0, 1e9, "columns of P; 0: by pod_tolerance"),
            real_option<&O::equivalent_amplitude>(
                "equivalent_amplitude", 0, huge,
                "largest amplitude of a pair's relative motion (length); 0: that of the "
                "resonance under the excitation"),
            int_option<&O::n_discontinuities>(
                "n_discontinuities", 0, 1e9,
                "the leading jump patterns by flexibility; 0: one vector per pair"),
            real_option<&O::rest_factor>("rest_factor", 0.1, 100,
                                         "modes at rest up to this multiple of the window end"),
            int_option<&O::n_snapshots>("n_snapshots", 2, 10000,
                                        "static contact solutions for each dominant mode"),
            real_option<&O::snapshot_tolerance>(
                "snapshot_tolerance", 0, 0.5, "left out below this share of the motion, in the energy norm"),
            int_option<&O::n_pairs_carried>(
                "n_pairs_carried", 0, 1e9,
                "contact pairs in the equations (node sampling), the others lumped to them; 0: all"),
            choice_option<&O::pair_rule>(
                "pair_rule", "effective_independence,mdof",
                "how the pairs carried are chosen: by their share in the rank of the "
                "motion, or as master degrees of freedom"),
            int_option<&O::n_fixed_modes>("n_fixed_modes", 0, 1e9, "fixed-interface modes; 0: by frequency"),
        });
}

void add_results(std::vector<Key> &keys) {
    keys.insert(
        keys.end(),
        {
            result<H>("size", "columns r of P", [](const H &h) { return core(h).reduced()->size(); }),
            result<H>("static_size", "columns of P_0",
                      [](const H &h) { return core(h).reduced()->static_size(); }),
            result<H>("n_collected", "columns before conditioning",
                      [](const H &h) { return report(h).n_collected; }),
            result<H>("n_rest_modes", "snapshots: modes at rest among them",
                      [](const H &h) { return report(h).n_rest_modes; }),
            result<H>("singular_values", "singular values of the collected modes, the largest is 1",
                      [](const H &h) { return report(h).singular_values; }),
            result<H>("equivalent_share",
                      "share of k_n in the equivalent linear system, lelsm: of each mode's; lelsm_updated: "
                      "of each pair; else empty",
                      [](const H &h) { return report(h).equivalent_share; }),
            result<H>(
                "n_massless",
                "columns of P, the last ones, without mass: what has none, or so little that it follows "
                "statically, is no mode but a flexibility",
                [](const H &h) { return core(h).reduced()->n_massless; }),
            result<H>("lambda",
                      "reduced stiffness of each column of P over its reduced mass (rad^2/time^2); of those "
                      "without mass, over 1",
                      [](const H &h) { return core(h).reduced()->lambda; }),
            result<H>("frequencies_hz", "frequencies of those with mass (Hz)", frequencies_hz),
            result<H>("preload_residual",
                      "static response against P, L2 norm (paper, eq. (12)); 0 without pre-load",
                      [](const H &h) { return core(h).preload_residual(); }),
            result<H>("preload_residual_mass", "the same in the norm of M",
                      [](const H &h) { return report(h).preload_residual_mass; }),
            warning_text<H>([](const H &h) -> const Warnings & { return report(h).warnings; }),
            warning_reasons<H>([](const H &h) -> const Warnings & { return report(h).warnings; }),
            result<H>("setup_seconds", "time of the build (s)",
                      [](const H &h) { return report(h).setup_seconds; }),
            result<H>("highest_frequency_hz", "modes are taken up to here (Hz)",
                      [](const H &h) { return report(h).highest_frequency_hz; }),
            result<H>("n_harmonics_used", "harmonics h of the bands",
                      [](const H &h) { return report(h).n_harmonics; }),
            result<H>("n_dof", "DOFs of the model it was made of",
                      [](const H &h) { return core(h).model()->n_dof(); }),
            result<H>("n_pairs", "contact pairs of that model",
                      [](const H &h) { return core(h).model()->n_pairs(); }),
            result<H>("pairs_carried", "contact pairs in the equations, from 0", pairs_carried),
            result<H>("window_low_hz", "lower end of the window used (Hz)",
                      [](const H &h) { return core(h).window_min_hz(); }),
            result<H>("window_high_hz", "upper end of the window used (Hz)",
                      [](const H &h) { return core(h).window_max_hz(); }),
            result<H>("sample_n_modes", "modes computed of each sample",
                      [](const H &h) {
                          return per_sample<Ints>(
                              h, [](auto &s) { return static_cast<std::int64_t>(s.frequency_hz.size()); });
                      }),
            result<H>("sample_frequency_hz", "their frequencies, sample after sample (Hz)",
                      [](const H &h) { return per_mode<Reals>(h, &SampleSelection::frequency_hz); }),
            result<H>("sample_kept", "1 for each of them that was selected",
                      [](const H &h) { return per_mode<Ints>(h, &SampleSelection::kept); }),
            result<H>("sample_matched",
                      "of each sample the mode that matches the dominant one, from 0; -1: none",
                      [](const H &h) { return per_sample<Ints>(h, [](auto &s) { return s.matched; }); }),
            result<H>("sample_matched_mac", "its MAC with the dominant mode",
                      [](const H &h) { return per_sample<Reals>(h, [](auto &s) { return s.matched_mac; }); }),
            result<H>("sample_matched_kept", "1 when it was selected",
                      [](const H &h) {
                          return per_sample<Ints>(
                              h, [](auto &s) { return static_cast<std::int64_t>(s.matched_kept); });
                      }),
            result<H>("space_size", "dimension of the space the modes were computed in",
                      [](const H &h) { return core(h).space()->size(); }),
            result<H>("space_description", "what the modes were computed in",
                      [](const H &h) { return core(h).space()->description; }),
            result<H>("space_error", "relative error of the contact receptances at the highest frequency",
                      [](const H &h) { return core(h).space()->error_estimate; }),
        });
}

} // namespace

const std::vector<Key> &basis_keys() {
    static const std::vector<Key> keys = [] {
        std::vector<Key> k;
        add_options(k);
        name_their_kinds(k);
        add_results(k);
        return k;
    }();
    return keys;
}

} // namespace plm::capi
