#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/render/gl/image.h"
#include "core/subject/drilling/cavity_plan.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

/// A section through a bone while it is drilled, in colour by the plan of its cavity: planned and
/// removed in green, planned and left in blue, removed beyond the plan in orange, removed from a
/// vital structure in red, structures in their own colours. The way out of the cavity points up.
/// One thread; reads a volume that the servo thread drills.
class PlanSection {
 public:
  /// @param definition  with [cavity]
  PlanSection(const BoneDefinition& definition, std::shared_ptr<const bone::BoneModel> model);

  /// The layer of voxels at the tip, one pixel a voxel; null while the plan is being made, which
  /// takes a second at first. @param tip_W  [m]
  std::shared_ptr<const std::vector<render::Image>> at(const bone::BoneVolume& volume,
                                                       const Eigen::Vector3d& tip_W);

 private:
  std::array<std::uint8_t, 3> colour_of(std::size_t index, bool stands) const;

  std::shared_ptr<const bone::BoneModel> model_;
  Eigen::Isometry3d X_BW_;
  int up_{2}, across_{0}, through_{1};  // axes of the grid
  bool upwards_{true}, rightwards_{true};
  std::future<subject::CavityPlan> made_;
  std::optional<subject::CavityPlan> plan_;
};

}  // namespace haptrial::protocols
