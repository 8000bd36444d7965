// In place of the rest of this folder when PLM_WITH_STUDY is OFF.
#include "study/study.hpp"

namespace plm {
namespace {

[[noreturn]] void left_out() {
    throw Error(status::not_built,
                "the study was left out of this build; configure libplm with -DPLM_WITH_STUDY=ON");
}

} // namespace

StudyResult run_study(const std::shared_ptr<const Model> &, const StudyPlan &, Watch, KnownSpace &) {
    left_out();
}

void write_study(const StudyResult &, const std::string &) {
    left_out();
}

bool study_is_built() {
    return false;
}

} // namespace plm
