#include "motions/branch_report.hpp"
#include "linalg/status.hpp"
#include "motions/branch_csv.hpp"
#include "reduction/basis_kind.hpp"
#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace plm {
namespace {

constexpr std::size_t widest = 100; // characters of a line
constexpr std::size_t named = 8;    // bifurcations and ranges named one by one

std::string number(double value, int digits = 6) {
    std::ostringstream t;
    t.imbue(std::locale::classic());
    t.precision(digits);
    t << value;
    return t.str();
}

std::string count(std::int64_t n, const char *one, const char *several) {
    return number(static_cast<double>(n)) + " " + (n == 1 ? one : several);
}

double hz_of(const BranchPoint &p) {
    return p.omega / (2 * M_PI);
}

class Page {
  public:
    void section(const char *title) { text_ += std::string(text_.empty() ? "" : "\n") + title + "\n"; }
    /// Broken between words; what follows the first line is indented further.
    void line(const std::string &words) {
        std::string row = "  ";
        std::istringstream in(words);
        for (std::string word; in >> word;) {
            if (row.size() + 1 + word.size() > widest && row.back() != ' ') {
                text_ += row + '\n';
                row = "    ";
            }
            row += (row.back() == ' ' ? "" : " ") + word;
        }
        text_ += row + '\n';
    }
    std::string text() && { return std::move(text_); }

  private:
    std::string text_;
};

const char *words_for(Measure measure) {
    switch (measure) {
    case Measure::peak:
        return "largest displacement";
    case Measure::half_peak_to_peak:
        return "half peak-to-peak displacement";
    case Measure::rms:
        return "root mean square";
    case Measure::harmonic:
        break;
    }
    return "magnitude of one harmonic";
}

std::string words_for(const Output &output, const Model &model) {
    std::string what = words_for(output.measure);
    if (output.measure == Measure::harmonic) what += ", number " + std::to_string(output.harmonic) + ",";
    const std::int64_t sum = output.dof - model.n_dof();
    return what + (sum < 0 ? " of DOF " + std::to_string(output.dof) + " (counted from 0)"
                           : " of the output " + std::to_string(sum) + " (a sum of DOFs, counted from 0)");
}

void add_model(Page &page, const ReducedModel &reduced) {
    const Model &model = *reduced.model;
    page.section("Model");
    page.line(count(model.n_dof(), "DOF", "DOFs") + ", " + number(static_cast<double>(model.n_free())) +
              " of them free; " + count(reduced.n_whole_pairs(), "contact pair", "contact pairs"));
    page.line("left out: friction, and all nonlinearity but that of the contact along its normals");
    if (const double of_host = model.space_options().reduction_error; of_host > 0)
        page.line("a reduction by the host, which states an error of " + number(of_host));
}

void add_basis(Page &page, const ReducedModel &reduced, const CurveFindings *found) {
    page.section("Basis");
    page.line(count(reduced.size(), "column", "columns") + " for the vibration, " +
              number(static_cast<double>(reduced.static_size())) + " for the mean" +
              (found ? ", of kind " + found->basis_kind : ""));
    if (reduced.all_pairs)
        page.line(number(static_cast<double>(reduced.n_pairs())) + " of the pairs carry the contact; " +
                  "left out, and stood for by their stiffness: " +
                  number(static_cast<double>(reduced.n_whole_pairs() - reduced.n_pairs())));
}

// Frequencies of the points of a kind.
std::string places_of(const Branch &branch, std::int32_t kind) {
    std::string list;
    std::size_t n = 0;
    for (const BranchPoint &p : branch.points()) {
        if (p.bifurcation != kind) continue;
        if (++n <= named) list += (list.empty() ? "" : ", ") + number(hz_of(p));
    }
    if (n > named) list += " and " + std::to_string(n - named) + " more";
    return list.empty() ? list : list + " Hz";
}

void add_curve(Page &page, const Branch &branch) {
    page.section("Curve");
    const std::vector<BranchPoint> &points = branch.points();
    std::string words = count(static_cast<std::int64_t>(points.size()), "point", "points");
    if (!points.empty()) {
        const auto [low, high] =
            std::minmax_element(points.begin(), points.end(),
                                [](const BranchPoint &a, const BranchPoint &b) { return a.omega < b.omega; });
        words += ", " + number(hz_of(*low)) + " .. " + number(hz_of(*high)) + " Hz";
    }
    page.line(words + ", at " + number(branch.force_scale()) + " times the excitation; " +
              end_text(branch.end_reason, branch.sampled));
    page.line(branch.unknowns_used == "state"
                  ? "each an exact motion: event by event in time, without harmonics to be truncated"
                  : "each a sum of up to " + count(branch.n_harmonics(), "harmonic", "harmonics"));
    if (branch.period_multiple() > 1)
        page.line("a period of the motion is " + std::to_string(branch.period_multiple()) +
                  " periods of the excitation");
    const std::pair<std::int32_t, const char *> kinds[] = {
        {bifurcation::fold, "folds"},
        {bifurcation::branch_point, "branch points"},
        {bifurcation::period_doubling, "period doublings"},
        {bifurcation::neimark_sacker, "Neimark-Sacker points"}};
    for (const auto &[kind, name] : kinds)
        if (const std::string places = places_of(branch, kind); !places.empty())
            page.line(std::string(name) + ": " + places);
}

void add_peak(Page &page, const Model &model, const CurveFindings *found) {
    page.section("Peak");
    if (!found || !found->peak.branch || found->peak.branch->points().empty()) {
        page.line("not looked for: find_peak of this curve, with the amplitude that is meant, tells");
        return;
    }
    const Peak &peak = found->peak;
    page.line(number(peak.amplitude) + " at " + number(peak.frequency_hz) +
              " Hz: " + words_for(found->output, model));
    page.line(contact_in_words(*peak.branch, 0));
}

// "6.1 .. 6.4 Hz, ..." where the motions are not stable.
std::string unstable_ranges(const Branch &branch) {
    std::string list;
    std::size_t n = 0;
    const std::vector<BranchPoint> &points = branch.points();
    for (std::size_t k = 0; k < points.size();) {
        if (stability_of(points[k]) != 0) {
            ++k;
            continue;
        }
        std::size_t last = k;
        while (last + 1 < points.size() && stability_of(points[last + 1]) == 0) ++last;
        const double a = hz_of(points[k]), b = hz_of(points[last]);
        if (++n <= named)
            list += (list.empty() ? "" : ", ") + number(std::min(a, b)) + " .. " + number(std::max(a, b));
        k = last + 1;
    }
    if (n > named) list += " and " + std::to_string(n - named) + " more ranges";
    return list.empty() ? list : list + " Hz";
}

void add_stability(Page &page, const Branch &branch, const CurveFindings *found) {
    page.section("Stability");
    const auto known = [](const BranchPoint &p) { return stability_of(p) >= 0; };
    if (found && found->peak.branch && !found->peak.branch->points().empty()) {
        const std::int64_t stable = stability_of(found->peak.branch->points().front());
        page.line(stable > 0    ? "the motion of the peak is stable"
                  : stable == 0 ? "the motion of the peak is not stable: the structure does not stay there"
                                : "of the motion of the peak it is not known");
    }
    const auto n = std::count_if(branch.points().begin(), branch.points().end(), known);
    const std::string unstable = unstable_ranges(branch);
    if (n == 0)
        page.line("not computed along the curve: the option stability of the solver does it");
    else if (unstable.empty())
        page.line("no motion of the curve is unstable");
    else
        page.line("unstable motions: " + unstable);
    if (const auto left = static_cast<std::int64_t>(branch.points().size()) - n; n > 0 && left > 0)
        page.line("not known at " + count(left, "point", "points"));
}

void add_others(Page &page, const Branch &branch, const CurveFindings *found) {
    page.section("Other motions at this force");
    if (const std::string folds = places_of(branch, bifurcation::fold); !folds.empty())
        page.line("the curve itself has several at one frequency, beside its folds at " + folds);
    if (found && found->larger) {
        const LargerMotion &larger = *found->larger;
        std::string where;
        if (std::isfinite(larger.force_low) && std::isfinite(larger.force_high))
            where = "; its curve exists from " + number(larger.force_low) + " to " +
                    number(larger.force_high) + " times the excitation";
        page.line("a larger stable one beside the curve: " + number(larger.amplitude) + " at " +
                  number(larger.frequency_hz) + " Hz" + where);
    } else if (found && found->looked_beside)
        page.line("along the curve of resonances over the force no larger stable one was found");
    else
        page.line("curves beside this one were not looked for: find_isolated and find_by_marching do");
}

void add_error(Page &page, const Branch &branch, const CurveFindings *found) {
    page.section("Error");
    if (found && std::isfinite(found->error)) {
        page.line("the peak may be off by " + number(found->error, 2) +
                  " of itself (amplitude or frequency, the larger)" +
                  (found->accuracy > 0 ? "; " + number(found->accuracy) + " was asked for" : ""));
        page.line("judged by steps of Newton's method from the peak towards the motion of the structure "
                  "without reduction: an estimate, not a bound");
    } else
        page.line("that of the peak is not known: estimate_error, or a larger basis to compare with, tells");
    double largest = -1;
    for (const BranchPoint &p : branch.points()) largest = std::max(largest, p.residual);
    if (largest >= 0) page.line("largest relative residual of the reduced equations: " + number(largest, 2));
}

void add_warnings(Page &page, const Branch &branch, const CurveFindings *found) {
    page.section("Warnings");
    Warnings all;
    if (found) all.add(found->warnings);
    // of one call the warnings are those that its estimate of the error leaves
    if (!found || found->accuracy == 0) all.add(branch.warnings);
    for (const Warning &w : all.list()) page.line("* " + w.text);
    if (all.empty()) page.line("none");
}

void add_times(Page &page, const Branch &branch, const CurveFindings *found) {
    page.section("Time");
    if (found && found->setup_seconds > 0) page.line(number(found->setup_seconds, 3) + " s for the basis");
    page.line(number(branch.seconds, 3) +
              " s for the curve: " + count(branch.newton_work.iterations, "iteration", "iterations") +
              " of Newton's method, " + count(branch.failed_steps, "step", "steps") + " repeated");
}

} // namespace

CurveFindings findings_at(const Peak &peak, const Output &output, const Basis &basis,
                          const Warnings &warnings) {
    CurveFindings found;
    found.output = output;
    found.peak = peak;
    found.basis_kind = basis.options().kind->name;
    found.setup_seconds = basis.report().setup_seconds;
    found.warnings = warnings;
    return found;
}

std::string report_of(const Branch &branch, const CurveFindings *found) {
    Page page;
    add_model(page, branch.reduced());
    add_basis(page, branch.reduced(), found);
    add_curve(page, branch);
    add_peak(page, *branch.reduced().model, found);
    add_stability(page, branch, found);
    add_others(page, branch, found);
    add_error(page, branch, found);
    add_warnings(page, branch, found);
    add_times(page, branch, found);
    return std::move(page).text();
}

} // namespace plm
