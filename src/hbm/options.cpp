#include "hbm/options.hpp"
#include "linalg/error.hpp"

namespace plm {

void require_consistent(const HbmOptions &o) {
    const auto refuse = [](const char *name, const std::string &text) {
        throw Error(status::argument, text).argument(name);
    };
    if (o.unknowns == NonlinearUnknowns::modal && o.formulation == FormulationKind::compliance)
        refuse("formulation",
               "the compliance formulation has the contact gaps as unknowns; set unknowns to gaps or auto");
    if (!(o.frequency_min_hz > 0 && o.frequency_max_hz > o.frequency_min_hz))
        refuse("frequency_min_hz",
               format("the frequency range [%g, %g] Hz is empty or not positive; set "
                      "frequency_min_hz < frequency_max_hz, or use a basis that has a window",
                      o.frequency_min_hz, o.frequency_max_hz));
    if (!(o.max_step > o.min_step)) refuse("min_step", "min_step must be below max_step");
}

} // namespace plm
