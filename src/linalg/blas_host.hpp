// What the BLAS that was loaded with the library does to its host, and the host's to the library.
#pragma once

namespace plm {

/// Did the loader give us a BLAS with 64-bit integers under the usual names? Its results would be nonsense.
bool blas_takes_other_integers();

/// A BLAS that libplm.so carries for itself (PLM_SELF_CONTAINED) works on the calling thread alone from now
/// on. One that is shared with the host is the host's business: nothing is done to it.
void keep_own_blas_to_one_thread();

} // namespace plm
