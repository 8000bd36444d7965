// Two threads at once in a BLAS that is not made for it.
#pragma once

namespace plm {

/// An OpenBLAS built without threads, as Debian's libopenblas0-serial, has no lock around its work buffers:
/// two threads that call it at once get the same one now and then, and wrong numbers. Where the host's is
/// such a one, calls of it take turns: one of these lives during each. (A libplm.so that carries its own has
/// put a lock in, see carried/blas_parts.cpp; other BLAS libraries are left alone.)
class BlasTurn {
  public:
    BlasTurn();
    ~BlasTurn();
    BlasTurn(const BlasTurn &) = delete;
    BlasTurn &operator=(const BlasTurn &) = delete;

  private:
    const bool taken_;
};

} // namespace plm
