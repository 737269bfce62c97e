#pragma once

#include <vector>

#include "core/base/definition/schema_forward.h"

namespace haptrial {
class RandomStream;
}

namespace haptrial::stimulus {

/// How the force patterns of a study are drawn. Source: Morris 2006, §4.2.3.
struct ForcePatternParameters {
  int sinusoids{4};            // number summed >= 1
  double max_frequency{0.2};   // of each sinusoid >= 0.001 [Hz]
  double base_max{10.0};       // the sum is scaled into [0, base_max] > 0 [N]
  int bumps_min{2};            // parabolic bumps per pattern, fewest and
  int bumps_max{4};            // most
  double bump_max{12.0};       // highest peak that a bump may reach >= base_max [N]
  double bump_width_min{0.6};  // foot to foot > 0 [s]
  double bump_width_max{1.4};  // [s]
  double ramp{1.0};            // linear ramp at either end >= 0 [s]
};

/// The keys of [force_pattern].
const Schema<ForcePatternParameters>& force_pattern_schema();

/// The magnitude of the normal force to be learnt, as a function of time:
///
///     base(t) = scaled sum over i of sin(2 pi f_i t + phi_i) + c_i,  in [0, base_max]
///     F(t)    = ramp(t) · blend(base(t); bumps)
///     blend:    base + w (P - base),  w = max(0, 1 - (2 (t - t_c) / width)^2)  for each bump
///
/// A bump's peak P lies between the base there and bump_max, so F never leaves [0, bump_max].
/// Stored at a fixed step, linear in between. Source: Morris 2006, §4.2.3, Figure 23.
class ForcePattern {
 public:
  /// A random pattern of `duration` > 0 [s]; draws from `random` only.
  ForcePattern(const ForcePatternParameters& parameters, double duration, RandomStream& random);
  /// A pattern through `forces` ((N) [N], N >= 2) at equal steps over `duration`.
  /// @throws std::invalid_argument when there are fewer than two forces.
  ForcePattern(std::vector<double> forces, double duration);

  double duration() const noexcept { return duration_; }  // [s]
  /// Target force [N] `time` seconds after the start; the end values hold outside. Servo thread.
  double at(double time) const noexcept;
  double peak() const noexcept;  // [N]

 private:
  std::vector<double> forces_;
  double duration_;
};

}  // namespace haptrial::stimulus
