#pragma once

#include <memory>

#include "core/device/virtual_device.h"
#include "core/subject/hand.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/interface/rig.h"

namespace haptrial::protocols {

/// A virtual device with a virtual hand that drills, or a virtual surgeon.
class DrillingRig final : public Rig {
 public:
  /// @param session_seed  whatever is drawn for the person follows from it
  /// @param participant   from 0; says the group
  DrillingRig(const BoneDefinition& definition, std::uint64_t session_seed, int participant = 0);

  device::Device& device() override { return device_; }
  stimulus::Observer* subject() override { return subject_.get(); }

 private:
  subject::Hand hand_;
  device::VirtualDevice device_;
  std::unique_ptr<stimulus::Observer> subject_;
};

}  // namespace haptrial::protocols
