#pragma once

#include <memory>

#include "core/device/virtual_device.h"
#include "core/subject/hand.h"
#include "protocols/bone_drilling/definition/bone_definition.h"
#include "protocols/interface/rig.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// A virtual device with a virtual hand that drills, or a virtual surgeon.
class DrillingRig final : public Rig {
 public:
  /// @param place  of the session. A virtual surgeon is the same person on every day, and has
  /// learned
  ///               from the procedures of earlier days; other hands follow from the session's seed
  /// @param work   of a virtual surgeon, as subject::DrillingSurgeon has it
  DrillingRig(const BoneDefinition& definition, const SessionPlace& place,
              subject::WorkLog* work = nullptr);
  ~DrillingRig() override;

  device::Device& device() override { return device_; }
  std::vector<DeviceSet::Arm> others() override;
  stimulus::Observer* subject() override { return both_ ? both_.get() : subject_.get(); }

 private:
  /// The other hand at its device.
  struct Second;
  class BothHands;

  subject::Hand hand_;
  device::VirtualDevice device_;
  std::unique_ptr<stimulus::Observer> subject_;
  std::unique_ptr<Second> second_;  // null: one hand
  std::unique_ptr<stimulus::Observer> both_;
};

}  // namespace haptrial::protocols
