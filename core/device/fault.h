#pragma once

#include <cstdint>

namespace haptrial::device {

/// Why a device is without force.
enum class Fault : std::uint8_t {
  kNone,
  kReadFailed,
  kWriteFailed,
  kPositionNotFinite,
  kJump,
  kSpeed,
  kWorkspace,
  kForceNotFinite,
  kForceTooLarge,
  kForcesOff,
  kStopButton,
  kEmergencyStop,
  kOrientationNotFinite,
  kFrozen,
  kJitter,
  kOscillation,
  kSaturation,
  kEnergy,
  kOtherDevice,
  kChannelLost,
  kBeyondLimit,
};
constexpr int kFaults = static_cast<int>(Fault::kBeyondLimit) + 1;

/// One sentence, such as "the tool left the workspace".
const char* describe(Fault fault) noexcept;

}  // namespace haptrial::device
