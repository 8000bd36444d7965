#include "study/report.hpp"
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace plm {
namespace {

class Text : public std::ostringstream {
  public:
    Text() { imbue(std::locale::classic()); }
};

// Empty where it is not known.
std::string number(double value, int digits) {
    if (std::isnan(value)) return "";
    Text t;
    t << std::setprecision(digits) << value;
    return t.str();
}

std::string exact(double value) {
    return number(value, 17);
}

std::string count(std::int64_t value) {
    return value < 0 ? "" : number(static_cast<double>(value), 15);
}

std::string error(double value) {
    if (std::isnan(value)) return "-";
    Text t;
    t << std::scientific << std::setprecision(1) << value;
    return t.str();
}

std::string dash(const std::string &text) {
    return text.empty() ? "-" : text;
}

// Inside a table of Markdown.
std::string cell(const std::string &text) {
    std::string out;
    for (char c : text) {
        if (c == '|') out += '\\';
        out += c == '\n' || c == '\r' ? ' ' : c;
    }
    return out;
}

// RFC 4180.
std::string quoted(const std::string &text) {
    std::string out = "\"";
    for (char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

void add_row(Text &t, const MethodResult &r) {
    const double time = r.setup_seconds + r.curve_seconds;
    t << "| " << cell(r.name) << " | " << (r.pareto ? "yes" : "") << " | " << dash(count(r.basis_size))
      << " | " << dash(number(r.setup_seconds, 3)) << " | " << dash(number(1e3 * r.iteration_seconds, 3))
      << " | " << dash(number(r.curve_seconds, 3)) << " | " << dash(number(time, 3)) << " | "
      << dash(number(r.peak_bytes < 0 ? not_known : static_cast<double>(r.peak_bytes) / 1e6, 3)) << " | "
      << error(r.frequency_error) << " | " << error(r.amplitude_error) << " | " << error(r.curve_error_l2)
      << " | " << error(r.curve_error_max) << " | " << error(r.estimated_error) << " | "
      << dash(number(r.effectivity, 2)) << " |\n";
}

void add_table(Text &t, const StudyResult &s) {
    t << "| method | Pareto | size | set-up (s) | iteration (ms) | curve (s) | both (s) | memory (MB) | "
         "frequency | peak | "
         "curve, L2 | curve, max | estimated | effectivity |\n"
      << "|---|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const MethodResult &r : s.methods) add_row(t, r);
    add_row(t, s.reference);
}

void add_reference(Text &t, const StudyResult &s) {
    const MethodResult &r = s.reference;
    t << "## The reference\n\n"
      << "* " << count(r.basis_size) << " coordinates; peak " << number(r.peak_amplitude, 9) << " at "
      << number(r.peak_hz, 10) << " Hz at force level " << number(s.levels[0], 6) << ".\n"
      << "* With twice the harmonics its peak"
      << (s.levels.size() > 1 ? ", at the lowest or the highest level," : "") << " changes by "
      << error(s.harmonic_error) << " in amplitude and " << error(s.harmonic_shift) << " in frequency.\n"
      << "* Its peak leaves a residual of " << error(s.full_residual)
      << " in the full equations; the contact receptances of its space are right to " << error(s.space_error)
      << ".\n"
      << "* All curves are known to " << error(s.curve_resolution)
      << " (the scale of the errors of curves).\n\n";
}

void add_methods(Text &t, const StudyResult &s) {
    t << "## The methods\n\n| method | options other than the defaults | outcome |\n|---|---|---|\n";
    for (const MethodResult &r : s.methods)
        t << "| " << cell(r.name) << " | " << dash(cell(r.options_text)) << " | " << cell(r.outcome)
          << " |\n";
    t << "| " << s.reference.name << " | " << dash(cell(s.reference.options_text)) << " | "
      << cell(s.reference.outcome) << " |\n";
}

double most_space_seconds(const StudyResult &s) {
    double most = std::isnan(s.reference.space_seconds) ? 0 : s.reference.space_seconds;
    for (const MethodResult &r : s.methods) most = r.space_seconds > most ? r.space_seconds : most;
    return most;
}

void add_legend(Text &t, const StudyResult &s) {
    t << "\n"
         "Errors are relative to the reference, the worst of all force levels. Those of curves are distances "
         "in the plane of frequency over the width of the range and amplitude over the reference's peak, at "
         "points equally spaced in arc length of the reference's curve (for methods that march in time: of "
         "their own points). Times are medians and the sum over the force levels; set-up is everything "
         "before the method's own curve. Memory is the most held at once by the library's arrays and by "
         "CHOLMOD, the model itself not counted. Pareto: no other method is both faster and nearer (curve, "
         "L2).\n";
    if (s.shared_space)
        t << "The contact space was made once, in " << number(most_space_seconds(s), 3)
          << " s; its time is part of the set-up of every method that uses it, and its arrays of the "
             "memory.\n";
}

} // namespace

std::string report_markdown(const StudyResult &s) {
    Text t;
    t << "# Error against run time\n\nFrom " << number(s.range.low_hz, 8) << " to "
      << number(s.range.high_hz, 8) << " Hz; force level" << (s.levels.size() == 1 ? " " : "s ");
    for (std::size_t i = 0; i < s.levels.size(); ++i) t << (i > 0 ? ", " : "") << number(s.levels[i], 6);
    t << "." << (s.cancelled ? " Cancelled before all methods were run." : "") << "\n\n";
    add_table(t, s);
    add_legend(t, s);
    t << "\n";
    add_reference(t, s);
    add_methods(t, s);
    return t.str();
}

std::string table_csv(const StudyResult &s) {
    Text t;
    t << "name,pareto,basis_size,setup_seconds,space_seconds,iteration_seconds,curve_seconds,peak_bytes,"
         "peak_hz,peak_amplitude,frequency_error,amplitude_error,curve_error_l2,curve_error_max,"
         "estimated_error,effectivity,n_points,newton_iterations,failed_steps,outcome,options\n";
    const auto line = [&](const MethodResult &r) {
        t << quoted(r.name) << ',' << (r.pareto ? 1 : 0) << ',' << count(r.basis_size);
        for (double v : {r.setup_seconds, r.space_seconds, r.iteration_seconds, r.curve_seconds})
            t << ',' << exact(v);
        t << ',' << count(r.peak_bytes);
        for (double v : {r.peak_hz, r.peak_amplitude, r.frequency_error, r.amplitude_error, r.curve_error_l2,
                         r.curve_error_max, r.estimated_error, r.effectivity})
            t << ',' << exact(v);
        for (std::int64_t v : {r.n_points, r.newton_iterations, r.failed_steps}) t << ',' << count(v);
        t << ',' << quoted(r.outcome) << ',' << quoted(r.options_text) << '\n';
    };
    line(s.reference);
    for (const MethodResult &r : s.methods) line(r);
    return t.str();
}

std::string curve_csv(const PlaneSamples &s) {
    Text t;
    t << "frequency_hz,amplitude\n";
    for (std::size_t i = 0; i < s.hz.size(); ++i) t << exact(s.hz[i]) << ',' << exact(s.amplitude[i]) << '\n';
    return t.str();
}

} // namespace plm
