#include "core/bone/region/forbidden_region.h"

#include <algorithm>
#include <utility>

#include "core/bone/data/anatomy.h"

namespace haptrial::bone {

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

ForbiddenRegion::Deepest ForbiddenRegion::deepest(std::size_t structure,
                                                  std::span<const BurrShape::Ball> balls,
                                                  const Eigen::Vector3d& tip_B,
                                                  const Eigen::Vector3d& axis_B) const noexcept {
  Deepest found;
  for (const BurrShape::Ball& ball : balls) {
    SurfaceDepth::LocalTissue here{};
    if (map_->depth(structure).at(tip_B + ball.z * axis_B, here) &&
        ball.radius + margin_ - here.distance > found.depth) {
      found = {ball.radius + margin_ - here.distance, here.gradient};
    }
  }
  return found;
}

Eigen::Vector3d ForbiddenRegion::tick(std::span<const BurrShape::Ball> balls,
                                      const Eigen::Vector3d& tip_B,
                                      const Eigen::Vector3d& axis_B) noexcept {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (std::size_t n = 0; n < depths_.size(); ++n) {
    const Deepest found = deepest(n, balls, tip_B, axis_B);
    depths_[n] = found.depth;
    felt_[n] = felt_[n] || found.depth <= 0.0;
    if (felt_[n]) {
      force += std::min(spring_ * found.depth, most_) * found.gradient;
    }
  }
  return force;
}

double ForbiddenRegion::energy(std::span<const BurrShape::Ball> balls, const Eigen::Vector3d& tip_B,
                               const Eigen::Vector3d& axis_B) const noexcept {
  double sum = 0.0;
  const double bend = spring_ > 0.0 ? most_ / spring_ : 0.0;  // where the force grows no more [m]
  for (std::size_t n = 0; n < depths_.size(); ++n) {
    const double depth = deepest(n, balls, tip_B, axis_B).depth;
    const double bent = std::min(depth, bend);
    sum += 0.5 * spring_ * bent * bent + most_ * (depth - bent);
  }
  return sum;
}

}  // namespace haptrial::bone
