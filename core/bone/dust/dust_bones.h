#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "core/bone/dust/dust_surroundings.h"
#include "core/bone/model/occupancy.h"

namespace haptrial::bone {

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
