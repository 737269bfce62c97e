#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "core/base/point_state.h"
#include "core/subject/hand_model.h"
#include "core/subject/hand_parameters.h"
#include "core/subject/noise.h"
#include "core/subject/perceiver/contour.h"
#include "core/subject/perceiver/palpation.h"

namespace haptrial::subject {

/// The arm asks nothing of the hand.
struct Rest {};

/// The hand keeps the place at which it is.
struct Hold {};

/// A push along a direction that rises smoothly and is then held; across it the hand keeps its
/// place. Beyond `travel` the arm holds back, so that a push into nothing ends.
struct Press {
  Eigen::Vector3d direction{0.0, -1.0, 0.0};  // in W, any length above 0
  double force{3.0};                          // >= 0 [N]
  double rise{0.5};                           // > 0 [s]
  double travel{0.05};                        // from where it began > 0 [m]
};

/// Stroke to and fro about the place where it began, p(t) = a + A u sin(2 pi f t) after the first
/// half cycle, in which it grows. With a force the hand presses along `normal` and moves across it.
struct Stroke {
  Eigen::Vector3d direction{1.0, 0.0, 0.0};  // u in W, any length above 0
  double half_length{0.02};                  // A > 0 [m]
  double frequency{0.5};                     // f > 0 [Hz]
  Eigen::Vector3d normal{0.0, -1.0, 0.0};    // in W, any length above 0, not along `direction`
  double force{0.0};                         // >= 0 [N]
};

/// A straight reach from rest to rest with the least jerk; then the hand keeps that place.
struct Reach {
  Eigen::Vector3d to{Eigen::Vector3d::Zero()};  // in W [m]
  double duration{0.5};                         // > 0 [s]
};

/// The aim follows a place that moves (lead()) as two equal lags would, 1 / (1 + s lag / 2)², which
/// is `lag` behind a slow movement.
struct Pursue {
  double lag{0.15};  // > 0 [s]
};

/// How the hand explores during a stage.
using Probe = std::variant<Rest, Hold, Press, Stroke, Reach, Pursue, Contour, Palpate>;

/// @throws std::invalid_argument naming the parameter that breaks its bound.
void check(const Probe& probe);

/// The arm that probes: from a tick's state of the hand to the command for the next step,
///
///     f = P (kp (p_d - p) + kd (v_d - v) + i + m a_d + b v_d + k (p_d - e_d) + c) + push
///
/// with m, b, k, the friction c and the yielding posture e of the hand itself (hand_parameters.h)
/// and P without the direction along which it pushes. The feedback is at most 6 N; i sums the error
/// while a place is kept, so that a steady load is carried. Minimum jerk: Flash and Hogan 1985.
/// Servo thread: no allocation, lock, I/O or throw (ProberTest.DoesNotAllocate).
class ExplorationController {
 public:
  explicit ExplorationController(const HandParameters& hand) noexcept : hand_(hand) {}
  /// The same with noise in proportion to the force, and tremor.
  ExplorationController(const HandParameters& hand, const MotorNoise& noise) noexcept
      : hand_(hand), noise_(noise) {}

  /// Begins where the hand is. @param probe  passes check()
  void begin(const Probe& probe, const PointState& hand) noexcept;
  /// The place that a pursuit follows, in W [m]; where the hand began, until it is told.
  void lead(const Eigen::Vector3d& place) noexcept { lead_ = place; }
  /// One tick later. @param hand  as the device reads it, in W; @param dt  > 0 [s]
  /// @param felt  force on the hand in W, which a contour is followed by [N]
  HandCommand command(const PointState& hand, double dt,
                      const Eigen::Vector3d& felt = Eigen::Vector3d::Zero()) noexcept;

  /// Position that the arm aims at; for a press the place where it began. In W.
  const PointState& desired() const noexcept { return desired_; }
  double time() const noexcept { return time_; }  // since begin() [s]

 private:
  struct Aim {
    Eigen::Vector3d acceleration{Eigen::Vector3d::Zero()};  // [m/s²]
    Eigen::Vector3d push{Eigen::Vector3d::Zero()};          // open loop [N]
    Eigen::Vector3d free{Eigen::Vector3d::Zero()};          // no feedback along it; unit or zero
    bool keeps_place{false};
  };
  /// Sensations of the hand on a tick.
  struct HandSensation {
    const PointState& hand;
    const Eigen::Vector3d& felt;  // [N]
    double dt;                    // [s]
  };
  Aim aim(const Rest&, const HandSensation& now) noexcept;
  Aim aim(const Hold&, const HandSensation& now) noexcept;
  Aim aim(const Press& press, const HandSensation& now) noexcept;
  Aim aim(const Stroke& stroke, const HandSensation& now) noexcept;
  Aim aim(const Reach& reach, const HandSensation& now) noexcept;
  Aim aim(const Pursue& pursue, const HandSensation& now) noexcept;
  Aim aim(const Contour& contour, const HandSensation& now) noexcept;
  Aim aim(const Palpate& palpate, const HandSensation& now) noexcept;
  Eigen::Vector3d track(const Aim& aim, const PointState& hand, double dt) noexcept;

  HandParameters hand_;
  std::optional<MotorNoise> noise_;
  Probe probe_{Rest{}};
  ContourFollower follower_;
  PointState desired_;
  Eigen::Vector3d lead_{Eigen::Vector3d::Zero()};      // [m]
  Eigen::Vector3d start_{Eigen::Vector3d::Zero()};     // where it began [m]
  Eigen::Vector3d posture_{Eigen::Vector3d::Zero()};   // e_d [m]
  Eigen::Vector3d integral_{Eigen::Vector3d::Zero()};  // i [N]
  Eigen::Vector3d carried_{Eigen::Vector3d::Zero()};   // against loads of the probe before [N]
  double time_{0.0};
};

}  // namespace haptrial::subject
