#pragma once

namespace haptrial::control {

/// How much of its gains a law uses on a tick, each 0 to 1 (HandleGuard).
struct GainShares {
  double stiffness{1.0};  // of springs, walls, detents and the bristle of friction
  double damping{1.0};    // of dampers and virtual masses
};

}  // namespace haptrial::control
