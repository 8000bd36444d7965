// One run of a method, timed: its basis from the options, and its curve at every force level.
#pragma once
#include "hbm/options.hpp"
#include "study/marching.hpp"
#include "study/plan.hpp"
#include "study/result.hpp"

namespace plm {

struct Measurement {
    std::shared_ptr<const Basis> basis;                // null: marching of the full model
    std::vector<std::shared_ptr<const Branch>> curves; // per level, or
    std::vector<MarchedCurve> marched;                 // per level
    std::int64_t size = 0;                             // coordinates
    double setup_seconds = 0, curve_seconds = 0, iteration_seconds = not_known;
    KnownSpace space;         // the contact space used; null: none
    double space_seconds = 0; // share of setup_seconds that its making took; 0 when it was known
    std::string note;         // what a reader of the row has to know besides how the curves ended
};

/// What one run needs besides the method. The recipe has been through with_window().
struct MeasurementCase {
    std::shared_ptr<const Model> model;
    Output output;
    std::vector<double> levels;
    FrequencyRange range; // where the method leaves it open
    KnownSpace space;     // for a method that needs one, or null: each makes its own
};

/// Without what a study measures itself: how good basis and harmonics of a method are.
std::string unmeasured_text(const Warnings &warnings);

/// The method's solver at a level, with the study's range where it has none of its own.
HbmOptions options_at_level(const MethodPlan &method, const MeasurementCase &where, double level);

/// The lowest and the highest force level, in this order; the highest alone where it tells what the lowest
/// would: the two are equal, or the response is proportional to the force.
std::vector<double> outermost_levels(const MeasurementCase &where);

/// Throws what the method throws; PLM_CANCELLED, too.
Measurement measure(const MethodPlan &method, const MeasurementCase &where, Watch watch);

/// What a row says of how the run went.
void describe(const Measurement &measurement, MethodResult &row);

} // namespace plm
