// The one place where the accuracy asked for is divided: what each cause of error may take of it. Causes are
// looked at one by one and errors rarely add up in full, so that the shares need not sum to one.
#pragma once
#include "linalg/error.hpp"
#include <algorithm>
#include <cmath>
#include <string>

namespace plm {

/// What was wrong with a curve of a force level.
struct ErrorAtForce {
    double force = 0, error = 0;
};

/// The same at the next level: it goes on as a power of the force, and a steep one is chance. 0: the two do
/// not tell.
inline double foretold(const ErrorAtForce &before, const ErrorAtForce &last, double next) {
    constexpr double steepest = 3;
    if (!(before.error > 0 && last.error > 0 && before.force != last.force && next > 0)) return 0;
    const double power = std::log(last.error / before.error) / std::log(last.force / before.force);
    return last.error * std::pow(next / last.force, std::max(-steepest, std::min(steepest, power)));
}

class ErrorBudget {
  public:
    constexpr explicit ErrorBudget(double accuracy) : accuracy_(accuracy) {}

    /// What the harmonics leave out: the basis takes its share, too.
    double harmonics() const { return 0.5 * accuracy_; }
    /// A host's own reduction (a superelement): with more no basis can mend it; the rest is the basis'.
    double host() const { return 0.5 * accuracy_; }
    /// A compressed model against its basis, at the highest motion: the basis takes its share, too; and where
    /// a curve takes minutes, not another one for less.
    double compressed(bool dear) const { return (dear ? 0.5 : 0.3) * accuracy_; }
    /// The same of a curve that has been followed: another one for less costs as much again.
    double compressed_before_another() const { return compressed(true); }
    /// The same as predicted: the motion at the highest point of the next curve is another one.
    double compressed_as_predicted(bool dear) const { return 0.5 * compressed(dear); }
    /// What the step to a model may have changed that is followed because the next one would save nothing:
    /// its own error is a part of that, and is measured where its curve is highest.
    double step_to_last_model() const { return 30 * accuracy_; }
    /// Newton's corrections of motions on a compressed model where a step takes a tenth of a second.
    double dear_motions() const { return 3e-2 * accuracy_; }
    /// What a peak that is a corner may be higher by: halving a step ten times gets there.
    double corner() const { return 1e-3 * accuracy_; }
    /// Newton's corrections of a first look: what a few harmonics leave out is much more.
    double look() const { return 1e-2 * accuracy_; }
    /// What the first basis of a refinement leaves out of the motions that it is made of: their amplitudes
    /// are nearer, but the motions of the next curve are other ones.
    double refined_basis() const { return 0.2 * accuracy_; }

    /// Of what the harmonics of a curve may leave out, at its peak: one point is cheap, and its amplitude is
    /// what people quote.
    static constexpr double peak_of_harmonics = 0.1;
    /// Of what a basis or a compressed model left out of the motions when that was too much: the next one.
    static constexpr double next_try = 0.3;

    /// An estimate beyond tells that an answer is poor, and no more how poor.
    static constexpr double trusted = 0.1;

    /// For the log. harmonics: what they may leave out, which can be set by hand.
    std::string text(double harmonics) const {
        return format(
            "accuracy %.2g: harmonics %.2g, at the peak %.2g; compressed model %.2g (where dear "
            "%.2g); refined basis, of the motions %.2g; reduction by the host %.2g; basis: the rest",
            accuracy_, harmonics, peak_of_harmonics * harmonics, compressed(false), compressed(true),
            refined_basis(), host());
    }

  private:
    double accuracy_;
};

} // namespace plm
