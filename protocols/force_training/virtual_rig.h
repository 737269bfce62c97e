#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/device/virtual_device.h"
#include "core/stimulus/observer.h"
#include "core/subject/hand_model.h"
#include "core/subject/virtual_subject.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/interface/rig.h"

namespace haptrial::protocols {

/// A virtual device with a virtual subject's hand on it: what stands in for hardware and a person.
class VirtualRig final : public Rig {
 public:
  /// @param person_seed   the person follows from it, the same in every session
  /// @param session_seed  every other random number of theirs does
  /// @param lessons       of earlier sessions
  VirtualRig(const ForceDefinition& definition, std::uint64_t person_seed,
             std::uint64_t session_seed, std::vector<subject::Lesson> lessons);
  /// In a first session. @param seed  person and every random number follow from it
  VirtualRig(const ForceDefinition& definition, std::uint64_t seed)
      : VirtualRig(definition, seed, seed, {}) {}

  device::Device& device() override { return device_; }
  stimulus::Observer* subject() override { return subject_.get(); }

 private:
  std::unique_ptr<subject::HandModel> hand_;
  device::VirtualDevice device_;
  std::unique_ptr<stimulus::Observer> subject_;
};

}  // namespace haptrial::protocols
