#pragma once

#include <cstdint>
#include <optional>

#include "core/device/pointer_hand.h"

namespace haptrial::experiments {

/// The mouse over what a protocol shows.
struct ScreenPointer {
  double x{0.0};                           // p_W in the xz plane [m]
  double z{0.0};                           // [m]
  double wheel{0.0};                       // steps since the screen opened, up > 0
  std::uint32_t buttons{0};                // bit 0 left, 1 right, 2 middle
  std::optional<device::HandPose> hand{};  // in space, if what is shown has one
};

}  // namespace haptrial::experiments
