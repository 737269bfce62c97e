#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/render/gl/image.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::protocols {

/// Three slices through a bone at the tool's tip, as a scan of the bone in its present state would
/// show them, one above the other: axial, coronal and sagittal in the bone's frame (LPS). Grey is
/// density times hardness of the structure; outlines have the structures' colours; lines cross at
/// the tip. One thread; reads a volume that the servo thread drills.
class CtSlices {
 public:
  static constexpr int kSide = 128;        // of a slice [px]
  static constexpr int kGap = 4;           // between two slices [px]
  static constexpr double kWidth = 32e-3;  // of a slice [m]

  /// @param X_BW  from the world to the bone's frame
  CtSlices(std::shared_ptr<const bone::BoneModel> model, const Eigen::Isometry3d& X_BW,
           const SliceWindow& window);

  /// One picture of all three slices, of which one is drawn anew by every call, in turn, and all
  /// by the first. @param tip_W  [m]
  std::shared_ptr<const std::vector<render::Image>> at(const bone::BoneVolume& volume,
                                                       const Eigen::Vector3d& tip_W);

 private:
  struct Plane {
    int across;        // axis of B along a line of the picture, rightwards
    int down;          // axis of B down the picture
    bool upside_down;  // whether the axis points up instead
  };
  static constexpr std::array<Plane, 3> kPlanes{{{0, 1, false}, {0, 2, true}, {1, 2, true}}};
  using Rgb = std::array<std::uint8_t, 3>;

  void draw_slice(const bone::BoneVolume& volume, std::size_t plane, const Eigen::Vector3d& tip_B);
  bone::Voxel voxel_at(const Plane& plane, const Eigen::Vector3d& tip_B, int x, int y) const;
  std::uint8_t label_at(const bone::BoneVolume& volume, const bone::Voxel& voxel) const;
  Rgb grey(const bone::BoneVolume& volume, const bone::Voxel& voxel) const;

  std::shared_ptr<const bone::BoneModel> model_;
  Eigen::Isometry3d X_BW_;
  SliceWindow window_;
  render::Image image_;
  std::size_t next_{0};
  bool drawn_{false};
};

}  // namespace haptrial::protocols
