// Error against run time: methods, each a way to a response curve, are run and timed beside a reference and
// compared with it. This header is all that a caller needs; a build may leave the rest out (PLM_WITH_STUDY).
#pragma once
#include "study/plan.hpp"
#include "study/result.hpp"

namespace plm {

/// Throws for what no method can do without: an output, a method, a reference that can be solved. A method
/// that fails is a row of the result. PLM_CANCELLED is thrown when there is no reference yet. known: an
/// earlier contact space of the model, or null; with share_space the last one used is left there.
StudyResult run_study(const std::shared_ptr<const Model> &model, const StudyPlan &plan, Watch watch,
                      KnownSpace &known);

/// report.md, table.csv and curve_*.csv in the folder, which is made when its parent exists. PLM_ERR_ARGUMENT
/// when a file cannot be written.
void write_study(const StudyResult &result, const std::string &folder);

bool study_is_built();

} // namespace plm
