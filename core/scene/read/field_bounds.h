#pragma once

#include "core/base/definition/bounds.h"

namespace haptrial::scene {

// Bounds of quantities that many fields have.
inline constexpr Bounds kPlaceBounds{-1.0, 1.0};             // [m]
inline constexpr Bounds kLengthBounds{0.0, 1.0, true};       // [m]
inline constexpr Bounds kForceBounds{-100.0, 100.0};         // [N]
inline constexpr Bounds kStrengthBounds{0.0, 100.0};         // [N]
inline constexpr Bounds kStiffnessBounds{0.0, 1e5};          // [N/m]
inline constexpr Bounds kDampingBounds{0.0, 1e4};            // [N·s/m]
inline constexpr Bounds kDurationBounds{0.0, 3600.0, true};  // [s]
inline constexpr Bounds kFadeBounds{0.0, 60.0};              // [s]
inline constexpr Bounds kFilterBounds{0.0, 1e5, true};       // [Hz]

/// Description of a direction that many kinds have.
inline constexpr const char* kNormal =
    "Direction across a plane or a texture's waves; of a wall or half space out of it";

}  // namespace haptrial::scene
