// The Galerkin basis outside the exact modes: all static responses X = A^-1 F, A = K + sigma M, of which only
// small matrices are kept, and higher Krylov vectors Y, (A^-1 M)^j X s, of the directions s slow enough to
// need them. A Y and the coupling of M to the responses, X^T M Y = F^T (A^-1 M Y), come from the next power.
#pragma once
#include "linalg/lapack.hpp"
#include "space/static_responses.hpp"

namespace plm {

/// What is asked of the share of energy that a direction leaves out: of its own, and of that of a load.
struct AskedError {
    double contact, loads;
};

class AttachmentBasis {
  public:
    /// reach: omega^2 + sigma at the highest frequency of interest (rad^2/s^2); 0: statics alone.
    AttachmentBasis(std::shared_ptr<const Structure> structure,
                    std::shared_ptr<const StaticResponses> responses, double reach);

    std::int64_t size() const { return ritz_.vectors.cols(); }
    /// Most powers of a direction, 1: the responses alone.
    std::int64_t n_blocks() const;
    /// Goes on with the directions whose share of inertia rho asks for more powers n: until rho^2n, or
    /// `most` powers, is reached. False: there were none.
    bool refine(AskedError asked, std::int64_t most, Watch watch);

    /// Adds the responses to these forces, but for combinations of them of no more energy than `least`, and
    /// returns what it added.
    Field add_responses(Field forces, double least);

    /// What would be left out after refine(), the sums over all directions: many leave out next to nothing,
    /// and together more than the slowest.
    AskedError left_after(AskedError asked, std::int64_t most) const;

    /// Of M in a basis that is A-orthonormal: compliances 1 / (lambda + sigma), descending.
    const SymmetricEigen &ritz() const { return ritz_; }
    /// The vectors of that basis: X times the first and Y times the second, s x size() and q x size().
    const Matrix &of_responses() const { return of_responses_; }
    const Matrix &of_further() const { return of_further_; }
    /// Y; there is none afterwards.
    Field take_further() { return std::move(further_); }
    /// F^T times these vectors.
    Matrix works() const;
    /// Their combination, and their products with forces outside the modes that have this response to them.
    Field combine(const Matrix &y) const;
    Matrix products(const Field &forces, const Field &response) const;

  private:
    void orthonormalise_responses();
    void set_shares_of_loads();
    void rayleigh_ritz();
    double left(std::size_t direction, std::int64_t power) const;
    bool is_finished(std::size_t direction, std::int64_t power, AskedError asked, std::int64_t most) const;
    vector<std::int64_t> unfinished(AskedError asked, std::int64_t most) const;
    std::int64_t powers_missing(AskedError asked, std::int64_t most) const;
    void begin(const vector<std::int64_t> &directions);
    void advance(const vector<std::int64_t> &directions);
    Field next_power(Field momenta) const;
    Field appended(const Field &y);
    Field append_with_coupling(const Field &y);

    std::shared_ptr<const Structure> structure_;
    std::shared_ptr<const StaticResponses> responses_;
    ActingForces forces_;
    double reach_;
    Matrix orthonormal_, slow_;       // X T is A-orthonormal; X S are its Ritz vectors, slowest first
    Matrix inertia_;                  // of X T
    vector<double> share_;            // rho, of each Ritz vector: reach x'Mx / x'Ax
    vector<double> of_loads_;         // of each: the most of a load's energy that is in it
    vector<std::int64_t> power_;      // of each: blocks it is in
    vector<std::int64_t> at_;         // of each: column of frontier_, or -1
    Field frontier_;                  // the next power of the last one of each direction
    Field further_;                   // Y
    Matrix works_, coupling_;         // F^T Y and X^T M Y
    Matrix energy_, further_inertia_; // Y^T A Y, Y^T M Y
    Matrix of_responses_, of_further_;
    SymmetricEigen ritz_;
};

} // namespace plm
