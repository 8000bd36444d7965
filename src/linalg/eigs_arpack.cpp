// ARPACK in shift-invert mode (mode 3, bmat 'G') by reverse communication.
#include "blas_lapack.hpp"
#include "eigs_internal.hpp"
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

/// ARPACK keeps its state between the calls of one problem in SAVE variables: two interleaved problems return
/// wrong eigenvalues with info = 0. The lock therefore spans the whole problem. The host's callbacks run
/// inside; one that starts a second problem on the same thread gets an error instead of a deadlock.
class ArpackLock {
  public:
    ArpackLock() {
        if (inside_)
            throw Error(PLM_ERR_STATE,
                        "an eigenvalue problem was started from inside a callback of another one");
        mutex().lock();
        inside_ = true;
    }
    ~ArpackLock() {
        inside_ = false;
        mutex().unlock();
    }
    ArpackLock(const ArpackLock &) = delete;
    ArpackLock &operator=(const ArpackLock &) = delete;

  private:
    static std::mutex &mutex() {
        static std::mutex m;
        return m;
    }
    static thread_local bool inside_;
};
thread_local bool ArpackLock::inside_ = false;

/// Same start vector in every run, on every machine.
void pseudo_random(vector<double> &x, int seed) {
    std::uint64_t state = 0x9E3779B97F4A7C15u + static_cast<std::uint64_t>(seed);
    for (double &value : x) {
        state = state * 6364136223846793005u + 1442695040888963407u; // Knuth's MMIX generator
        value = static_cast<double>(state >> 11) * 0x1p-52 - 1;
    }
}

/// The arrays of one problem.
class Lanczos {
  public:
    Lanczos(const Pencil &pencil, const ArpackRequest &request)
        : pencil_(pencil), request_(request), n_(to_blas(pencil.size())), nev_(to_blas(request.n_wanted)),
          ncv_(to_blas(request.n_lanczos)), lworkl_(to_blas(request.n_lanczos * (request.n_lanczos + 8))),
          tol_(request.tolerance), v_(n_, ncv_), resid_(n_), workd_(3 * static_cast<std::size_t>(n_)),
          workl_(lworkl_), projection_(request.known ? request.known->cols() : 0) {
        pseudo_random(resid_, request.seed);
        iparam_[0] = 1; // exact shifts
        iparam_[2] = to_blas(request.max_restarts);
        iparam_[6] = 3; // shift-invert
    }

    ArpackResult run() {
        ArpackResult result;
        blas_int ido = 0, info = 1; // info = 1: resid holds the start vector
        for (;;) {
            dsaupd_(&ido, "G", &n_, "LM", &nev_, &tol_, resid_.data(), &ncv_, v_.data(), &n_, iparam_, ipntr_,
                    workd_.data(), workl_.data(), &lworkl_, &info, 1, 2);
            if (ido == 99) break;
            serve(ido);
        }
        result.info = info;
        if (info < 0 || iparam_[4] == 0) return result;
        extract(result);
        return result;
    }

  private:
    double *slot(int i) { return workd_.data() + (ipntr_[i] - 1); }

    void serve(blas_int ido) {
        pencil_.poll();
        double *x = slot(0), *y = slot(1);
        if (ido == 2)
            return multiply_transposed(pencil_.m, x, y); // M is symmetric: the gathering form is faster
        require(ido == -1 || ido == 1, "dsaupd: unexpected request");
        if (ido == 1)
            std::copy_n(slot(2), n_, y); // M x is there already
        else
            multiply_transposed(pencil_.m, x, y);
        pencil_.factor.solve(y, 1, n_);
        if (request_.known) { // y -= X X^T M y: stay M-orthogonal to the known vectors
            gemv('T', 1, *request_.m_known, y, 0, projection_.data());
            gemv('N', -1, *request_.known, projection_.data(), 1, y);
        }
        if (!finite(y, n_)) // NaN in the Lanczos basis would go round until the last restart
            throw Error(PLM_ERR_EIGENSOLVER, "the factorization's solve returned NaN or Inf");
    }

    void extract(ArpackResult &result) {
        const blas_int rvec = 1;
        vector<blas_int> select(ncv_);
        vector<double> values(nev_);
        blas_int info = 0;
        dseupd_(&rvec, "A", select.data(), values.data(), v_.data(), &n_, &pencil_.shift, "G", &n_, "LM",
                &nev_, &tol_, resid_.data(), &ncv_, v_.data(), &n_, iparam_, ipntr_, workd_.data(),
                workl_.data(), &lworkl_, &info, 1, 1, 2);
        if (info != 0) {
            result.info = info;
            return;
        }
        const std::int64_t converged = std::min<std::int64_t>(iparam_[4], nev_);
        values.resize(converged);
        result.pairs.values = std::move(values);
        result.pairs.vectors = v_.columns(0, converged);
    }

    const Pencil &pencil_;
    const ArpackRequest &request_;
    blas_int n_, nev_, ncv_, lworkl_;
    double tol_;
    Matrix v_;
    vector<double> resid_, workd_, workl_, projection_;
    blas_int iparam_[11] = {}, ipntr_[11] = {};
};

} // namespace

ArpackResult run_arpack(const Pencil &pencil, const ArpackRequest &request) {
    const ArpackLock lock;
    return Lanczos(pencil, request).run();
}

const char *arpack_meaning(int info) {
    switch (info) {
    case 1:
        return "too few eigenvalues converged within the allowed restarts";
    case 3:
        return "no shifts could be applied in a restart; more Lanczos vectors are needed";
    case -8:
        return "LAPACK failed on the tridiagonal eigenproblem";
    case -9:
        return "the start vector is zero in the norm of M";
    case -14:
        return "no eigenvalue was found to sufficient accuracy";
    case -9999:
        return "the Lanczos factorization could not be built; M may have too low a rank";
    default:
        return "see the documentation of dsaupd and dseupd";
    }
}

} // namespace plm
