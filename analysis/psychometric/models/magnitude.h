#pragma once

#include <limits>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// One magnitude estimate.
struct MagnitudeTrial {
  std::size_t participant{0};  // any numbers
  double level{0.0};           // > 0 [unit of the stimulus]
  double estimate{0.0};        // > 0, in the participant's own modulus
  /// The stimulus as it was measured in this trial, > 0 [its unit]; NaN: it was the level.
  double measured{std::numeric_limits<double>::quiet_NaN()};
};

/// Geometric mean of all participants at a level, after modulus equalisation.
struct MagnitudeLevel {
  double level{0.0};
  double measured{0.0};        // geometric mean of what it measured; the level if it was not
  double mean{0.0};            // in units of the common modulus
  double low{0.0}, high{0.0};  // interval over participants; equal to the mean for one
  std::size_t participants{0};
};

/// A participant's line through the logarithms of the levels' means.
struct PersonalLine {
  double exponent{0.0};
  double low{0.0}, high{0.0};  // Student's interval of the exponent; infinite for two levels
  double r_squared{0.0};
  double deviation{0.0};  // standard deviation of the residuals, natural logarithm
};

/// Stevens' power law, estimate = constant level^exponent.
struct PowerLaw {
  double exponent{0.0};                   // mean of the participants' exponents
  double error{0.0};                      // of that mean, over participants
  Defined<double> low{Undefined{""}};     // Student's interval over participants
  Defined<double> high{Undefined{""}};    // undefined for one participant
  double constant{0.0};                   // of the common modulus
  double r_squared{0.0};                  // of the logarithms of the levels' means
  std::vector<std::size_t> participants;  // (n) rising
  std::vector<double> exponents;          // (n) each participant's slope of log on log
  std::vector<double> moduli;             // (n) what the participant's estimates are divided by
  std::vector<PersonalLine> lines;        // (n) how well each exponent is known
  std::vector<MagnitudeLevel> levels;     // rising
};

/// Repeated estimates of a participant at a level become their geometric mean. A participant's
/// modulus is the factor of their means over those of all participants at the same levels, from the
/// least-squares fit of log estimate = participant + level: with a complete design the ratio of
/// geometric means (Lane, Catania and Stevens 1961).
///
/// A slope is that of least squares. If the stimuli were measured, it is the most likely one with
/// errors on both axes (errors_in_variables.h), which scatter as the logarithms of a participant's
/// repeated trials do around the means of their levels: otherwise it would come out too small.
/// Undefined when a participant has fewer than two levels, some trials alone were measured, a
/// participant's measured trials do not tell their scatter, a value is not above 0 or not finite,
/// or participants have no levels in common, directly or through others.
/// @param level  coverage of the intervals, inside (0, 1). @throws std::invalid_argument naming it.
Defined<PowerLaw> power_law(std::span<const MagnitudeTrial> trials, double level = 0.95);

}  // namespace haptrial::analysis
