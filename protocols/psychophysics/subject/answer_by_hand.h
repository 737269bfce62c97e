#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "core/base/point_state.h"
#include "protocols/psychophysics/presentation/trial_view.h"

namespace haptrial::subject {
class ExplorationController;
}

namespace haptrial::subject {
class ExplorationController;
}

namespace haptrial::protocols {

/// How a virtual participant moves the tip of a tool into a place that gives an answer: straight
/// there; a hand that is in it already, or that has not been heard after a second, goes away first
/// and comes back. Servo thread, all of it: no allocation, lock, I/O or throw.
class AnswerByHand {
 public:
  static constexpr double kReach = 0.5;     // a way takes so long [s]
  static constexpr double kPatience = 1.0;  // and then the hand waits to be heard [s]

  /// The number of a choice's place among those that are shown; -1: it is not given by touch.
  static int place_of(const TrialQuestion& question, int choice) noexcept;

  /// @param mark  of view.marks
  void begin(const TrialView& view, std::size_t mark, subject::ExplorationController& prober,
             const PointState& hand) noexcept;
  /// One tick later.
  void tick(subject::ExplorationController& prober, const PointState& hand, double dt) noexcept;
  void end() noexcept { under_way_ = false; }
  bool under_way() const noexcept { return under_way_; }
  std::size_t device() const noexcept { return device_; }  // whose hand it is

 private:
  void go(subject::ExplorationController& prober, const PointState& hand, bool away) noexcept;

  Eigen::Vector3d place_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d away_{Eigen::Vector3d::Zero()};  // a point outside of the place
  std::size_t device_{0};
  double time_{0.0};  // on the present way [s]
  bool going_away_{false};
  bool under_way_{false};
};

struct MarkMeans;

/// How a virtual participant answers a scale by its hand: it moves along the line to the place that
/// it means, rests there and presses the button. The answer is where the hand is then, with what
/// its movement lacks in precision. Servo thread, all of it: no allocation, lock, I/O or throw.
class MarkByHand {
 public:
  static constexpr double kReach = 0.6;  // a way takes so long [s]
  static constexpr double kRest = 0.4;   // before the button [s]

  /// @param x  of the place [m]. A hand that is near it goes away first: the mark must move.
  void begin(const MarkMeans& mark, double x, subject::ExplorationController& prober,
             const PointState& hand) noexcept;
  /// One tick later. @returns whether the button is held down
  bool tick(subject::ExplorationController& prober, const PointState& hand, double dt) noexcept;
  void end() noexcept { under_way_ = false; }
  bool under_way() const noexcept { return under_way_; }

 private:
  double x_{0.0};     // [m]
  double time_{0.0};  // on the present way [s]
  bool going_away_{false};
  bool under_way_{false};
};

}  // namespace haptrial::protocols
