#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "core/bone/model/world.h"
#include "core/contact/coupled_tool.h"

namespace haptrial::bone {

/// Bone that a hand carries, among the bone that it does not: it hangs on the hand by a coupling
/// (contact::CoupledTool), and where its surface meets other bone it stays out and is held back by
/// friction, so that a fragment is guided home by what it touches.
///
/// Surface voxels of what is held are samples, each with its outward normal n. The depth of a
/// sample in other bone is how far the ray against n runs before it leaves that bone. Bone has no
/// weight and no inertia here. The source moves pieces freely, without contact: Morris 2006,
/// §3.2.6; rays along normals are those of its plates, §3.2.5.
///
/// Servo thread: no allocation, lock, wait or throw after construction. A tick looks up at most
/// kMostSamples samples.
class HeldBone {
 public:
  static constexpr std::size_t kMostSamples = 2048;
  static constexpr double kHandStiffness = 1000.0;     // [N/m]
  static constexpr double kHandTurning = 0.3;          // [N·m/rad]
  static constexpr double kContactStiffness = 2000.0;  // of one sample [N/m]
  static constexpr double kFriction = 0.3;             // assumed for bone on bone

  HeldBone();

  /// Begins with what the world holds; its samples are found in the next ticks.
  /// @param hand  X_WT of the tool that holds it
  void begin(const Eigen::Isometry3d& hand) noexcept;

  struct HeldStep {
    Eigen::Isometry3d tool{Eigen::Isometry3d::Identity()};  // where a tool would be that holds it
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};         // on the hand, in W [N]
    int touching{0};                                        // samples in other bone
  };
  /// One tick; the caller drags what is held to HeldStep::tool.
  HeldStep follow(const BoneWorld& world, const Eigen::Isometry3d& hand, double dt) noexcept;

 private:
  struct Sample {
    Voxel voxel;
    Eigen::Vector3d normal_B;
    int piece;
  };
  void begin_samples(PieceSet group) noexcept;
  void look_for_samples(const BoneWorld& world) noexcept;
  void sample_brick(const BoneWorld& world, const Voxel& first) noexcept;
  void thin_out() noexcept;
  bool is_wanted(const Voxel& voxel) const noexcept;
  void find_touching(const BoneWorld& world) noexcept;

  std::vector<Sample> samples_;
  std::vector<contact::TouchingPoint> touching_;
  contact::CoupledTool tool_;
  PieceSet group_{0};      // that was sampled: what is held and born
  int every_{1};           // of the surface voxels each every_-th one is a sample
  std::int32_t brick_{0};  // the next place of the grid to be looked at
};

}  // namespace haptrial::bone
