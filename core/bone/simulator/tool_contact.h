#pragma once

#include <Eigen/Core>
#include <array>
#include <span>

namespace haptrial::bone {

/// How hard two tools are for each other.
struct ToolContactParameters {
  double stiffness{0.0};    // k >= 0; 0: they pass through each other [N/m]
  double damping{5.0};      // c >= 0 [s/m]
  double force_limit{4.0};  // f_max > 0 [N]
};

/// A ball swept along a segment: a burr, a shaft, a tube.
struct Rod {
  Eigen::Vector3d from;  // [m]
  Eigen::Vector3d to;    // [m]
  double radius;         // > 0 [m]
};

/// How far apart two rods are.
struct RodDistance {
  double between_axes;     // from one segment to the other [m]
  Eigen::Vector3d normal;  // from the second one's axis to the first one's, unit length
};
RodDistance distance(const Rod& first, const Rod& second) noexcept;

/// The tool of one hand at that of the other. With the depth d of the rod that is deepest in the
/// other hand's, and the normal n there,
///
///     f = min(k max(0, d + d' T / 2) max(0, 1 + c d'), f_max) n
///
/// pushes the tool, and -f the other: a spring whose losses grow with its depth (Hunt and Crossley
/// 1975) and that never pulls. T is how long the force is held: with the depth of its middle the
/// holding brings no energy. d' follows from the motion of the tips, where the devices push, so
/// losses are losses there. Rods that cross go on
/// being pushed back to the side from which they came, until their surfaces are free of each other.
/// Tools that are in each other at first do not feel that before they have been apart.
///
/// Servo thread: no allocation, lock, wait or throw after construction. The source has both tools
/// and does not let them meet: Morris 2006, §3.2.8.
class ToolContact {
 public:
  static constexpr std::size_t kMost = 32;  // rods of a tool

  /// @throws std::invalid_argument naming the parameter that breaks its bound.
  explicit ToolContact(const ToolContactParameters& parameters);

  bool on() const noexcept { return p_.stiffness > 0.0; }
  /// Leaves the tools unfelt until they are apart.
  void wait() noexcept;

  /// Force on the tool, in W [N].
  /// @param tool    its rods, always in the same order; those beyond kMost are not looked at
  /// @param closing  velocity of the other's tip less that of the tool's [m/s]
  /// @param held     T >= 0 [s]
  Eigen::Vector3d force(std::span<const Rod> tool, const Rod& other, const Eigen::Vector3d& closing,
                        double held) noexcept;

 private:
  struct Deepest {
    double depth{0.0};  // [m]
    Eigen::Vector3d normal{Eigen::Vector3d::Zero()};
  };
  Deepest deepest(std::span<const Rod> tool, const Rod& other) noexcept;

  ToolContactParameters p_;
  std::array<Eigen::Vector3d, kMost> sides_;  // by rod: the normal on the last tick; 0: free
  bool waits_until_free_{true};
};

}  // namespace haptrial::bone
