#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Bone that dust cannot pass: a volume, kept alive by the caller, and the pose of its frame B.
struct DustBone {
  const BoneVolume* volume{nullptr};
  Eigen::Isometry3d X_WB{Eigen::Isometry3d::Identity()};
};

/// Bone that a burr has turned into dust, at the place of the burr.
struct DustDeposit {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // of the burr in W [m]
  double radius{0.0};                               // of the burr: dust appears around it >= 0 [m]
  double amount{0.0};                               // in solid voxels >= 0
};

/// A tool that dust gives way to: a sphere swept along a segment. Burr, handle, suction tube.
struct DustTool {
  Eigen::Vector3d tip{Eigen::Vector3d::Zero()};    // centre of the first sphere in W [m]
  Eigen::Vector3d axis{Eigen::Vector3d::UnitY()};  // from the tip to the hand, unit length
  double length{0.0};                              // of the segment >= 0 [m]
  double radius{0.0};                              // 0: no tool [m]
  bool sucks{false};                               // dust near the tip is taken away
  bool rinses{false};                              // water near it carries dust off
};
/// Water that runs: dust within it is a slurry, which flows where dry dust would stand.
struct DustWater {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // in W [m]
  double radius{0.0};                               // 0: none runs [m]
};
struct DustTools {
  static constexpr int kMost = 4;
  std::array<DustTool, kMost> tools{};  // those of radius 0 are not there
  DustWater water;
};

}  // namespace haptrial::bone
