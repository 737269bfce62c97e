#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/device/device.h"
#include "core/stimulus/observer.h"
#include "experiments/setup.h"

namespace haptrial::device {
class MouseDevice;
}

namespace haptrial::experiments {

/// What a session drives: a device, and who holds it.
class Rig {
 public:
  virtual ~Rig() = default;
  virtual device::Device& device() = 0;
  /// The virtual subject; null where a person holds the device.
  virtual stimulus::Observer* subject() { return nullptr; }
  /// Where the screen's pointer goes; null for any other device.
  virtual device::MouseDevice* mouse() { return nullptr; }
};

/// Which device, and where its vendor's library is.
struct DeviceChoice {
  std::string name{"virtual"};  // or mouse, force-dimension, open-haptics, replay:FILE
  std::string library{};        // a path in place of the search
};

/// Opens a device, set up as the definition says; replay:FILE plays a recorded session's hand back.
/// @param virtual_rig  makes a virtual device with a virtual person
/// @throws InputError for an unknown name, an absent library or an envelope that the device cannot
///         fill; RunError where no device answers.
std::unique_ptr<Rig> make_rig(const DeviceChoice& choice, const Setup& setup,
                              const std::function<std::unique_ptr<Rig>()>& virtual_rig);

/// @throws InputError unless make_rig knows the name.
void check_device_name(const std::string& name);

/// @throws InputError for a library that this device has no use for.
void check_library(const std::string& device, const std::string& library);

/// FILE of replay:FILE; nothing for any other device.
std::optional<std::string> replayed_file(const std::string& device);

}  // namespace haptrial::experiments
