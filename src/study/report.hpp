// A study's result as text: the table for people (Markdown) and for programs (CSV), and the curves. The
// decimal sign is a point whatever the host's locale is.
#pragma once
#include "study/result.hpp"

namespace plm {

std::string report_markdown(const StudyResult &result);
/// One line per method, the reference first.
std::string table_csv(const StudyResult &result);
/// frequency_hz, amplitude.
std::string curve_csv(const PlaneSamples &samples);

} // namespace plm
