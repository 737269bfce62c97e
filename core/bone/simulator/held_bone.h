#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "core/bone/model/world.h"

namespace haptrial::bone {

/// Bone that a hand carries, among the bone that it does not: a spring draws it after the hand, and
/// where its surface meets other bone it stays out and is held back by friction, so that a fragment
/// is guided home by what it touches.
///
/// Surface voxels of what is held are samples, each with its outward normal n. A sample in other
/// bone at depth d, which is how far the ray against n runs before it leaves that bone, is pushed
/// back by a stiff spring k. On each tick what is held goes by one step of Newton's method towards
/// the least of the energy
///
///     E = 1/2 k_h |x - x_h|² + 1/2 k_t |θ|² + Σ 1/2 k d_i²
///
/// that is stored between it and the hand (its place x from the hand's x_h, its turn θ from the
/// hand's) and in all contacts. Friction of μ times a contact's force acts against its slip. The
/// hand feels its own spring, k_h (x - x_h): nothing while nothing touches, when what is held goes
/// with the hand exactly. Bone has no weight and no inertia here. The source moves pieces freely,
/// without contact: Morris 2006, §3.2.6; rays along normals are those of its plates, §3.2.5.
///
/// Servo thread: no allocation, lock, wait or throw after construction. A tick looks up at most
/// kMostSamples samples.
class HeldBone {
 public:
  static constexpr std::size_t kMostSamples = 2048;
  static constexpr double kHandStiffness = 1000.0;     // k_h [N/m]
  static constexpr double kHandTurning = 0.3;          // k_t [N·m/rad]
  static constexpr double kContactStiffness = 2000.0;  // k of one sample [N/m]
  static constexpr double kFriction = 0.3;             // μ, assumed for bone on bone

  HeldBone();

  /// Begins with what the world holds; its samples are found in the next ticks.
  /// @param hand  X_WT of the tool that holds it
  void begin(const Eigen::Isometry3d& hand) noexcept;

  struct Followed {
    Eigen::Isometry3d tool{Eigen::Isometry3d::Identity()};  // where a tool would be that holds it
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};         // on the hand, in W [N]
    int touching{0};                                        // samples in other bone
  };
  /// One tick; the caller drags what is held to Followed::tool.
  Followed follow(const BoneWorld& world, const Eigen::Isometry3d& hand, double dt) noexcept;

 private:
  struct Sample {
    Voxel voxel;
    Eigen::Vector3d normal_B;
    int piece;
  };
  struct Touching {
    Eigen::Vector3d lever;  // from the tip, in W [m]
    Eigen::Vector3d back;   // direction in which it is pushed, in W, unit length
    double depth;           // [m]
  };
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  void begin_samples(PieceSet group) noexcept;
  void look_for_samples(const BoneWorld& world) noexcept;
  void sample_brick(const BoneWorld& world, const Voxel& first) noexcept;
  void thin_out() noexcept;
  bool is_wanted(const Voxel& voxel) const noexcept;
  void find_touching(const BoneWorld& world) noexcept;
  void rub(const Touching& at, double dt, Matrix6& stiffness) const noexcept;
  Vector6 step_to_rest(const Eigen::Isometry3d& hand, double dt) const noexcept;
  void move(const Vector6& step) noexcept;

  std::vector<Sample> samples_;
  std::vector<Touching> touching_;
  Eigen::Isometry3d tool_{Eigen::Isometry3d::Identity()};
  Vector6 slip_{Vector6::Zero()};  // the last step: of the tip, and the turn
  PieceSet group_{0};              // that was sampled: what is held and born
  int every_{1};                   // of the surface voxels each every_-th one is a sample
  std::int32_t brick_{0};          // the next place of the grid to be looked at
};

}  // namespace haptrial::bone
