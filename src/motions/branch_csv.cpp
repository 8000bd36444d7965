#include "motions/branch_csv.hpp"
#include "linalg/work.hpp"
#include <cmath>
#include <locale>
#include <sstream>

namespace plm {

std::string csv_of(const Branch &branch, const Output &of) {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(17);
    text << "frequency_hz,amplitude,arclength,force_scale,stable,bifurcation,residual,iterations,n_harmonics,"
            "harmonic_error,n_switching\n";
    const double harmonics = static_cast<double>(branch.n_harmonics()); // extrema: a grid of 16 H instants
    for (std::size_t k = 0; k < branch.points().size(); ++k) {
        const BranchPoint &p = branch.points()[k];
        worked(200 * harmonics * harmonics);
        const double amplitude =
            branch.amplitude(static_cast<std::int64_t>(k), of.dof, of.measure, of.harmonic);
        text << p.omega / (2 * M_PI) << ',' << amplitude << ',' << p.arclength << ',' << p.force_scale << ','
             << stability_of(p) << ',' << p.bifurcation << ',' << p.residual << ',' << p.iterations << ','
             << p.n_harmonics << ',' << p.harmonic_error << ',' << p.n_switching << '\n';
    }
    return text.str();
}

std::string contact_in_words(const Branch &branch, std::int64_t point) {
    const vector<double> shares = branch.closed_share(point);
    double mean = 0;
    for (double share : shares) mean += share / static_cast<double>(shares.size());
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text.precision(3);
    text << branch.points()[static_cast<std::size_t>(point)].n_switching << " of " << shares.size()
         << (shares.size() == 1 ? " pair opens and closes; closed for "
                                : " pairs open and close; closed on average for ")
         << 100 * mean << " % of the period";
    return text.str();
}

} // namespace plm
