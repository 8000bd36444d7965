// Pairs on springs by their compliance, which has the rigid limit: T = 1/spring + C with the compliance C of
// what the springs hold on to.
#pragma once
#include "linalg/lapack.hpp"

namespace plm {

/// T, factored; spring: > 0. Throws PLM_ERR_SINGULAR.
DenseCholesky with_springs(Matrix compliance, const vector<double> &spring);

} // namespace plm
