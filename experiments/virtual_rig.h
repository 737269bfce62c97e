#pragma once

#include <cstdint>
#include <memory>

#include "core/device/virtual_device.h"
#include "core/stimulus/observer.h"
#include "core/subject/hand_model.h"
#include "experiments/definition.h"
#include "experiments/rig.h"

namespace haptrial::experiments {

/// A virtual device with a virtual subject's hand on it: what stands in for hardware and a person.
class VirtualRig final : public Rig {
 public:
  /// @param session_seed  the person, and every random number of theirs, follows from it
  VirtualRig(const Definition& definition, std::uint64_t session_seed);

  device::Device& device() override { return device_; }
  stimulus::Observer* subject() override { return subject_.get(); }

 private:
  std::unique_ptr<subject::HandModel> hand_;
  device::VirtualDevice device_;
  std::unique_ptr<stimulus::Observer> subject_;
};

}  // namespace haptrial::experiments
