#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace haptrial::evaluation {

/// How far rendered forces are from measured ones.
struct ForceError {
  double mean_norm{0.0};         // (1/n) Σ |F - R|: what the source's eq. 3 computes [N]
  double root_mean_square{0.0};  // √((1/n) Σ |F - R|²): what its tables' heading says [N]
  double worst{0.0};             // [N]
  double mean_force{0.0};        // (1/n) Σ |F| [N]
};

/// @param measured, rendered  (n >= 1) at the same times, in the same frame [N]
/// @throws std::invalid_argument for lengths that differ, no sample or one that is not finite.
/// Source: Morris 2006, §7.3.3, eq. 3, with the names of the errata.
ForceError force_error(std::span<const Eigen::Vector3d> measured,
                       std::span<const Eigen::Vector3d> rendered);

/// The root mean square of the force error by frequency. The squares of the bands add up to that of
/// the whole (Parseval).
struct BandError {
  double slow{0.0};    // below 10 Hz, with the mean [N]
  double middle{0.0};  // 10 Hz to below 100 Hz [N]
  double fast{0.0};    // 100 Hz and above [N]; 0 if the rate is below 200 Hz
  double total{0.0};   // [N]
};

/// Error in a band by the discrete Fourier transform of the whole error; no window.
/// @param rate  of the samples > 0 [Hz]
/// @throws std::invalid_argument as force_error() or for a bad rate.
BandError band_error(std::span<const Eigen::Vector3d> measured,
                     std::span<const Eigen::Vector3d> rendered, double rate);

/// A stretch of samples whose position error is beyond a threshold.
struct ProblemPlace {
  std::size_t first{0}, last{0};  // samples, both inclusive
  double worst{0.0};              // [m]
};

struct PositionError {
  double mean_norm{0.0};         // [m]
  double root_mean_square{0.0};  // [m]
  double worst{0.0};             // [m]
  double beyond_share{0.0};      // of the samples beyond the threshold
  std::vector<ProblemPlace> places;
};

/// @param recorded, rendered  (n >= 1) contact points at the same times [m]
/// @param threshold  >= 0 [m]
PositionError position_error(std::span<const Eigen::Vector3d> recorded,
                             std::span<const Eigen::Vector3d> rendered, double threshold);

/// The force error beside what a hand can tell. The just noticeable difference of a force between
/// thumb and forefinger is 7 % of it from 2.5 to 10 N (Pang, Tan and Durlach 1991, Perception &
/// Psychophysics 49, 531), 7 % as well for the forces of an arm (Jones 1989, Perception 18, 681);
/// 10 % is the upper end of the 5 to 10 % that studies report. All are for magnitudes that are
/// compared one after the other, not for directions or changes while the hand moves, so that the
/// verdict is a yardstick and not a prediction. The source has no such figure.
struct NoticeableError {
  double median{0.0};       // of |F - R| / (0.07 |F|) over the samples of contact
  double beyond_low{0.0};   // share of the samples with |F - R| > 0.07 |F|
  double beyond_high{0.0};  // share with |F - R| > 0.10 |F|
  double outside{0.0};      // share with |F| outside of the 2.5 to 10 N that were measured
  std::size_t samples{0};   // with |F| above `least_force`
  std::string verdict;      // a sentence
};

/// @param least_force  samples whose measured force is not above it say nothing [N], >= 0
NoticeableError noticeable_error(std::span<const Eigen::Vector3d> measured,
                                 std::span<const Eigen::Vector3d> rendered,
                                 double least_force = 0.5);

/// The time that ticks took.
struct TickTimes {
  double median{0.0};
  double p999{0.0};  // 99.9 % of the ticks took no longer
  double worst{0.0};
};

/// Times by rank: the smallest time that at least that share of the ticks did not exceed.
/// @param times  (n >= 1) in any unit; the result has the same
TickTimes tick_times(std::span<const double> times);

}  // namespace haptrial::evaluation
