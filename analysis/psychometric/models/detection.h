#pragma once

#include <cstdint>

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Answers to signal and to noise; real numbers, so that corrected counts fit.
struct DetectionCounts {
  double hits{0.0};
  double misses{0.0};
  double false_alarms{0.0};
  double correct_rejections{0.0};
};

/// Correction of rates of 0 and 1, whose normal quantile does not exist.
enum class RateCorrection {
  kNone,       // the index is undefined then
  kLogLinear,  // (count + 1/2) / (trials + 1), always (Hautus 1995)
  kExtremes,   // 0 becomes 1 / (2 n), 1 becomes 1 - 1 / (2 n) (Macmillan and Kaplan 1985)
};

/// Equal-variance indices of yes/no detection, z the normal quantile, H and F the rates:
///
///     d' = z(H) - z(F),   c = -(z(H) + z(F)) / 2,   ln beta = c d'
struct Detection {
  double hit_rate{0.0}, false_alarm_rate{0.0};  // corrected
  double d_prime{0.0};
  double criterion{0.0};  // c: above 0 for fewer "yes"
  double log_beta{0.0};
  double error{0.0};           // standard error of d' (Gourevitch and Galanter 1967)
  double low{0.0}, high{0.0};  // normal interval of d'
};

/// Undefined without signal or noise trials, and where a rate of 0 or 1 is not corrected.
/// @param level  coverage of the interval, inside (0, 1).
/// @throws std::invalid_argument for a count that is negative or not finite, and for `level`.
/// Source: Macmillan and Creelman 2005, Detection Theory, chapters 1, 2 and 13.
Defined<Detection> detection(const DetectionCounts& counts, RateCorrection correction,
                             double level = 0.95);

/// d' of an observer without bias who is right in `share` of the trials with m alternatives:
///
///     share = integral of phi(x - d') Phi(x)^(m - 1) dx      (m = 2: d' = sqrt 2 z(share))
///
/// Undefined unless 0 < share < 1. @throws std::invalid_argument unless 2 <= alternatives <= 1000.
/// Source: Hacker and Ratcliff 1979, Perception & Psychophysics 26.
Defined<double> forced_choice_d_prime(double share, int alternatives);
/// The share itself.
double forced_choice_share(double d_prime, int alternatives);

/// The question about the stimuli of a trial. The d' of each task is that of an observer without
/// bias.
enum class DiscriminationTask : std::uint8_t {
  kForcedChoice,   // which of m stimuli it was: forced_choice_share()
  kOneInterval,    // which of two stimuli was presented alone: d' is the distance between them
  kOddity,         // which of three differs from the two others, by their differences
  kAbx,            // whether the third is as the first or as the second, by their differences
  kSameDifferent,  // whether two are the same, from independent observations
};

/// Share of right answers.
/// @param d_prime       at least 0 except in a forced choice and one interval
/// @param alternatives  of a forced choice, 2 to 1000
/// Source: Macmillan and Creelman 2005, Detection Theory, chapters 7, 9 and 10.
double task_share(DiscriminationTask task, double d_prime, int alternatives);
/// The d' with a share of right answers; 0 for a share below chance, except in a forced choice and
/// one interval.
/// Undefined unless 0 < share < 1.
Defined<double> task_d_prime(DiscriminationTask task, double share, int alternatives);

}  // namespace haptrial::analysis
