// The structure without its contact: M q'' + C q' + K q = F(t) on its free DOFs, checked once and then
// read-only, and all that the method does with it. The gap rows B are among it, for they are as long as it
// is; what the pairs do is not.
#pragma once
#include "linalg/monitor.hpp"
#include "structure/base_motion.hpp"
#include "structure/dof_map.hpp"
#include "structure/eigs.hpp"
#include "structure/gap_rows.hpp"
#include "structure/geometry.hpp"
#include "structure/loads.hpp"
#include "structure/mode_count.hpp"
#include "structure/still_dofs.hpp"
#include "structure/translations.hpp"
#include "structure/unheld_motion.hpp"
#include <functional>
#include <memory>

namespace plm {

struct Damping {
    double alpha = 0, beta = 0; // C = alpha M + beta K
    double structural = 0;      // K (1 + i eta), h >= 1
    vector<double> modal_ratio; // of the open system's modes, the last one for all beyond
    bool has_matrix = false;    // an explicit C is present (Structure::damping_times)
};

class ByteReader;
class ByteWriter;

/// One matrix as the caller gave it: what to read, checked at the entry. Borrowed arrays stay the caller's.
struct MatrixInput; // structure/matrix_input.hpp

/// All that the caller said of the structure, before it is checked as a whole. Indices base 0 over all n_dof.
struct StructureInput {
    std::int64_t n_dof = 0;
    std::shared_ptr<const MatrixInput> mass, stiffness, damping_matrix;
    Damping damping;
    vector<std::int64_t> fixed; // DOFs held at zero, in any order, some perhaps twice
    ConstraintRows constraints;
    vector<std::int64_t> multipliers; // DOFs whose rows of K are constraints (multipliers.hpp)
    vector<std::int64_t>
        elimination_order; // all DOFs, as the host wants them eliminated; empty: the library's order
    // gap matrix by rows: B = [row; dof; coefficient] triplets
    vector<std::int64_t> gap_row, gap_dof;
    vector<double> gap_coefficient;
    vector<CoupledNode> nodes;             // where the DOFs are; may be empty, or of some of them
    vector<double> preload;                // empty: none
    HarmonicLoads excitation, base_motion; // the latter of fixed DOFs (base_motion.hpp)
    /// What may be asked of motions beside the DOFs: sums over all of them, numbered on from n_dof. It may
    /// grow while structures know it, and what is in it stays; null: none.
    std::shared_ptr<const std::vector<DofTerms>> outputs;
};

/// Eigenpairs of K x = lambda M x, M-orthonormal.
struct StructureModes {
    vector<double> values; // rad^2/s^2, ascending
    Field vectors;
    /// What the search for them left, for one that goes on to more: taken by it. Null: nothing.
    std::shared_ptr<SearchRest> rest;
    bool may_miss_copies = false; // of multiple frequencies: they were not looked for
};

struct ModeSearch {
    std::function<bool()> cancelled;
    const StructureModes *known = nullptr; // the lowest of those asked for, from an earlier search
    bool keep_rest = false;
    bool look_for_missed = true; // of multiple frequencies; needless where modes are counted
};

/// Of K x = lambda M x with the factor of K - shift M, as Structure::lowest_modes(): for this room.
StructureModes lowest_modes(const TallMatrix &k, const TallMatrix &m, const TallFactor &factor, double shift,
                            std::int64_t n, const ModeSearch &search);

/// What a structure takes before anything is factored: bytes, and the factor.
struct StructureEstimate {
    std::int64_t n_free = 0;
    double bytes = 0;   // of M, K, C and the gap rows
    double counted = 0; // the sum of K and M that a count of modes forms, where it forms one
    std::optional<FactorEstimate> factor; // of such a sum; none: the host's solver alone knows
};

class Structure {
  public:
    /// From the bytes of another one: all but its matrices and what follows from them. What needs these
    /// answers PLM_ERR_STATE.
    explicit Structure(ByteReader &bytes);
    void write(ByteWriter &bytes) const;
    bool is_whole() const { return parts_->factor != nullptr; }
    /// Of its matrices, supports, constraints and gap rows, and of its loads and its damping: those of one
    /// model built twice are the same.
    std::uint64_t fingerprint() const {
        return parts_->fingerprint ? parts_->fingerprint : fingerprint_of_parts();
    }
    std::uint64_t fingerprint_of_loads() const;

    /// Checks the input as a whole, but factors nothing.
    static StructureEstimate estimate(const StructureInput &input, GapSize gap, const Solver &solver);

    /// Checks the input as a whole, removes fixed and dependent DOFs, factors K (or K + sigma M when K is
    /// singular), finds rigid-body modes. Throws plm::Error with the argument and index at fault.
    /// largest_contact: the largest k_n given by the caller, 0 if unknown; the scale where K has none.
    Structure(const StructureInput &input, GapSize gap, double largest_contact, const Solver &solver,
              Watch watch);
    /// The same structure under the loads and the damping of another input (its matrix apart): what was
    /// factored and found is shared.
    Structure(const Structure &built, const StructureInput &loads, Watch watch);
    Structure(const Structure &) = delete;

    std::int64_t n_dof() const { return n_dof_; }
    std::int64_t n_free() const { return parts_->dofs.n_free(); }
    /// DOF of a free index, to tell it by.
    std::int64_t dof(std::int64_t free_index) const { return parts_->dofs.told(free_index); }
    /// The DOFs of the caller, and the sums of them numbered on from there.
    std::int64_t n_outputs() const {
        return n_dof_ + (outputs_ ? static_cast<std::int64_t>(outputs_->size()) : 0);
    }
    /// One of these by the free DOFs; empty where it is held at zero.
    DofTerms terms(std::int64_t output) const {
        return output < n_dof_ ? parts_->dofs.terms(output)
                               : parts_->dofs.terms((*outputs_)[output - n_dof_]);
    }
    /// Constraints that the others and the fixed DOFs say already.
    std::int64_t n_redundant_constraints() const { return parts_->dofs.elimination().n_redundant; }

    /// M X, K X, C X (the explicit part of the damping only) and (K + shift() M) X.
    Field mass_times(const Field &x) const { return tall().mass().times(x); }
    Field stiffness_times(const Field &x) const { return tall().stiffness().times(x); }
    Field damping_times(const Field &x) const;
    Field shifted_times(const Field &x) const {
        return parts_->shifted ? parts_->shifted->times(x) : stiffness_times(x);
    }
    /// y = M x and y = K x, one column each.
    void mass_times(const Field &x, Field &y) const { tall().mass().times(x, y); }
    void stiffness_times(const Field &x, Field &y) const { tall().stiffness().times(x, y); }
    /// X becomes (K + shift() M)^-1 X; shift() is 0 when K is positive definite.
    void solve(Field &x) const { whole().factor->solve(x); }
    double shift() const { return parts_->shift; }
    /// For the static responses X = (K + shift() M)^-1 F to F = [B^T loads]: F^T X and X^T M X, without
    /// keeping X and for less than a solution each. False where that is not to be had.
    bool multiply_responses(const Field &loads, Matrix &energy, Matrix &inertia) const;
    /// Rough, from the pivots of that factor.
    double reciprocal_condition() const { return whole().factor->reciprocal_condition(); }

    /// Whether modes can be counted.
    bool tells_inertia() const { return whole().solver.tells_inertia(); }
    /// The n lowest modes, fewer when there are fewer of finite frequency.
    StructureModes lowest_modes(std::int64_t n, const ModeSearch &search = {}) const;
    /// About the lowest elastic frequency (rad/s), from above, for a few solutions; 0 where there is none.
    double rough_lowest_elastic() const;
    /// Modes below omega (rad/s), cannot_tell_count or hit_a_mode; where it may move a little: near it.
    std::int64_t count_modes_below(double omega) const;
    std::int64_t count_modes_near(double &omega, Watch watch) const;
    /// M-orthonormal rigid-body modes (may have no column).
    const Field &rigid_modes() const { return whole().rigid_modes; }
    std::int64_t n_rigid() const { return parts_->n_rigid; }
    /// Rigid-body motions that no gap row holds, among them (unheld_motion.hpp): rows and loads that miss
    /// them by rounding do not act on them, which is warned of.
    std::int64_t n_unheld() const { return parts_->n_unheld; }
    /// Of the pre-load and of the mean of the excitation along them, more than rounding, so that they have
    /// nothing to rest on: what to read; empty where there is none.
    const std::string &preload_resultant() const { return preload_resultant_; }
    const std::string &mean_resultant() const { return mean_resultant_; }
    /// What rounding of K makes of the first elastic eigenvalue where there are rigid-body modes, relative.
    double uncertainty() const { return parts_->uncertainty; }

    const GapRows &gap_rows() const { return parts_->gap_rows; }
    /// The gap rows as they were handed over, in DOFs of the caller, less those that are held at zero.
    std::vector<DofTerms> given_gap_rows() const;
    /// B (K + shift() M)^-1 f of one load: how the gaps of the open structure answer it statically.
    vector<double> static_gaps(Field load) const {
        solve(load);
        vector<double> answer(static_cast<std::size_t>(parts_->gap_rows.n_rows()));
        parts_->gap_rows.of(load, answer);
        return answer;
    }
    const Damping &damping() const { return damping_options_; }
    bool has_preload() const { return !preload_.empty(); }
    const Field &preload() const { return preload_; } // one column, none without pre-load
    /// With what a motion of the base does as a force.
    const HarmonicForces &excitation() const { return excitation_; }
    /// What a motion of the base adds to one of the sums to be counted from where nothing moves.
    KnownMotion base_motion_of(std::int64_t output, double omega) const {
        return parts_->base.of((*outputs_)[output - n_dof_], parts_->dofs, omega);
    }
    /// And to the gaps.
    const std::vector<RowMotion> &row_motions() const { return parts_->row_motions; }

    /// Motions known to strain nothing before supports are applied; empty where the matrices do not tell.
    const vector<Translation> &translations() const { return parts_->translations; }
    /// Those held like fixed ones, which they were meant to be, since nothing moves them.
    const StillDofs &still_dofs() const { return parts_->still_dofs; }
    /// What the coordinates of nodes tell, where they are known.
    const Geometry &geometry() const { return parts_->geometry; }
    /// The stiffness matrix looks as if its diagonal was added up twice.
    bool diagonal_twice() const { return parts_->diagonal_twice; }
    /// Norm of the harmonic excitation on fixed DOFs, where it does nothing.
    double excitation_on_supports() const { return excitation_on_supports_; }
    double trace_of_mass() const;
    std::int64_t n_massless_dofs() const;

    /// Column j over all DOFs (n_dof numbers), fixed ones zero; and a motion of all DOFs, one column, by its
    /// free ones.
    void expand(const Field &x, std::int64_t j, double *all) const {
        parts_->dofs.expand(x.column(j).data(), all);
    }
    vector<double> expanded(const Field &x) const; // column 0
    Field restricted(const double *all) const;
    /// Zeros, where all others are.
    Field zeros(std::int64_t cols) const { return parts_->place.zeros(cols); }

    /// What lies behind the seam, and who factors it: for this room.
    const Tall &tall() const { return *whole().tall; }
    const Solver &solver() const { return parts_->solver; }
    /// The matrices on the free DOFs and who factors them: for this room, and for tests.
    struct Matrices {
        const SparseMatrix &mass, &stiffness, &damping; // damping: 0 x 0 without an explicit one
        const Solver &solver;
    };
    Matrices matrices() const {
        const Parts &p = whole();
        return {p.mass, p.stiffness, p.damping, p.solver};
    }

  private:
    Structure(const StructureInput &input, GapSize gap, const Solver &solver);
    template <class Self, class Bytes> static void pass(Self &self, Bytes &bytes);
    void assemble(const StructureInput &input, GapSize gap);
    void assemble_on(const vector<std::int64_t> &held, const ConstraintRows &constraints,
                     const StructureInput &input, GapSize gap);
    bool assemble_parts(const StructureInput &input, GapSize gap);
    void take_operations(const StructureInput &input);
    StillDofs find_still_dofs() const;
    void map_dofs(const vector<std::int64_t> &fixed, const ConstraintRows &constraints, WideRows wide);
    void warn_of_printed_constraints(Watch watch) const;
    bool assemble_matrices(const StructureInput &input);
    bool reduce(const char *name, const SparseMatrix &all, BaseMotion::Through which, SparseMatrix &reduced);
    void assemble_gap(const StructureInput &input, GapSize size);
    void assemble_loads(const StructureInput &input);
    void factor_stiffness(double largest_contact, Watch watch);
    void follow_supports(const StructureInput &input);
    void add_base_forces();
    void leave_out_rounding();
    void check_unheld_motion(Watch watch);
    std::string balance(Field &load, const char *name, Watch watch) const;
    void refuse_what_would_move_still_dofs(const StructureInput &loads) const;

    /// What neither loads nor damping change: made once, and shared by structures that differ in these.
    struct Parts {
        DofMap dofs;
        SparseMatrix mass, stiffness, damping; // empty where the host keeps them behind its operations
        bool in_core = true;
        std::unique_ptr<Tall> tall;          // of them
        std::unique_ptr<TallMatrix> shifted; // K + sigma M when sigma > 0
        Field place;                         // no columns, where all vectors are
        GapRows gap_rows;
        SparseMatrix given_gap_rows; // over all DOFs, where some are dependent
        vector<std::int64_t> multipliers;
        vector<Translation> translations;
        Geometry geometry;
        StillDofs still_dofs;
        bool diagonal_twice = false;
        BaseMotion base;
        std::vector<RowMotion> row_motions; // with it
        double shift = 0, uncertainty = 0;
        std::unique_ptr<TallFactor> factor;
        Field rigid_modes, unheld, unheld_momenta; // R, R_0, M R_0
        RowMiss miss;                              // of the gap rows along R_0
        Solver solver;
        std::int64_t n_rigid = 0, n_unheld = 0;
        // of the structure that bytes were written of; 0: this is one
        std::uint64_t fingerprint = 0, fingerprint_of_loads = 0;
    };
    /// PLM_ERR_STATE where its matrices are not here.
    const Parts &whole() const {
        if (!parts_->factor) throw_without_matrices();
        return *parts_;
    }
    [[noreturn]] static void throw_without_matrices();
    std::uint64_t fingerprint_of_parts() const;

    std::int64_t n_dof_ = 0;
    std::shared_ptr<const std::vector<DofTerms>> outputs_;
    std::shared_ptr<Parts> parts_; // changed by the constructor that makes it alone
    Damping damping_options_;
    Field preload_;
    HarmonicForces excitation_;
    double excitation_on_supports_ = 0;
    std::string preload_resultant_, mean_resultant_;
};

} // namespace plm
