// What a call that is done says beside its results.
#pragma once
#include "linalg/warnings.hpp"
#include "plm/plm.h"

namespace plm::capi {

/// PLM_OK, or a status above 0 with the words for the context: cause and remedy.
struct Outcome {
    Outcome(plm_status s) : status(s) {}
    Outcome(plm_status s, std::int32_t r, std::string words) : status(s), reason(r), text(std::move(words)) {}
    /// PLM_WARNING where there is something to look at.
    Outcome(const Warnings &warnings)
        : status(warnings.empty() ? PLM_OK : PLM_WARNING),
          reason(warnings.empty() ? PLM_REASON_NONE : warnings.list().front().reason), text(warnings.text()) {
    }

    operator plm_status() const { return status; } // the words are lost

    plm_status status;
    std::int32_t reason = PLM_REASON_NONE;
    std::string text; // empty: that of the status
};

/// A sentence for a status; null for one that does not exist.
const char *status_words(plm_status status);

} // namespace plm::capi
