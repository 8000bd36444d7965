// Apart from the functions of a study, so that the table of keys does not bring these into a static host.
#include "capi/study_results.hpp"

namespace plm::capi {

const StudyResult &last_run(const StudyHandle &h) {
    if (!h.result) throw Error(PLM_ERR_STATE, "the study has not run; run it first").argument("study");
    return *h.result;
}

} // namespace plm::capi
