// Apart from the functions of a transient, so that the table of keys does not bring these into a static host.
#include "capi/transient_results.hpp"

namespace plm::capi {

const TransientRun &last_run(const TransientHandle &h) {
    if (!h.last_run)
        throw Error(PLM_ERR_STATE, "the transient has not run; run it first").argument("transient");
    return *h.last_run;
}

const PeriodicMotion &periodic_motion(const TransientHandle &h) {
    if (!h.periodic)
        throw Error(PLM_ERR_STATE, "no periodic motion was looked for since the start was set; "
                                   "look for one first")
            .argument("transient");
    return *h.periodic;
}

} // namespace plm::capi
