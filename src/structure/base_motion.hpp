// Supports that move: fixed DOFs whose motion is prescribed.
#pragma once
#include "structure/dof_map.hpp"
#include "structure/loads.hpp"
#include <complex>

namespace plm {

/// How the rows of the gap matrix move with the supports: at a part's power of the frequency, complex.
struct RowMotion {
    LoadPart part;
    vector<double> real, imag;
};

/// What is added to a result of a motion because it is known, Re(u exp(i h omega t)): u by the harmonic h.
using KnownMotion = std::map<int, std::complex<double>>;
/// At a phase of the excitation (rad).
inline double value_at(const KnownMotion &known, double phase) {
    double value = 0;
    for (const auto &[harmonic, u] : known) value += (u * std::polar(1.0, harmonic * phase)).real();
    return value;
}

/// u_s = omega^power Re(U exp(i h omega t)) at the fixed DOFs. The motion of the free ones is counted from L
/// u_s, with which they follow at rest, L = -K_ff^-1 K_fs: relative to the base. What is left of the motion
/// of the base is a force, -(M_ff L + M_fs) u_s'' - (C_ff L + C_fs) u_s', and a motion of the gaps, -(B_f L +
/// B_s) u_s, which is none where the base moves as a rigid body and all that touches with it.
class BaseMotion {
  public:
    BaseMotion() = default;
    /// Checks that what moves is among the fixed DOFs, and that the constraints let it. prescribed: over all
    /// DOFs; of the power 0 a displacement, -1 a velocity, -2 an acceleration. held: at zero but for that.
    BaseMotion(const HarmonicLoads &prescribed, std::int64_t n_dof, const vector<std::int64_t> &fixed,
               const vector<std::int64_t> &held, const ConstraintRows &constraints);
    bool empty() const { return parts_.empty(); }

    /// Through one matrix over all DOFs, A_fs U.
    enum Through { mass, stiffness, damping, n_matrices };
    void act(Through which, const SparseMatrix &all, const DofMap &dofs);
    /// The free DOFs on which it does.
    void mark_driven(vector<char> &moves) const;

    /// Once the stiffness has acted: L U by the factor of K and shift times M, before what follows is asked.
    void follow(const TallFactor &factor);
    /// C = alpha M + beta K + damping, K (1 + i structural).
    struct Matrices {
        const Tall &structure;
        double shift, alpha, beta, structural;
    };
    void add_forces(const Matrices &m, HarmonicForces &excitation) const;
    /// With the base: U + L U of a sum over all DOFs.
    KnownMotion of(const DofTerms &sum, const DofMap &dofs, double omega) const;
    /// The rows as triplets over all DOFs.
    std::vector<RowMotion> row_motions(std::int64_t n_rows, const vector<std::int64_t> &row,
                                       const vector<std::int64_t> &dof, const vector<double> &coefficient,
                                       const DofMap &dofs) const;
    /// What of() needs.
    void write(ByteWriter &bytes) const;
    void read(ByteReader &bytes, std::int64_t n_dof, std::int64_t n_free);

  private:
    template <class Motion, class Bytes>
    static void pass(Motion &motion, std::int64_t n_dof, std::int64_t n_free, Bytes &bytes);
    std::int64_t columns() const { return moved_.cols(); }
    void carry(const vector<char> &moves, const vector<std::int64_t> &held,
               const ConstraintRows &constraints);
    std::vector<LoadPart> parts_;
    Matrix moved_; // U, and what constraints tie to it: n_dof x 2 parts, real and imaginary
    Field through_[n_matrices], lift_; // A_fs U and L U, n_free x 2 parts
};

} // namespace plm
