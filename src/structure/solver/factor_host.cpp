// The host's own factorization behind the seam of factor.hpp.
#include "linalg/blas_lapack.hpp"
#include "structure/solver/factor_builtin.hpp"

namespace plm {
namespace {

SparseMatrix lower_triangle(const SparseMatrix &a) {
    SparseMatrix l;
    l.rows = l.cols = a.cols;
    l.ptr.assign(a.cols + 1, 0);
    l.idx.reserve(a.nnz() / 2 + a.cols);
    l.val.reserve(a.nnz() / 2 + a.cols);
    for (std::int64_t j = 0; j < a.cols; ++j) {
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p) {
            if (a.idx[p] < j) continue;
            l.idx.push_back(a.idx[p]);
            l.val.push_back(a.val[p]);
        }
        l.ptr[j + 1] = l.nnz();
    }
    return l;
}

class HostFactor final : public Factor {
  public:
    HostFactor(const SparseMatrix &a, bool positive_definite, const HostSolver &host)
        : host_(host), n_(a.cols) {
        if (!host.factor || !host.solve)
            throw Error(status::argument, "a host solver needs both a factor and a solve function");
        const SparseMatrix l = lower_triangle(a);
        const int status = host_.factor(n_, l.ptr.data(), l.idx.data(), l.val.data(), positive_definite,
                                        &handle_, host_.user);
        if (status != 0) // nothing was made, so the destructor (which would release it) need not run
            throw Error(status::callback, format("the host's factorization failed with code %d", status))
                .library_code(status);
    }
    ~HostFactor() override {
        if (host_.release) host_.release(handle_, host_.user);
    }
    HostFactor(const HostFactor &) = delete;
    HostFactor &operator=(const HostFactor &) = delete;

    void solve(double *x, std::int64_t nrhs, std::int64_t ldx) const override {
        if (n_ == 0 || nrhs == 0) return;
        const int status = host_.solve(handle_, nrhs, x, ldx, host_.user);
        if (status != 0)
            throw Error(status::callback, format("the host's solve failed with code %d", status))
                .library_code(status);
        for (std::int64_t j = 0; j < nrhs; ++j)
            if (!finite(x + j * ldx, n_))
                throw Error(status::callback, "the host's solve returned NaN or Inf").index(j);
    }
    std::int64_t negative_eigenvalues() const {
        if (!host_.inertia) return -1;
        std::int64_t negative = -1;
        const int status = host_.inertia(handle_, &negative, host_.user);
        if (status != 0)
            throw Error(status::callback, format("the host's inertia function failed with code %d", status))
                .library_code(status);
        if (negative < -1 || negative > n_)
            throw Error(status::callback,
                        format("the host's inertia function counts %lld negative eigenvalues of a matrix of "
                               "order %lld",
                               static_cast<long long>(negative), static_cast<long long>(n_)));
        return negative;
    }
    double reciprocal_condition() const override { return 1; }
    std::int64_t factor_nonzeros() const override { return -1; }
    bool calls_host() const override { return true; }

  private:
    HostSolver host_;
    std::int64_t n_;
    void *handle_ = nullptr;
};

} // namespace

std::unique_ptr<Factor> make_host_factor(const SparseMatrix &a, const HostSolver &host) {
    return std::make_unique<HostFactor>(a, true, host);
}

std::int64_t count_negative_by_host(const SparseMatrix &a, const HostSolver &host) {
    return HostFactor(a, false, host).negative_eigenvalues();
}

} // namespace plm
