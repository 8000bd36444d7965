#include "structure/multipliers.hpp"
#include "linalg/error.hpp"

namespace plm {
namespace {

using Int = long long; // for printf

Error unfit(std::int64_t dof, const std::string &what) {
    return Error(
               status::matrix,
               format("DOF %lld (counted from 0) was handed over as a Lagrange multiplier, but ", Int(dof)) +
                   what)
        .argument("value")
        .index(dof);
}

} // namespace

void add_multiplier_rows(const SparseMatrix &k, const vector<std::int64_t> &multipliers,
                         ConstraintRows &rows) {
    vector<char> is_multiplier(k.cols, 0);
    for (std::int64_t dof : multipliers) is_multiplier[dof] = 1;
    for (std::int64_t j = 0; j < k.cols; ++j) {
        if (!is_multiplier[j]) continue;
        for (std::int64_t p = k.ptr[j]; p < k.ptr[j + 1]; ++p) {
            const std::int64_t i = k.idx[p];
            if (k.val[p] == 0) continue;
            if (is_multiplier[i])
                throw unfit(j, format("the stiffness matrix has %g at (%lld, %lld), among multipliers: only "
                                      "zeros stand there where constraints are exact. Fix these DOFs, and "
                                      "hand over the constraints themselves",
                                      k.val[p], Int(j), Int(i)));
            rows.dof.push_back(i), rows.coefficient.push_back(k.val[p]);
        }
        const auto end = static_cast<std::int64_t>(rows.dof.size());
        if (end == rows.ptr.back())
            throw unfit(j,
                        "its row of the stiffness matrix is empty: it says nothing; fix this DOF, or check "
                        "its number");
        rows.ptr.push_back(end);
    }
}

void require_none_at(const vector<std::int64_t> &multipliers, const char *name, const SparseMatrix &a) {
    for (std::int64_t j : multipliers)
        for (std::int64_t p = a.ptr[j]; p < a.ptr[j + 1]; ++p)
            if (a.val[p] != 0)
                throw unfit(j, format("the %s matrix has %g at (%lld, %lld): a multiplier has nothing there; "
                                      "check its number",
                                      name, a.val[p], Int(j), Int(a.idx[p])));
}

void require_none_at(const vector<std::int64_t> &multipliers, const char *name, const vector<double> &load) {
    if (load.empty()) return;
    for (std::int64_t j : multipliers)
        if (load[j] != 0)
            throw Error(status::argument,
                        format("the %s is %g at DOF %lld (counted from 0), which is a Lagrange multiplier: "
                               "its constraint would not be equal to zero, which is not to be had; move "
                               "what it prescribes into a gap, or take it as a load",
                               name, load[j], Int(j)))
                .argument("force")
                .index(j);
}

} // namespace plm
