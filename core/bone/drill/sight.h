#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/bone/drill/burr_shape.h"
#include "core/bone/model/bone_model.h"
#include "core/bone/model/bone_volume.h"

namespace haptrial::bone {

/// The burr on a tick, in a frame.
struct BurrOnTick {
  Eigen::Vector3d centre{Eigen::Vector3d::Zero()};  // [m]
  double radius{0.0};                               // 0: no burr [m]
  const BurrShape* shape{nullptr};                  // null: a ball
  Eigen::Vector3d axis{Eigen::Vector3d::UnitZ()};   // from the tip along the handle, unit length

  /// Greatest distance of its points from the centre [m].
  double reach() const noexcept { return shape != nullptr ? shape->reach() : radius; }
  /// Whether it reaches into a voxel's cube; the grid is in the burr's frame. Exact for balls; to a
  /// thousandth of a voxel for other shapes.
  bool touches(const geometry::VoxelGrid& grid, const Voxel& voxel) const noexcept;
};

BurrOnTick in_frame(const Eigen::Isometry3d& X, const BurrOnTick& burr) noexcept;

/// Which voxels of a bone still stand while a record of its drilling is gone through. One thread.
class StandingBone {
 public:
  /// All of the bone. @throws std::invalid_argument where the model does not fit together.
  explicit StandingBone(std::shared_ptr<const BoneModel> bone);

  const BoneModel& bone() const noexcept { return *bone_; }
  const geometry::VoxelGrid& grid() const noexcept { return bone_->grid; }
  bool inside(const Voxel& voxel) const noexcept { return grid().contains(voxel); }
  /// Whether a voxel inside the grid stands.
  bool holds(const Voxel& voxel) const noexcept {
    const std::size_t at = grid().index(voxel);
    return ((bits_[at / 64] >> (at % 64)) & 1U) != 0;
  }
  /// @returns false when there was nothing, or the voxel is outside the grid
  bool take(const Voxel& voxel) noexcept;
  /// Takes a voxel and all that hangs together with it through faces.
  /// @param taken  its voxels are appended; may be null
  void take_part(const Voxel& voxel, std::vector<Voxel>* taken = nullptr);

 private:
  std::shared_ptr<const BoneModel> bone_;
  std::vector<std::uint64_t> bits_;  // by index in the grid
};

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
