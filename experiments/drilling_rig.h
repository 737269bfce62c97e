#pragma once

#include "core/device/virtual_device.h"
#include "core/subject/drilling_hand.h"
#include "core/subject/hand.h"
#include "experiments/bone_definition.h"
#include "experiments/rig.h"

namespace haptrial::experiments {

/// A virtual device with a virtual hand that drills.
class DrillingRig final : public Rig {
 public:
  /// @param session_seed  the hand's noise follows from it
  DrillingRig(const BoneDefinition& definition, std::uint64_t session_seed);

  device::Device& device() override { return device_; }
  stimulus::Observer* subject() override { return &subject_; }

 private:
  subject::Hand hand_;
  device::VirtualDevice device_;
  subject::DrillingHand subject_;
};

}  // namespace haptrial::experiments
