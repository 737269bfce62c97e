#pragma once

#include "core/base/point_state.h"

namespace haptrial::subject {
class ExplorationController;
}

namespace haptrial::protocols {

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
