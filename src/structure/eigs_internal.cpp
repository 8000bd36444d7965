#include "structure/eigs_internal.hpp"
#include "linalg/error.hpp"

namespace plm {

void Pencil::poll() const {
    if (options.cancelled && options.cancelled())
        throw Error(status::cancelled, "cancelled by the progress callback").reason(reason::cancelled);
}

} // namespace plm
