// What the BLAS that was loaded with the library does to its host, and the host's to the library.
#pragma once

namespace plm {

/// Did the loader give us a BLAS with 64-bit integers under the usual names? Its results would be nonsense.
bool blas_takes_other_integers();

/// A BLAS that libplm.so carries for itself (PLM_SELF_CONTAINED) works on the calling thread alone from now
/// on. One that is shared with the host is the host's business: nothing is done to it.
void keep_own_blas_to_one_thread();

/// The processor whose kernels such a BLAS works with; null where the library carries none.
const char *own_blas_kernels();

/// OpenBLAS takes a buffer for each of its calls that run at once, keeps it, and tries for ever where it gets
/// no memory. While one of these lives on a thread, OpenBLAS has a buffer for it; throws std::bad_alloc where
/// there is none. Other BLAS libraries are left alone.
class BlasBuffer {
  public:
    BlasBuffer();
    ~BlasBuffer();
    BlasBuffer(const BlasBuffer &) = delete;
    BlasBuffer &operator=(const BlasBuffer &) = delete;
};

} // namespace plm
