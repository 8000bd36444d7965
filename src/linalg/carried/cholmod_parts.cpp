// Parts of our own in the carried CHOLMOD.
#include <cholmod.h>
#include <cstddef>

/// In place of CHOLMOD's, which prints: the status is kept for the caller, and that is all.
int cholmod_l_error(int status, const char *, int, const char *, cholmod_common *common) {
    if (common) common->status = status;
    return 1;
}

// Orderings by METIS are not carried: libplm orders by AMD (factor_cholmod.cpp says why), and
// cholmod_l_analyze comes here only when asked for them.
int cholmod_l_metis(cholmod_sparse *, SuiteSparse_long *, std::size_t, int, SuiteSparse_long *,
                    cholmod_common *common) {
    common->status = CHOLMOD_NOT_INSTALLED;
    return 0;
}
SuiteSparse_long cholmod_l_nested_dissection(cholmod_sparse *, SuiteSparse_long *, std::size_t,
                                             SuiteSparse_long *, SuiteSparse_long *, SuiteSparse_long *,
                                             cholmod_common *common) {
    common->status = CHOLMOD_NOT_INSTALLED;
    return -1; // CHOLMOD's "EMPTY"
}
