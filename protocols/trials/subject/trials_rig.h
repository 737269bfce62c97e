#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/device/virtual_device.h"
#include "core/subject/hand_model.h"
#include "protocols/definition/definition.h"
#include "protocols/interface/rig.h"
#include "protocols/trials/presentation/trial_view.h"
#include "protocols/trials/subject/observer_plan.h"

namespace haptrial::protocols {

struct Question;

/// A virtual device with the hand of a virtual participant, who explores, feels and answers.
class TrialsRig final : public Rig {
 public:
  /// What a participant has been told.
  struct Briefing {
    const Definition* definition{nullptr};
    const ObserverPlan* plan{nullptr};
    const std::vector<Question>* questions{nullptr};
    std::vector<std::string> stages;  // names, in their order
    SaidAnswer* said{nullptr};        // where answers go
  };
  /// @param briefing  what it points to outlives the rig
  /// @param session_seed  the person, and every random number of theirs, follows from it
  TrialsRig(const Briefing& briefing, std::uint64_t session_seed);
  ~TrialsRig() override;

  device::Device& device() override { return device_; }
  stimulus::Observer* subject() override;

 private:
  class Participant;
  std::unique_ptr<subject::HandModel> hand_;
  device::VirtualDevice device_;
  std::unique_ptr<Participant> participant_;
};

}  // namespace haptrial::protocols
