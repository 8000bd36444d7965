// The header comes first and alone, in two units of one program: it needs nothing before it and defines
// nothing twice.
#include <plm/plm.hpp>

#include "units.hpp"

plm::Model one_mass(const plm::Context &context) {
    plm::Model model(context, 1);
    model.set_mass(plm::triplets({0}, {0}, {1.0}));
    model.set_stiffness(plm::triplets({0}, {0}, {100.0}));
    return model;
}
