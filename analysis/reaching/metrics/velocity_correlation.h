#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "analysis/reaching/metrics/reach.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// Velocities at instants after the onset, so that reaches can be averaged and compared.
using VelocityProfile = std::vector<Eigen::Vector3d>;  // (n) [m/s]

struct ProfileSpan {
  double duration{0.6};      // from the onset, > 0 [s]
  std::size_t samples{301};  // >= 2, both ends included
};

/// Linear between samples. After its last sample a reach counts as at rest when it had ended by
/// then. Nothing when the recording stops earlier (`end` is none).
/// @param onset, end  of the movement, as Reach::time [s].
/// @throws std::invalid_argument as check_reach, and naming what of `span` breaks its bound.
std::optional<VelocityProfile> velocity_profile(const Reach& reach, double onset,
                                                std::optional<double> end,
                                                const ProfileSpan& span = {});

/// Sample by sample; @throws std::invalid_argument when there is none or the lengths differ.
VelocityProfile mean_profile(std::span<const VelocityProfile> profiles);

/// Likeness of two velocity profiles: 1 for the same shape, whatever the speed.
///
///     ρ = Cov(a, b) / sqrt(Cov(a, a) Cov(b, b)),  Cov(a, b) = mean of (a - mean a) · (b - mean b)
///
/// The baseline is the mean profile to the same target before the field.
/// Undefined with a profile that does not vary or is not finite.
/// @throws std::invalid_argument when the lengths differ.
/// Source: Shadmehr and Mussa-Ivaldi 1994, Journal of Neuroscience 14, 3208.
Defined<double> velocity_correlation(const VelocityProfile& a, const VelocityProfile& b);

}  // namespace haptrial::analysis
