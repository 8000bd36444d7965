// The frequency range where the dominant mode governs the response (paper, 2.3.2).
#pragma once
#include "contact/contact_sweep.hpp"
#include "sampling/dominant_mode.hpp"
#include "space/rest.hpp"
#include <string>

namespace plm {

struct MacRow {                  // one compared linear system
    std::string system;          // "system 1", "system 2", "rest"
    vector<double> frequency_hz; // its lowest modes
    vector<double> mac;          // mass-weighted MAC with the dominant mode
    std::int64_t best = 0;
    double rival_hz = 0; // of another of its modes that resembles the dominant one as well; 0: none
};

struct FrequencyWindow {
    double blf_hz = 0;             // paper, eq. (6)
    double f1_hz = 0, f2_hz = 0;   // of the two half-cycle systems
    double rest_hz = 0;            // of the system closed as at rest (case B), 0 in case A
    bool preload_case = false;     // case B of the paper
    double min_hz = 0, max_hz = 0; // of the excitation: those of the mode over the harmonic that drives it
    std::vector<MacRow> mac;
    std::string why; // one sentence
};

/// Bilinear frequency of two half periods (paper, eq. (6); Shaw and Holmes 1983).
double bilinear_frequency(double f1_hz, double f2_hz);

/// Case A (no pre-load): around the BLF. Case B: around the BLF and the frequency of the system closed as at
/// rest, which by itself can be several per cent off. The half-cycle systems are the two ends of the sweep:
/// pairs with dV > 0 closed, and pairs with dV < 0 closed. Over the harmonic of the excitation
/// that drives the mode. A window in the options takes precedence.
FrequencyWindow find_window(const Space &space, const DominantMode &dominant, const ContactSweep &sweep,
                            const RestState &rest, const SamplerOptions &options, Watch watch);

} // namespace plm
