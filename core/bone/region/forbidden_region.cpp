#include "core/bone/region/forbidden_region.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/bone/data/anatomy.h"

namespace haptrial::bone {
namespace {

// The power of the norm of the balls' depths is so high that the deepest ball has nearly all of the
// force.
constexpr double kPower = 32.0;

}  // namespace

RegionMap::RegionMap(const RegionSetup& setup, const BoneModel& model, double largest) {
  for (const std::string& structure : setup.structures) {
    const std::uint8_t label = label_named(model, structure, "forbidden");
    if (std::count(labels_.begin(), labels_.end(), label) == 0) {
      labels_.push_back(label);
      depths_.emplace_back(model, label, largest + setup.margin);
    }
  }
}

ForbiddenRegion::ForbiddenRegion(const RegionSetup& setup, std::shared_ptr<const RegionMap> map)
    : margin_(setup.margin),
      spring_(setup.spring()),
      most_(setup.most_force()),
      map_(std::move(map)),
      depths_(map_->size(), 0.0),
      felt_(map_->size(), false) {}

void ForbiddenRegion::forget() noexcept {
  std::fill(depths_.begin(), depths_.end(), 0.0);
  std::fill(felt_.begin(), felt_.end(), false);
}

ForbiddenRegion::Depth ForbiddenRegion::depth(std::size_t structure,
                                              std::span<const BurrShape::Ball> balls,
                                              const Eigen::Vector3d& tip_B,
                                              const Eigen::Vector3d& axis_B) const noexcept {
  const auto depth_of = [&](const BurrShape::Ball& ball, SurfaceDepth::LocalTissue& here) {
    const bool known = map_->depth(structure).at(tip_B + ball.z * axis_B, here);
    return known ? std::max(0.0, ball.radius + margin_ - here.distance) : 0.0;
  };
  Depth found;
  SurfaceDepth::LocalTissue here{};
  for (const BurrShape::Ball& ball : balls) {
    found.deepest = std::max(found.deepest, depth_of(ball, here));
  }
  if (found.deepest <= 0.0) {
    return found;
  }
  double sum = 0.0;
  for (const BurrShape::Ball& ball : balls) {
    const double share = depth_of(ball, here) / found.deepest;
    const double weight = std::pow(share, kPower - 1.0);
    sum += weight * share;
    found.way_out += weight * here.gradient;
  }
  const double ratio = std::pow(sum, 1.0 / kPower);
  found.joint = ratio * found.deepest;
  found.way_out *= ratio / sum;
  return found;
}

Eigen::Vector3d ForbiddenRegion::tick(std::span<const BurrShape::Ball> balls,
                                      const Eigen::Vector3d& tip_B,
                                      const Eigen::Vector3d& axis_B) noexcept {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < depths_.size(); ++n) {
    const Depth found = depth(n, balls, tip_B, axis_B);
    depths_[n] = found.deepest;
    felt_[n] = felt_[n] || found.deepest <= 0.0;
    if (felt_[n]) {
      force += std::min(spring_ * found.joint, most_) * found.way_out;
    }
  }
  return force;
}

double ForbiddenRegion::energy(std::span<const BurrShape::Ball> balls, const Eigen::Vector3d& tip_B,
                               const Eigen::Vector3d& axis_B) const noexcept {
  double sum = 0.0;
  const double bend = spring_ > 0.0 ? most_ / spring_ : 0.0;  // where the force grows no more [m]
  for (std::size_t n = 0; n < depths_.size(); ++n) {
    const double joint = depth(n, balls, tip_B, axis_B).joint;
    const double bent = std::min(joint, bend);
    sum += 0.5 * spring_ * bent * bent + most_ * (joint - bent);
  }
  return sum;
}

}  // namespace haptrial::bone
