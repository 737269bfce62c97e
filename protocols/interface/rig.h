#pragma once

#include <vector>

#include "core/stimulus/observer.h"
#include "protocols/interface/device_set.h"

namespace haptrial::device {
class Gamepad;
class MouseDevice;
}  // namespace haptrial::device

namespace haptrial::protocols {

/// Devices of a session, one or more, and the hands that hold them.
class Rig {
 public:
  virtual ~Rig() = default;
  virtual device::Device& device() = 0;  // the first
  /// The devices after the first, each with its envelope.
  virtual std::vector<DeviceSet::Arm> others() { return {}; }
  /// All of them. @param envelope  of the first
  std::vector<DeviceSet::Arm> arms(const device::EnvelopeLimits& envelope) {
    std::vector<DeviceSet::Arm> all = others();
    all.insert(all.begin(), {&device(), envelope});
    return all;
  }
  /// The virtual subject; null where a person holds the devices.
  virtual stimulus::Observer* subject() { return nullptr; }
  /// Does the work that the virtual subject leaves to others than the servo thread; called often
  /// while a pass runs. Session's thread. @throws InputError if it cannot go on
  virtual void attend() {}
  /// Device that the screen's pointer moves; null for any other device.
  virtual device::MouseDevice* mouse() { return nullptr; }
  /// Controller that moves that pointer in the mouse's place; null: none.
  virtual device::Gamepad* gamepad() { return nullptr; }
  /// Whether somebody feels the forces.
  bool felt() { return !device().info().simulated && mouse() == nullptr; }
};

}  // namespace haptrial::protocols
