// The unreduced structure, the reference of all other kinds: P is the whole contact space.
#include "reduction/basis_kind.hpp"

namespace plm {
namespace {

constexpr BasisKind unreduced_kind() {
    BasisKind kind("full", "the unreduced structure");
    kind.any_parent = true; // which gives its contact space, where it has one
    return kind;
}

} // namespace

constexpr BasisKind basis_kinds::full = unreduced_kind();

} // namespace plm
