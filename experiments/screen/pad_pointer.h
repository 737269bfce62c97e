#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/device/gamepad.h"
#include "core/device/pointer_hand.h"
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

/// The mouse over what a protocol shows.
struct ScreenPointer {
  double x{0.0};                           // p_W in the xz plane [m]
  double z{0.0};                           // [m]
  double wheel{0.0};                       // steps since the screen opened, up > 0
  std::uint32_t buttons{0};                // bit 0 left, 1 right, 2 middle
  std::optional<device::HandPose> hand{};  // in space, if what is shown has one
};

}  // namespace haptrial::experiments
