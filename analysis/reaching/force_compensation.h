#pragma once

#include <Eigen/Core>
#include <span>

#include "analysis/reaching/reach.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// How much of a field the hand compensates while a channel holds it on its way (an error clamp).
///
///     measured = intercept + slope ideal + noise
///
/// The slope is the adaptation index: 0 before learning, 1 where the hand presses against the wall
/// as the field would have needed. Neighbouring samples are alike, so the standard error is that of
/// Newey and West 1987 (Econometrica 55, 703), whose weights fall to 0 over `memory`, after
/// prewhitening by Andrews and Monahan 1992 (Econometrica 60, 953).
/// Source: Scheidt et al. 2000, Journal of Neurophysiology 84, 853; Smith et al. 2006, PLoS Biology
/// 4, e179; Joiner and Smith 2008, Journal of Neurophysiology 100, 2948.
struct ForceCompensation {
  double slope{0.0};
  double intercept{0.0};  // [N]
  double slope_error{0.0};
  double r_squared{0.0};
  std::size_t samples{0};
};

struct CompensationOptions {
  Eigen::Vector3d normal{0.0, 1.0, 0.0};  // of the plane of the movement
  double memory{0.05};                    // of the standard errors, >= 0 [s]
};

/// @param measured  (n) lateral force of the wall on the hand [N].
/// @param ideal     (n) lateral force of the field on a hand with the same velocity [N].
/// @param lags      samples over which the noise is correlated; 0: White's standard error.
/// Undefined with fewer than four samples, one that is not finite, or a force that does not vary.
/// @throws std::invalid_argument when the lengths differ.
Defined<ForceCompensation> force_compensation(std::span<const double> measured,
                                              std::span<const double> ideal, std::size_t lags);

/// Compensation from a trial in a channel, between two instants (onset and end of the movement).
/// The wall stands in for the field: the force of the wall on the hand equals that of the field
/// where the hand compensates fully. Only the part of the velocity along the way counts.
/// @param reach  its `force` is that of the device on the hand.
/// @param field  B of the field f = B v that is being learned, in W [N·s/m].
/// @throws std::invalid_argument as check_reach and WayFrame, or when there is no force.
Defined<ForceCompensation> force_compensation(const Reach& reach, const Eigen::Matrix3d& field,
                                              double from, double to,
                                              const CompensationOptions& options = {});

}  // namespace haptrial::analysis
