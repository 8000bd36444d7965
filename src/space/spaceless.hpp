// The state of rest and the modes of a contact set without a contact space: by factorizations of the
// structure with the springs of closed pairs, one for each contact set that differs much. A space takes the
// work of a solution for every pair, and more; where only these few answers are wanted, and pairs are many,
// they come for much less.
#pragma once
#include "space/rest.hpp"
#include "structure/sprung_structure.hpp"

namespace plm {

class Spaceless {
  public:
    /// Null: not for less, or not to the same accuracy: few pairs, a small structure, rigid-body modes,
    /// springs far stiffer than the structure; or memory counts, for another factor stands beside the
    /// model's.
    static std::unique_ptr<Spaceless> if_worth(std::shared_ptr<const Model> model, std::int64_t n_modes,
                                               Watch watch);
    ~Spaceless();

    /// Throws as solve_static().
    std::shared_ptr<const RestState> rest();
    /// The n lowest, fewer when there are fewer of finite frequency; exact, unlike those in a space.
    StructureModes modes(const PairStates &states, std::int64_t n);

  private:
    class Equations;
    Spaceless(std::shared_ptr<const Model> model, Watch watch);
    void factor(const vector<double> &springs);

    std::shared_ptr<const Model> model_;
    Watch watch_;
    SprungStructure sprung_;
    vector<double> factored_; // the springs of its factorization
};

/// For whom rest is all that is wanted: without a space where that is worth it.
std::shared_ptr<const RestState> rest_of(const std::shared_ptr<const Model> &model, Watch watch);

} // namespace plm
