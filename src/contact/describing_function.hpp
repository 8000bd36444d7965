// The contact law under u(t) = mean + amplitude cos t: Fourier coefficients of the force in closed form, the
// dual-input describing function (Gelb and Vander Velde 1968, Multiple-Input Describing Functions, ch. 6).
#pragma once
#include "contact/contact_law.hpp"
#include <cstdint>

namespace plm {

/// Half of the phase over which the pair is closed, in [0, pi]; the amplitude's sign does not matter.
/// Amplitude 0: 0 (open) or pi.
double closed_half_angle(double mean, double amplitude);

/// Mean of the force (h = 0) or its coefficient of cos(h t); no sines arise. A negative amplitude is a motion
/// half a period later.
double force_coefficient(double stiffness, double mean, double amplitude, std::int64_t h);

/// Derivative of the mean force with respect to the mean penetration, in [0, stiffness].
double mean_tangent(double stiffness, double mean, double amplitude);

/// Equivalent linear stiffness: first harmonic of the force over the amplitude, in [0, stiffness]; amplitude
/// 0: the tangent of the law.
double equivalent_stiffness(double stiffness, double mean, double amplitude);

} // namespace plm
