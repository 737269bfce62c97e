#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "core/bone/model/world.h"

namespace haptrial::bone {

/// A rectangle in its own frame C, centred on the origin, `width` along x and `height` along y;
/// what it cuts reaches from it `depth` along z.
struct CutPlane {
  Eigen::Isometry3d pose_WC{Eigen::Isometry3d::Identity()};
  double width{0.02};   // > 0 [m]
  double height{0.02};  // > 0 [m]
  double depth{0.001};  // >= 0; 0 cuts what the rectangle passes through [m]
};

/// The keys of a tool that cuts a plane.
const Schema<CutPlane>& cut_plane_schema();

/// Removes all bone on rays from the rectangle along its normal, without any force. The rays are
/// 0.7 voxels apart at most, and there is one within half a voxel of every point of the rectangle:
/// no two voxels with a common face stay on both sides of it (docs/algorithms/bone-pieces.md).
/// Source: Morris 2006, §3.2.5.
///
/// A large cut is spread over ticks: begin() and then step() until it is not busy(). The cut is
/// made where the pieces were at begin(), whatever moves meanwhile. Servo thread: no allocation,
/// lock or throw.
class CutPlaneTool {
 public:
  /// Voxels that a step empties at most: what is logged of a cut must not outrun who reads the log.
  static constexpr std::size_t kMostEmptied = 256;

  struct RemovedVoxels {
    std::int64_t voxels{0};
    double amount{0.0};                         // sum of densities [voxels]
    std::array<std::uint32_t, 256> by_label{};  // voxels
  };

  /// Begins a cut; one that is under way is given up. A plane that is not finite, has no area or is
  /// more than 10,000 voxels long cuts nothing.
  void begin(const BoneWorld& world, const CutPlane& plane) noexcept;
  bool busy() const noexcept { return busy_; }
  /// Goes on with the cut through the pieces of the same world.
  /// @param most  voxels to pass, all pieces together; at least one ray is traced, or as far as
  ///              kMostEmptied goes
  void step(BoneWorld& world, int most = 2000) noexcept;
  /// Voxels that the last step() emptied, in order.
  std::span<const EmptiedIn> emptied() const noexcept { return {emptied_.data(), count_}; }
  /// Bone that the cut has removed so far.
  const RemovedVoxels& removed() const noexcept { return removed_; }

 private:
  bool next_piece() noexcept;
  struct TraceResult {
    int passed;  // voxels, at least 1
    bool whole;  // the ray came to its end
  };
  TraceResult trace(BoneWorld& world, PieceSet volumes) noexcept;

  bool busy_{false};
  CutPlane plane_;
  PieceSet pieces_{0};  // that were born at begin(): rays pass them one after the other
  std::array<Eigen::Isometry3d, kMaxPieces> pose_BC_;
  int columns_{0};
  int rows_{0};
  int piece_{0};
  std::int64_t ray_{0};  // the next one, in this piece
  RemovedVoxels removed_;
  std::array<EmptiedIn, kMostEmptied> emptied_;
  std::size_t count_{0};
};

}  // namespace haptrial::bone
