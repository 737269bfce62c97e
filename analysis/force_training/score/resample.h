#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "analysis/force_training/score/trial_score.h"

namespace haptrial::analysis {

/// `samples` instants from 0 to `duration`, both ends included.
struct TimeBase {
  double duration{0.0};    // > 0 [s]
  std::size_t samples{0};  // >= 2

  double step() const { return duration / static_cast<double>(samples - 1); }  // [s]
};

/// Anybody's curve: values at a rate or at times of their own. Views only: the caller owns them.
struct SampledCurve {
  std::span<const double> values;   // (samples) [N]
  std::span<const double> times{};  // (samples), increasing; empty: at `rate` [s]
  double rate{0.0};                 // where times is empty [Hz]
};

SampledCurve view(const ForceCurve& curve);

/// Duration from the first sample of a curve to its last [s].
/// @throws InputError for a curve of fewer than two samples, a rate that is not above 0, times that
///   are not as many or do not increase, or a value that is not finite; `name` says which curve.
double duration_of(const SampledCurve& curve, const char* name);
double duration_of(const ForceCurve& curve, const char* name);

/// The curve at the instants of `base`, straight lines between its samples; the base starts with
/// its first sample. Where the base ends with the curve, the first and the last sample come back as
/// they are; beyond its end a curve holds its last force.
/// @returns (base.samples) [N].  @throws std::invalid_argument for a base out of bounds.
/// Precondition: duration_of(curve) does not throw.
std::vector<double> resample(const SampledCurve& curve, const TimeBase& base);
std::vector<double> resample(const ForceCurve& curve, const TimeBase& base);

/// Low-pass filter: the mean of the curve, taken as straight lines between its samples, over a
/// window of `width` seconds centred on each instant. Near an end the window shrinks on both sides
/// alike and so stays centred: a straight line passes unchanged, and the end points stay as they
/// are.
/// @param width  >= 0; 0 leaves the curve unchanged [s].
/// @returns (base.samples) [N].  @throws std::invalid_argument.
std::vector<double> box_filter(std::span<const double> force, const TimeBase& base, double width);

/// df/dt by central differences, one-sided at both ends.
/// @returns (base.samples) [N/s].  @throws std::invalid_argument.
std::vector<double> slope(std::span<const double> force, const TimeBase& base);

}  // namespace haptrial::analysis
