#include <plm/plm.hpp>

#include "units.hpp"
#include <cmath>

int main() {
    plm::Model model = one_mass(plm::Context());
    model.build();
    const double hz = model.modes(PLM_SYSTEM_OPEN, 1).frequency_hz[0];
    return std::abs(hz - 10 / (2 * 3.14159265358979323846)) < 1e-12 ? 0 : 1;
}
