#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/bone/drill/burr_on_tick.h"
#include "core/bone/drill/standing_bone.h"
#include "core/bone/model/bone_model.h"

namespace haptrial::bone {

/// Whether nothing stands between a voxel's centre and the eye but bone that the burr touches.
/// @param eye, burr  in B [m]
/// Source: Morris 2006, §3.5.1.
bool is_visible(const StandingBone& bone, const Voxel& voxel, const Eigen::Vector3d& eye,
                const BurrOnTick& burr);

/// How many of the voxels that burrs removed were seen.
struct Visibility {
  std::vector<std::uint8_t> visible;  // (removals) 1: visible when it was removed
  std::size_t count{0};               // of the visible ones

  std::optional<double> share() const;  // nothing where nothing was removed
};

/// Goes along with a drilling, one voxel at a time. One thread, not the servo thread; takes about a
/// microsecond a voxel.
class VisibilityMeter {
 public:
  /// @param pose_WB  of the bone
  VisibilityMeter(std::shared_ptr<const BoneModel> bone, const Eigen::Isometry3d& pose_WB);

  /// Sets the eye from now on. @param eye  in W [m]
  void look_from(const Eigen::Vector3d& eye);
  /// A part that turned to dust. @param taken  its voxels are appended; may be null
  void crumble(const Voxel& voxel, std::vector<Voxel>* taken = nullptr) {
    bone_.take_part(voxel, taken);
  }
  /// A voxel that the cut plane took: it hides nothing from now on, and nobody had to see it.
  void cut(const Voxel& voxel) noexcept { bone_.take(voxel); }
  /// A removed voxel. @param burr  in W
  /// @returns whether it was visible; never before the first look_from()
  bool remove(const Voxel& voxel, const BurrOnTick& burr);

  const Visibility& visibility() const noexcept { return found_; }
  const StandingBone& bone() const noexcept { return bone_; }

 private:
  StandingBone bone_;
  Eigen::Isometry3d pose_BW_;
  std::optional<Eigen::Vector3d> eye_;  // in B [m]
  Visibility found_;
};

}  // namespace haptrial::bone
