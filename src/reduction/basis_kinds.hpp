// The register of the kinds of basis. A new kind is one file that defines its object (basis_kind.hpp), and
// its name here, twice.
#pragma once

namespace plm {

struct BasisKind;

namespace basis_kinds {
extern const BasisKind plm, craig_bampton, full, pod, bilinear, lelsm, lelsm_updated, discontinuity,
    snapshots;

/// In the order in which they are listed to the user.
inline constexpr const BasisKind *all[] = {&plm,   &craig_bampton, &full,          &pod,      &bilinear,
                                           &lelsm, &lelsm_updated, &discontinuity, &snapshots};
} // namespace basis_kinds
} // namespace plm
