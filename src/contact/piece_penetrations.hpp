// The penetrations on a piece of a flow as polynomials. The products with the gap rows are those of the pairs
// alone that may come to zero within the piece; of others it is enough to know on which side they are.
#pragma once
#include "linalg/dense.hpp"

namespace plm {

class PiecePenetrations {
  public:
    /// at_begin: of all pairs (Z); travel: bounds of how far each may go within the piece. gap_by_pair: n x
    /// Z. powers: the coordinates as polynomials, terms x n, or n x terms with op 'T'. aside: what acts
    /// besides the coordinates, Z x as many terms or fewer.
    void expand(const vector<double> &at_begin, const vector<double> &travel, const Matrix &gap_by_pair,
                char op, const Matrix &powers, const Matrix &aside);
    /// All pairs as near ones: terms x Z.
    void expand(const Matrix &powers);
    /// Near pairs begin nearer to zero by so much (Z).
    void draw_near(const vector<double> &by);

    const vector<double> &at_begin() const { return at_begin_; }
    /// In ascending order, the pairs that may come to zero, and their penetrations, terms x near.
    const vector<std::int64_t> &near() const { return near_; }
    const Matrix &powers() const { return powers_; }

  private:
    void all_are_near(std::int64_t n_pairs);

    vector<double> at_begin_;
    vector<std::int64_t> near_;
    Matrix rows_, powers_;
};

} // namespace plm
