// What spaces and bases write of small things: loads, warnings, contact.
#pragma once
#include "linalg/bytes.hpp"
#include "linalg/warnings.hpp"
#include "space/model.hpp"
#include "space/space_vectors.hpp"

namespace plm {

template <class Bytes, class Loads> void pass_loads(Bytes &bytes, Loads &loads) {
    const std::int64_t n = bytes.size(static_cast<std::int64_t>(loads.size()), 16);
    auto at = loads.begin();
    for (std::int64_t k = 0; k < n; ++k) {
        LoadPart part(0);
        HarmonicLoad load;
        if constexpr (!Bytes::reads) part = at->first, load = (at++)->second;
        bytes.integer(part.harmonic, 0, 1 << 20);
        bytes.integer(part.power, -64, 64);
        bytes(load.real);
        bytes(load.imag);
        if constexpr (Bytes::reads) loads[part] = std::move(load);
    }
}

/// Of loads that were read: in so many coordinates, those of harmonic 0 in others.
inline void require_loads(ByteReader &bytes, const HarmonicLoads &loads, std::int64_t r, std::int64_t r_0) {
    for (const auto &[part, load] : loads)
        for (const vector<double> *x : {&load.real, &load.imag})
            bytes.require(x->empty() ||
                              static_cast<std::int64_t>(x->size()) == (part.harmonic == 0 ? r_0 : r),
                          "a load in other coordinates");
}

template <class Bytes, class Texts> void pass_warnings(Bytes &bytes, Texts &warnings) {
    const std::int64_t n = bytes.size(static_cast<std::int64_t>(warnings.list().size()), 16);
    for (std::int64_t k = 0; k < n; ++k) {
        Warning w{0, {}};
        if constexpr (!Bytes::reads) w = warnings.list()[static_cast<std::size_t>(k)];
        bytes.integer(w.reason, INT32_MIN, INT32_MAX);
        bytes(w.text);
        if constexpr (Bytes::reads) warnings.add(w.reason, w.text);
    }
}

template <class Bytes, class C> void pass_contact(Bytes &bytes, C &contact) {
    bytes(contact.stiffness);
    bytes(contact.initial_gap);
    require_length(bytes, contact.initial_gap, contact.n_pairs());
    const std::int64_t n = bytes.size(static_cast<std::int64_t>(contact.motion.size()), 32);
    auto at = contact.motion.begin();
    for (std::int64_t k = 0; k < n; ++k) {
        LoadPart part(0);
        GapHarmonic gaps;
        if constexpr (!Bytes::reads) part = at->first, gaps = (at++)->second;
        bytes.integer(part.harmonic, 0, 1 << 20);
        bytes.integer(part.power, -2, 0);
        bytes(gaps.real);
        bytes(gaps.imag);
        bytes.require(static_cast<std::int64_t>(gaps.real.size()) <= contact.n_pairs() &&
                          static_cast<std::int64_t>(gaps.imag.size()) <= contact.n_pairs(),
                      "walls of more pairs than there are");
        if constexpr (Bytes::reads) contact.motion[part] = std::move(gaps);
    }
}

/// All columns, which are formed for it: n_free x cols(); read as vectors that are there.
void write_formed(ByteWriter &bytes, const SpaceVectors &vectors);
SpaceVectors read_formed(ByteReader &bytes, const Model &model, std::int64_t cols);
/// The same vectors, all of them, where those of another model of this structure lie: its host may keep them.
SpaceVectors formed_beside(const Model &model, const SpaceVectors &vectors);

} // namespace plm
