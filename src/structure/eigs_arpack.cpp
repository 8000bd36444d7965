// ARPACK in shift-invert mode (mode 3, bmat 'G') by reverse communication, for problems of an instant.
#include "linalg/blas_lapack.hpp"
#include "structure/eigs_internal.hpp"
#include <algorithm>
#include <mutex>

namespace plm {
namespace {

extern "C" {
void dsaupd_(blas_int *ido, const char *bmat, const blas_int *n, const char *which, const blas_int *nev,
             double *tol, double *resid, const blas_int *ncv, double *v, const blas_int *ldv,
             blas_int *iparam, blas_int *ipntr, double *workd, double *workl, const blas_int *lworkl,
             blas_int *info, strlen_t, strlen_t);
void dseupd_(const blas_int *rvec, const char *howmny, blas_int *select, double *d, double *z,
             const blas_int *ldz, const double *sigma, const char *bmat, const blas_int *n, const char *which,
             const blas_int *nev, double *tol, double *resid, const blas_int *ncv, double *v,
             const blas_int *ldv, blas_int *iparam, blas_int *ipntr, double *workd, double *workl,
             const blas_int *lworkl, blas_int *info, strlen_t, strlen_t, strlen_t);
}
#define dsaupd_(...) (BlasTurn(), dsaupd_(__VA_ARGS__))
#define dseupd_(...) (BlasTurn(), dseupd_(__VA_ARGS__))

/// ARPACK keeps its state between the calls of one problem in SAVE variables: two interleaved problems return
/// wrong eigenvalues with info = 0. The lock therefore spans the whole problem, and no function of the host's
/// is called under it: neither callback nor allocator.
std::mutex &arpack() {
    static std::mutex mutex;
    return mutex;
}

/// The arrays of one problem.
class Arpack {
  public:
    Arpack(const Pencil &pencil, const KrylovRequest &request)
        : pencil_(pencil), n_(to_blas(pencil.size())), nev_(to_blas(request.n_wanted)),
          ncv_(to_blas(request.n_lanczos)), lworkl_(to_blas(request.n_lanczos * (request.n_lanczos + 8))),
          tol_(request.tolerance), v_(n_, ncv_), resid_(n_, 1), moved_(n_, 1), answer_(n_, 1),
          workd_(3 * static_cast<std::size_t>(n_)), workl_(lworkl_), select_(ncv_), lambda_(nev_) {
        pseudo_random(resid_, request.seed);
        iparam_[0] = 1; // exact shifts
        iparam_[2] = to_blas(request.max_restarts);
        iparam_[6] = 3; // shift-invert
    }

    KrylovResult run() {
        blas_int info = 1; // resid holds the start vector
        {
            const std::lock_guard<std::mutex> lock(arpack());
            iterate(info);
            if (info >= 0 && iparam_[4] > 0) extract(info);
        }
        if (info < 0) return {KrylovEnd::exhausted, {}};
        const std::int64_t converged = std::min<std::int64_t>(iparam_[4], nev_);
        lambda_.resize(converged);
        return {converged < nev_ ? KrylovEnd::too_few : KrylovEnd::converged,
                {std::move(lambda_), Field(v_.columns(0, converged))}};
    }

  private:
    void iterate(blas_int &info) {
        blas_int ido = 0;
        for (;;) {
            dsaupd_(&ido, "G", &n_, "LM", &nev_, &tol_, resid_.data(), &ncv_, v_.data(), &n_, iparam_, ipntr_,
                    workd_.data(), workl_.data(), &lworkl_, &info, 1, 2);
            if (ido == 99) return;
            serve(ido);
        }
    }

    double *slot(int i) { return workd_.data() + (ipntr_[i] - 1); }

    void serve(blas_int ido) {
        double *x = slot(0), *y = slot(1);
        if (ido == 2) return mass_times(x, y);
        require(ido == -1 || ido == 1, "dsaupd: unexpected request");
        if (ido == 1)
            std::copy_n(slot(2), n_, y); // M x is there already
        else
            mass_times(x, y);
        double *answer = answer_.in_core().data();
        std::copy_n(y, n_, answer);
        pencil_.factor.solve(answer_);
        std::copy_n(answer, n_, y);
        if (!finite(y, n_)) // NaN in the Lanczos basis would go round until the last restart
            throw Error(status::eigensolver, "the factorization's solve returned NaN or Inf");
    }

    void mass_times(const double *x, double *y) {
        std::copy_n(x, n_, moved_.in_core().data());
        pencil_.m.times(moved_, answer_);
        std::copy_n(answer_.in_core().data(), n_, y);
    }

    void extract(blas_int &info) {
        const blas_int rvec = 1;
        dseupd_(&rvec, "A", select_.data(), lambda_.data(), v_.data(), &n_, &pencil_.shift, "G", &n_, "LM",
                &nev_, &tol_, resid_.data(), &ncv_, v_.data(), &n_, iparam_, ipntr_, workd_.data(),
                workl_.data(), &lworkl_, &info, 1, 1, 2);
        if (info > 0) info = -info; // a Schur form that could not be reordered: nothing was delivered
    }

    const Pencil &pencil_;
    blas_int n_, nev_, ncv_, lworkl_;
    double tol_;
    Matrix v_, resid_;
    Field moved_, answer_; // a column each
    vector<double> workd_, workl_;
    vector<blas_int> select_;
    vector<double> lambda_;
    blas_int iparam_[11] = {}, ipntr_[11] = {};
};

} // namespace

KrylovResult run_arpack(const Pencil &pencil, const KrylovRequest &request) {
    return Arpack(pencil, request).run();
}

} // namespace plm
