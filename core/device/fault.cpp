#include "core/device/fault.h"

namespace haptrial::device {

const char* describe(Fault fault) noexcept {
  switch (fault) {
    case Fault::kNone:
      return "no fault";
    case Fault::kReadFailed:
      return "the device did not answer";
    case Fault::kWriteFailed:
      return "the device refused the force";
    case Fault::kPositionNotFinite:
      return "the device gave a position that is not a number";
    case Fault::kJump:
      return "the position jumped further between two ticks than a hand can move";
    case Fault::kSpeed:
      return "the tool moved faster than the envelope allows";
    case Fault::kWorkspace:
      return "the tool left the workspace";
    case Fault::kForceNotFinite:
      return "the protocol asked for a force that is not a number";
    case Fault::kForceTooLarge:
      return "the protocol asked for more force than the envelope allows";
    case Fault::kForcesOff:
      return "the device switched its motors off";
    case Fault::kStopButton:
      return "the device's stop button was pressed";
    case Fault::kEmergencyStop:
      return "emergency stop";
    case Fault::kOrientationNotFinite:
      return "the device gave an orientation that is not a unit quaternion";
    case Fault::kFrozen:
      return "the position stayed the same although the force changed by more than a hand can "
             "resist: the reading is frozen";
    case Fault::kJitter:
      return "the position jitters faster than a hand can move";
    case Fault::kOscillation:
      return "the force swings to and fro faster than a hand moves: the handle oscillates";
    case Fault::kSaturation:
      return "the force stayed at the limit for longer than the envelope allows";
    case Fault::kEnergy:
      return "the force gave the hand more energy than the protocol intended";
    case Fault::kOtherDevice:
      return "another device of the session has a fault";
    case Fault::kChannelLost:
      return "a channel that the session needs is lost";
    case Fault::kBeyondLimit:
      return "a measured value is beyond the limit of its channel";
  }
  return "unknown fault";
}

}  // namespace haptrial::device
