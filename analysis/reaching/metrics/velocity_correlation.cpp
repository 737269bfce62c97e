#include "analysis/reaching/metrics/velocity_correlation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

Eigen::Matrix3Xd centred(const VelocityProfile& profile) {
  Eigen::Matrix3Xd values(3, std::ssize(profile));
  for (std::size_t i = 0; i < profile.size(); ++i) {
    values.col(static_cast<Eigen::Index>(i)) = profile[i];
  }
  const Eigen::Vector3d mean = values.rowwise().mean();
  values.colwise() -= mean;
  return values;
}

}  // namespace

std::optional<VelocityProfile> velocity_profile(const Reach& reach, double onset,
                                                std::optional<double> end,
                                                const ProfileSpan& span) {
  check_reach(reach);
  if (!(span.duration > 0.0)) {
    throw std::invalid_argument("duration must be above 0");
  }
  if (span.samples < 2) {
    throw std::invalid_argument("samples must be at least 2");
  }
  VelocityProfile profile;
  for (std::size_t i = 0; i < span.samples; ++i) {
    const double instant =
        onset + span.duration * static_cast<double>(i) / static_cast<double>(span.samples - 1);
    if (const auto v = value_at(reach.time, reach.velocity, instant)) {
      profile.push_back(*v);
    } else if (end && instant > reach.time.back()) {
      profile.emplace_back(Eigen::Vector3d::Zero());
    } else {
      return std::nullopt;
    }
  }
  return profile;
}

VelocityProfile mean_profile(std::span<const VelocityProfile> profiles) {
  if (profiles.empty()) {
    throw std::invalid_argument("profiles: at least one has a mean");
  }
  VelocityProfile sum(profiles.front().size(), Eigen::Vector3d::Zero());
  for (const VelocityProfile& profile : profiles) {
    if (profile.size() != sum.size()) {
      throw std::invalid_argument("profiles must be equally long");
    }
    std::ranges::transform(profile, sum, sum.begin(),
                           [](const auto& a, const auto& b) -> Eigen::Vector3d { return a + b; });
  }
  for (Eigen::Vector3d& v : sum) {
    v /= static_cast<double>(profiles.size());
  }
  return sum;
}

Defined<double> velocity_correlation(const VelocityProfile& a, const VelocityProfile& b) {
  if (a.size() != b.size()) {
    throw std::invalid_argument("profiles must be equally long");
  }
  if (a.empty()) {
    return Undefined{"the profiles are empty"};
  }
  const Eigen::Matrix3Xd u = centred(a), v = centred(b);
  const double left = u.squaredNorm(), right = v.squaredNorm();
  if (!std::isfinite(left) || !std::isfinite(right)) {
    return Undefined{"a velocity is not finite"};
  }
  if (!(left > 0.0) || !(right > 0.0)) {
    return Undefined{"a velocity does not vary"};
  }
  return std::clamp(u.cwiseProduct(v).sum() / std::sqrt(left * right), -1.0, 1.0);
}

}  // namespace haptrial::analysis
