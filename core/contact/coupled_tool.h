#pragma once

#include <Eigen/Geometry>
#include <span>

namespace haptrial::contact {

/// How a rigid tool hangs on the hand and on what it touches.
struct Coupling {
  double stiffness{1000.0};          // k_h of the spring to the hand > 0 [N/m]
  double turning_stiffness{0.3};     // k_t of the spring that turns with it > 0 [N·m/rad]
  double contact_stiffness{2000.0};  // k of each point that touches > 0 [N/m]
  double friction{0.0};              // μ >= 0
  double most_step{2e-4};            // of a tool that touches, in a tick [m]
  double most_turn{0.01};            // likewise [rad]
  double free_step{1e-3};            // of one that touches nothing, after a hand that is ahead [m]
  double free_turn{0.05};            // likewise [rad]
};

/// A point of the tool in something else, or so near that it may come in within a tick.
struct TouchingPoint {
  Eigen::Vector3d lever{Eigen::Vector3d::Zero()};  // from the tool's origin, in W [m]
  Eigen::Vector3d back{Eigen::Vector3d::Zero()};   // in which it is pushed, in W, unit length
  double depth{0.0};                               // below 0: that far before it [m]
};

/// A rigid tool in all six degrees of freedom that a hand leads by a virtual coupling. On each tick
/// it goes by one step of Newton's method towards the least of the energy
///
///     E = 1/2 k_h |x - x_h|² + 1/2 k_t |θ|² + Σ 1/2 k d_i²
///
/// that is stored between it and the hand (its place x from the hand's x_h, its turn θ from the
/// hand's) and in all points that touch, or will after the step. Friction of μ times a point's
/// force acts against its slip. The hand feels the springs of its own: nothing while nothing
/// touches, when the tool goes with the hand exactly. The tool has no weight and no inertia, so
/// that only friction and steps that lag behind the hand take energy, and nothing gives any. Source
/// of the idea: McNeely, Puterbaugh and Troy 1999 (points, coupling); Barbič and James 2008 (rest
/// in place of motion).
///
/// Servo thread: no allocation, lock, wait or throw.
class CoupledTool {
 public:
  explicit CoupledTool(const Coupling& coupling = {}) : coupling_(coupling) {}

  /// Puts the tool into the hand. @param hand  X_WT
  void begin(const Eigen::Isometry3d& hand) noexcept;
  /// X_WT of the tool after the last tick.
  const Eigen::Isometry3d& pose() const noexcept { return tool_; }

  struct Felt {
    Eigen::Vector3d force{Eigen::Vector3d::Zero()};   // on the hand, in W [N]
    Eigen::Vector3d torque{Eigen::Vector3d::Zero()};  // on it, about its origin, in W [N·m]
    int touching{0};                                  // points that carry them
  };
  /// One tick. @param hand  X_WT; not finite: the tool stays, and nothing is felt
  /// @param points  that touch at pose(), or nearly  @param dt  since the tick before > 0 [s]
  Felt follow(const Eigen::Isometry3d& hand, std::span<const TouchingPoint> points,
              double dt) noexcept;

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  struct Step {
    Vector6 way{Vector6::Zero()};  // of the origin, and the turn
    int touching{0};               // points that touched in it
  };
  void rub(const TouchingPoint& at, double dt, Matrix6& stiffness) const noexcept;
  Step step_with(const Eigen::Isometry3d& hand, std::span<const TouchingPoint> points,
                 const Vector6& after, double dt) const noexcept;
  Step step_to_rest(const Eigen::Isometry3d& hand, std::span<const TouchingPoint> points,
                    double dt) const noexcept;
  void move(const Vector6& step) noexcept;

  Coupling coupling_;
  Eigen::Isometry3d tool_{Eigen::Isometry3d::Identity()};
  Vector6 slip_{Vector6::Zero()};  // the last step: of the origin, and the turn
};

}  // namespace haptrial::contact
