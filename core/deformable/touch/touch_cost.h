#pragma once

#include "core/deformable/touch/ball_touch.h"

namespace haptrial::deformable {

/// How long a tick of a ball that presses takes on this machine, now: the least of three times.
struct TouchCost {
  double median{};  // [s]
  double most{};    // of 99 in 100 ticks [s]
  bool crowded{};   // the ball lay on more places than are computed: it is felt softer
};

/// Cost of a touch that is put to rest: presses at up to 12 places, 0.4 of the ball's radius deep
/// and back; takes some 0.1 s.
/// @param radius  of the ball [m]  @param period  of a tick [s]
TouchCost measured_cost(BodyTouch& touch, const HapticMesh& mesh, double radius, double period);
/// The same of a body at rest on every tick. @throws std::invalid_argument as BallTouch does.
TouchCost measured_cost(const SharedCompliance& body, const TouchOptions& options);

}  // namespace haptrial::deformable
