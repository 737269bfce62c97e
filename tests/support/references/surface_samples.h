#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// Contact of a burr that is sampled on its surface with a bone.
struct SurfaceContact {
  std::int32_t samples{0};                        // that lie in bone
  Eigen::Vector3d push{Eigen::Vector3d::Zero()};  // sum of depth times direction to the centre [m]
};

/// The method that Drill replaces, for comparison: points on a burr's surface, each of which walks
/// from where it lies in bone towards the burr's centre until it comes out of the bone. The way is
/// its depth; bone is removed along it. Source: Petersik et al. 2002 as Morris 2006, §3.2.3.4,
/// tells it (Figure 5a). Servo thread: no allocation, lock or throw after construction.
class SurfaceSamples {
 public:
  /// Samples evenly spread over the sphere (a Fibonacci lattice).
  /// @throws std::invalid_argument unless radius > 0 and samples >= 1.
  SurfaceSamples(double radius, std::int32_t samples);

  std::int32_t samples() const noexcept { return static_cast<std::int32_t>(directions_.size()); }
  double radius() const noexcept { return radius_; }

  /// @param tip_B, orientation_B  as for Drill::touch()
  SurfaceContact touch(const BoneVolume& volume, const Eigen::Vector3d& tip_B,
                       const Eigen::Quaterniond& orientation_B) noexcept;

  /// Takes at most `amount` of the density of every voxel that a ray of the last touch() ran
  /// through, once for each of the rays. @returns the sum of what was taken
  double remove(BoneVolume& volume, float amount) noexcept;

 private:
  /// The farthest a ray goes, in voxels, before it counts as through.
  static constexpr std::int32_t kLongestRay = 256;

  double radius_;
  std::vector<Eigen::Vector3d> directions_;  // from the centre, unit length
  std::vector<std::int32_t> addresses_;      // of voxels that rays ran through
  std::size_t used_{0};                      // of them
};

/// The force of a contact [N]: stiffness [N/m], for each sample, times `push`; at most
/// `force_limit` [N] long. Servo thread.
Eigen::Vector3d surface_force(const SurfaceContact& contact, double stiffness,
                              double force_limit) noexcept;

}  // namespace haptrial::bone
