#pragma once

#include <Eigen/Geometry>
#include <array>
#include <span>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/bone/model/occupancy.h"

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

/// The dust's own replica of each bone, and the bone's pose.
class DustBones {
 public:
  struct Change {
    bool everything{false};                // bones came, went or moved
    std::vector<Eigen::Vector3d> centres;  // in W of voxels that were filled or emptied [m]
    double spacing{0.0};                   // of the coarsest voxels among them [m]
  };

  /// Catches up with the bones. The change is valid until the next call.
  const Change& follow(std::span<const DustBone> bones);

  /// Whether the straight line between two points of W passes through bone.
  bool cross(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;
  bool hold(const Eigen::Vector3d& point) const { return cross(point, point); }
  /// Whether dust may go from one to the other: a point on the face of a voxel may lie in bone that
  /// no line to it crosses, and dust that went there would come back out for ever.
  bool open(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return !cross(from, to) && !hold(to);
  }

 private:
  struct Replica {
    const BoneVolume* volume;
    Eigen::Isometry3d X_WB;
    Eigen::Isometry3d X_BW;
    Occupancy occupancy;
    bool listed;
  };
  void follow(const DustBone& bone);

  std::vector<Replica> replicas_;
  std::vector<Voxel> voxels_;
  Change change_;
};

}  // namespace haptrial::bone
