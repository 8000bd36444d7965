// What the coordinates of nodes tell of a structure: how its matrices answer when it moves as one rigid body,
// supports taken away.
#pragma once
#include "linalg/dense.hpp"
#include "structure/couplings.hpp"
#include "structure/sparse.hpp"

namespace plm {

class Geometry {
  public:
    Geometry() = default;
    /// The nodes of n_dof DOFs, none: nothing is known.
    Geometry(const vector<CoupledNode> &nodes, std::int64_t n_dof);
    bool is_known() const { return !nodes_.empty(); }

    /// The matrices over all DOFs, stiffness first. multipliers: their rows are no stiffness.
    void take_stiffness(const SparseMatrix &k, const vector<std::int64_t> &multipliers);
    void take_mass(const SparseMatrix &m);

    /// Whose DOF one is, and which of its six; node -1: of none that is known.
    struct Place {
        std::int64_t node = -1;
        std::size_t component = 0;
    };
    Place place(std::int64_t dof) const {
        return is_known() ? places_[static_cast<std::size_t>(dof)] : Place();
    }
    std::int64_t n_nodes() const { return static_cast<std::int64_t>(nodes_.size()); }
    /// Nodes by their number of DOFs, 0 to 6, and DOFs that no node has (modal ones, say).
    const std::array<std::int64_t, 7> &nodes_of_dofs() const { return nodes_of_dofs_; }
    std::int64_t n_others() const { return n_others_; }
    /// Corners of the box around them, and its diagonal.
    const Point &low() const { return low_; }
    const Point &high() const { return high_; }
    double size() const { return length(difference(high_, low_)); }

    /// Where a translation or a rotation (0 to 5: x, y, z, about x, y, z) leaves forces beyond rounding.
    struct Strain {
        std::int64_t count = 0, first = -1; // DOFs
        double largest = 0;                 // of their terms
        bool moves = false;                 // there are DOFs that move so
    };
    const std::array<Strain, 6> &strains() const { return strains_; }

    /// In the directions x, y, z; the centre of gravity; and the moments of inertia about it (xx, yy, zz, xy,
    /// xz, yz: of a body, the last three negative products). Zero where no DOF moves that way.
    struct Body {
        Point mass, centre;
        std::array<double, 6> inertia;
    };
    Body body() const;
    /// Of waves in the material, from the stiffness and mass of nodes and how near the next one is: right to
    /// a factor of about two. 0: not to be told.
    double wave_speed() const { return wave_speed_; }
    /// Of the mass at a node in the cube of that distance: more than the density of a solid whose elements
    /// are longer one way than another. 0: there are nodes with rotations, of shells and beams.
    double density_at_nodes() const { return density_; }

    /// What a row over all DOFs makes of one of these motions about the centre of the box, and the sum of
    /// its terms' absolute values with the box' size as arm.
    double moved(const DofTerms &row, std::size_t motion) const;
    double size_moved(const DofTerms &row, std::size_t motion) const;
    /// Sum c_j x_j with the coordinate that each translation goes along: of a row that says how much two
    /// points part, how far they are apart. False where it has other DOFs, or of one side alone.
    bool distance(const DofTerms &row, double &apart) const;
    /// How far two nodes stand from the line along which the row measures; 0 of rows with other nodes.
    double sideways(const DofTerms &row) const;

  private:
    double value(std::int64_t dof, std::size_t motion) const;
    const Point &at(std::int64_t dof) const { return nodes_[static_cast<std::size_t>(places_[dof].node)].at; }

    vector<CoupledNode> nodes_;
    vector<Place> places_; // of the DOFs
    std::array<std::int64_t, 7> nodes_of_dofs_{};
    std::int64_t n_others_ = 0;
    Point low_{}, high_{}, middle_{};
    std::array<Strain, 6> strains_{};
    vector<double> stiffness_, nearest_; // of nodes: largest of its translations, and the next node coupled
    Matrix inertia_;                     // 6 x 6, about the middle
    double wave_speed_ = 0, density_ = 0;
};

} // namespace plm
