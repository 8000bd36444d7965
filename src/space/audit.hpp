// Looks a built model over for what engineers get wrong: units, missing mass, loose bodies, gap signs,
// contact stiffness. Every finding is a fact with a number; its severity says whether to worry.
#pragma once
#include "space/model.hpp"

namespace plm {

struct Finding {
    int severity = 0; // 0 fact, 1 worth a look, 2 probably wrong
    double value = 0; // the number the finding is about
    std::string text;
};

std::vector<Finding> audit(const Model &model);
/// What costs next to nothing: without the lowest frequency.
std::vector<Finding> quick_audit(const Model &model);

} // namespace plm
