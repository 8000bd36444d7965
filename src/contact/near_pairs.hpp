// The penetrations on a piece of a flow as polynomials. The products with the gap rows are those of the pairs
// alone that may come to zero within the piece; of others it is enough to know on which side they are.
#pragma once
#include "linalg/dense.hpp"

namespace plm {

class NearPairs {
  public:
    /// now: the penetrations at the beginning (Z); travel: bounds of how far each may go within the piece.
    /// gap_by_pair: n x Z. powers: the coordinates as polynomials, terms x n, or n x terms with op 'T'.
    /// penetration (terms x Z) holds what acts besides the coordinates; what these do is added, or `now` put
    /// in place of both.
    void expand(const vector<double> &now, const vector<double> &travel, const Matrix &gap_by_pair, char op,
                const Matrix &powers, Matrix &penetration);

  private:
    vector<std::int64_t> near_;
    Matrix rows_, moved_;
};

} // namespace plm
