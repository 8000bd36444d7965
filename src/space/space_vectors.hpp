// The vectors of a space, V, or of a basis in it, P = V Y: small matrices that say what each is made of, and
// recovered when asked for. Those of a contact space are combinations of exact modes, of the responses to
// contact forces and loads, which are solved for, and of few further vectors.
#pragma once
#include "space/static_responses.hpp"
#include <map>

namespace plm {

class SpaceVectors {
  public:
    SpaceVectors() = default;
    /// V as it is.
    explicit SpaceVectors(Field vectors);
    /// What V is made of, and its coordinates in that: V = Phi A + X B + Y C with the responses X.
    struct Parts {
        std::shared_ptr<const Structure> structure;
        std::shared_ptr<const ExactModes> modes;
        Matrix of_modes, of_responses;        // p x m, s x m
        std::shared_ptr<const Field> further; // outside the modes: n_free x q
        Matrix of_further;                    // q x m
    };
    /// Of a space: too many to be formed as a whole.
    explicit SpaceVectors(Parts parts) : parts_(std::move(parts)) {}

    /// m vectors of which these rows alone are known: what asks for others answers PLM_ERR_STATE.
    static SpaceVectors absent(std::int64_t n_free, std::map<DofTerms, vector<double>> rows, std::int64_t m);
    bool is_absent() const { return recovered_ && recovered_->absent; }

    /// V Y, as a basis: few enough to be formed as a whole, which is done where more vectors were asked for
    /// than there are.
    SpaceVectors times(const Matrix &y) const;
    /// All of V, as a basis.
    SpaceVectors whole() const;

    std::int64_t rows() const { return parts_.further ? parts_.further->rows() : 0; }
    std::int64_t cols() const { return parts_.of_further.cols(); }
    /// What it keeps.
    std::int64_t bytes() const;

    /// All columns, of a basis: made when first asked for and kept, by all copies.
    const Field &formed() const;
    /// Whether they are there, or are made now since with `more` of them more vectors were asked for than
    /// there are. Never of a space.
    bool worth_forming(std::int64_t more) const;
    /// A sum of DOFs in all columns, zeros of an empty one; and entries of some DOFs (free indices), k x
    /// cols().
    vector<double> row(const DofTerms &sum) const;
    Matrix rows_at(const vector<std::int64_t> &rows) const;

    const Parts &parts() const { return parts_; }

  private:
    void require_present() const;
    // Of a basis.
    struct Recovered {
        std::shared_ptr<const Field> all;
        std::map<DofTerms, vector<double>> rows; // before there were all
        std::int64_t asked = 0;
        bool absent = false; // there are rows only
    };

    Parts parts_;
    std::shared_ptr<Recovered> recovered_;
};

/// V Y, V y and V^T F: to rounding, by as many solutions as there are columns.
Field combine(const SpaceVectors &v, const Matrix &y);
Field combine(const SpaceVectors &v, const vector<double> &y);
Matrix gram(const SpaceVectors &v, const Field &f);
/// X += factor V Y and factor V y.
void add_combination(double factor, const SpaceVectors &v, const Matrix &y, Field &x);
void add_combination(double factor, const SpaceVectors &v, const vector<double> &y, Field &x);
/// V, and some of its columns.
Field all_columns(const SpaceVectors &v);
Field columns(const SpaceVectors &v, std::int64_t first, std::int64_t count);
/// V^T F, empty where there is no load.
vector<double> projected(const SpaceVectors &v, const Field &load);
HarmonicLoads projected(const SpaceVectors &v, const HarmonicForces &loads);

} // namespace plm
