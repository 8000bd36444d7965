// The static reference system of the harmonic balance in the contact gaps (h = 0): the open structure. Where
// rigid-body modes leave that without a receptance, a part of the contact stiffness is moved from the contact
// law into it, which is exact, and free motion (free_motion.hpp) is held.
#pragma once
#include "contact/law_form.hpp"
#include "linalg/lapack.hpp"
#include "motions/free_motion.hpp"

namespace plm {

class StaticReference {
  public:
    /// PLM_ERR_CONVERGENCE as require_balanced(); PLM_ERR_SINGULAR where contacts hardly hold the structure.
    StaticReference(std::shared_ptr<const ReducedModel> reduced, const LawForm &form);

    /// What was moved, of every pair: its force k (u + g) belongs to the reference, not to the contact.
    const vector<double> &stiffness() const { return stiffness_; }
    /// v (r_0) becomes the displacement under it.
    void apply(double *v) const;
    /// out = rows S^-1 rows'; rows is n x r_0.
    void receptance(const Matrix &rows, Matrix &out);

    /// Whether the reference is another one for other acting pairs; then hold() follows them. mean_load: r_0.
    bool depends_on_contact() const { return hold_.depends_on_contact(); }
    void hold(const ContactIndicator &indicator, const double *mean_load);
    /// As MeanHold::carried_away().
    bool carried_away() const { return hold_.carried_away(); }

  private:
    double share_of(double contact_stiffness, std::int64_t pair) const;
    void factor();

    std::shared_ptr<const ReducedModel> m_;
    vector<double> stiffness_;
    MeanHold hold_;
    DenseCholesky cholesky_;
    bool is_dense_ = false;
    Matrix solved_;
};

} // namespace plm
