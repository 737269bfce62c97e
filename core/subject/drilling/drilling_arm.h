#pragma once

#include <cstdint>

/// Functions that the arms of both virtual drillers share.
namespace haptrial::subject {

inline constexpr double kStiffness = 300.0;  // of the arm about where it wants to be [N/m]
inline constexpr double kDamping = 25.0;     // [N·s/m]
inline constexpr double kPressing = 0.05;    // of a button, and its rest [s]

/// The bits of a reading while only `button` is held; none for a button below 0.
constexpr std::uint32_t held(int button) noexcept {
  return button < 0 ? 0U : std::uint32_t{1} << static_cast<unsigned>(button);
}

}  // namespace haptrial::subject
