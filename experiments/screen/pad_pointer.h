#pragma once

#include <Eigen/Core>

#include "core/device/gamepad.h"
#include "core/render/gl/window.h"

namespace haptrial::experiments {

/// A pointer that a game controller moves in a window's place of the mouse. The screen's thread.
class PadPointer {
 public:
  /// The pointer begins in the middle. @param width, height  of the window [px]
  PadPointer(int width, int height);

  /// A picture later. @param dt  since the one before [s]
  render::Pointer moved(const device::GamepadState& pad, double dt);

 private:
  Eigen::Vector2d size_;
  render::Pointer pointer_;
};

}  // namespace haptrial::experiments
