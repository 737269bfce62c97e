#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/bone/model/bone_volume.h"
#include "core/bone/model/occupancy.h"
#include "core/bone/surface/border_shares.h"
#include "core/bone/surface/remains.h"
#include "core/bone/surface/surface_depths.h"

namespace haptrial::bone {

/// A corner of surface triangles.
struct SurfaceVertex {
  std::array<float, 3> place{};          // in B [m]
  std::array<std::int16_t, 3> normal{};  // outwards; 32767 is 1
  std::uint8_t label{0};                 // of the nearest filled voxel
  std::uint8_t density{0};               // mean of the filled voxels' first one; 255 is 1
  std::uint8_t near_label{0};            // of the nearest structure; 0: none within reach
  std::uint8_t near_depth{0};   // to it from the nearest filled voxel, in units of kDepthUnit
  std::uint8_t other_label{0};  // of the structure that borders on it here; 0: none
  std::uint8_t other_share{0};  // of that in what is filled around; 255 is all

  static constexpr double kDepthUnit = 25e-6;  // [m]; depths end at 255 units
  bool operator==(const SurfaceVertex&) const = default;
};

/// Numbers of three vertices.
using SurfaceTriangle = std::array<std::uint32_t, 3>;

/// Which voxels are drawn as filled in and around a brick of 8 x 8 x 8 cells, and how much is left
/// around each: the sum of what is left of the 5 x 5 x 5 voxels around, weighted 1, 4, 6, 4, 1
/// along each axis, for places, and the same of these sums for normals, which want to be smoother.
/// Whole numbers, so that a sum is the same in any order.
///
/// A voxel of which half or less is left belongs to the empty side of the surface if one of the 26
/// around has more, so that the surface passes through the middle of a voxel as half of it is gone;
/// else it is a crumb, and filled.
class CellField {
 public:
  static constexpr int kEdge = BoneVolume::kEdge;
  static constexpr int kReach = 4;  // voxels around a cell that count
  static constexpr int kFull = RemainingFraction::kWhole * 16 * 16 * 16;  // the sum deep inside

  /// Reads the voxels around the cells from `origin`, a multiple of 8 along each axis.
  /// @param occupancy, remains  of the volume
  /// @returns whether the cells have both filled and empty corners; else there are no vertices.
  bool read(const BoneVolume& volume, const Occupancy& occupancy, const RemainingFraction& remains,
            const Voxel& origin) noexcept;

  struct Count {
    std::size_t vertices{0};
    std::size_t quads{0};  // between a cell's first voxel and the next along each axis
  };
  Count count() const noexcept;
  /// Bit b is the cell's corner (b & 1, b >> 1 & 1, b >> 2): whether it is filled.
  unsigned corners(int i, int j, int k) const noexcept;
  /// Whether a voxel is drawn as filled. @param voxel  from the origin of the cells, each
  /// coordinate from -4 to 12
  bool is_filled(const Voxel& voxel) const noexcept {
    const auto row = static_cast<std::size_t>((voxel.y() + kReach) + kWide * (voxel.z() + kReach));
    return (filled_[row] >> (voxel.x() + kReach) & 1U) != 0;
  }
  /// Works out the sums; needed before place(). @param remains  as it was read
  void smooth(const RemainingFraction& remains, const BorderShares& border) noexcept;
  /// Place at which the smoothed field of a cell is half full, and its direction there.
  /// @param normal  outwards, of unit length
  /// @returns the place from the cell's middle, each coordinate from -0.5 to 0.5 [voxels]
  Eigen::Vector3f place(int i, int j, int k, unsigned corners,
                        Eigen::Vector3f& normal) const noexcept;

 private:
  static constexpr int kCorner = kEdge + 1;           // voxels 0 .. 8
  static constexpr int kSums = kCorner + 4;           // voxels -2 .. 10
  static constexpr int kWide = kCorner + 2 * kReach;  // voxels -4 .. 12
  using Rows = std::array<std::uint32_t, kWide * kWide>;

  void leave_out_rests(const RemainingFraction& remains) noexcept;
  template <class Visit>
  static void for_each_row(const Visit& visit);

  std::array<std::int32_t, 27> bricks_;  // of the volume, around and at the cells
  Rows holds_;                           // bit i + 4 of row (j, k): holds bone
  Rows filled_;                          // likewise, and is drawn so
  std::array<std::uint32_t, kSums * kSums * kSums> sums_;
  std::array<std::uint32_t, kCorner * kCorner * kCorner> wide_sums_;
};

/// The structure that borders on a vertex's own, for colours without the steps of the voxels.
class LabelMix {
 public:
  struct OtherLabel {
    std::uint8_t label{0};
    std::uint8_t share{0};  // of what is filled around the vertex; 255 is all
  };

  LabelMix() = default;
  /// @param volume  whose labels never change
  explicit LabelMix(const BoneVolume& volume);

  /// Whether voxels around the cells of a brick have more than one label; else there is no other.
  /// @param origin  of the cells, as CellField::read() has it
  bool is_mixed(const BoneVolume& volume, const Voxel& origin) const noexcept;
  /// The other label that fills most of the 4 x 4 x 4 voxels around a cell, weighted 1, 3, 3, 1
  /// along each axis. @param own  label of the vertex
  static OtherLabel around(const BoneVolume& volume, const CellField& field, const Voxel& origin,
                           const Voxel& of_brick, std::uint8_t own) noexcept;

 private:
  static constexpr std::uint8_t kMixed = 255;  // no label: a model has fewer
  std::vector<std::uint8_t> labels_;           // by brick: the only one, 0 or kMixed
};

}  // namespace haptrial::bone
