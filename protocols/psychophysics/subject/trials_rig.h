#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/device/virtual_device.h"
#include "core/subject/hand_model.h"
#include "protocols/definition/definition.h"
#include "protocols/interface/rig.h"
#include "protocols/psychophysics/definition/cursor_parameters.h"
#include "protocols/psychophysics/presentation/trial_view.h"
#include "protocols/psychophysics/subject/observer_plan.h"

namespace haptrial::protocols {

struct TrialQuestion;
struct TrialDevice;

/// State of a virtual participant that goes from one trial to the next.
struct CarriedOver {
  int previous{-1};  // choice that was answered last, from 0; -1: none
  double fast{0.0};  // of the adaptation, in shares of the field
  double slow{0.0};
};

/// A virtual device with the hand of a virtual participant, who explores, feels and answers; or
/// several devices, a hand or fingertip at each. A rotation or grip is simulated at the fingers
/// that move it, as a device of its own.
class TrialsRig final : public Rig {
 public:
  /// A participant's instructions.
  struct Briefing {
    const Definition* definition{nullptr};
    const ObserverPlan* plan{nullptr};
    const std::vector<TrialQuestion>* questions{nullptr};
    std::vector<std::string> stages;  // names, in their order
    const std::vector<TrialDevice>* devices{nullptr};
    SimulatedAnswer* said{nullptr};  // where answers go
    /// Answers on the session's thread in place of the participant; null: nobody does.
    std::function<LeftDecision::Answer(const LeftDecision::DecisionRequest&)> decide{};
    ScreenPlane screen{};  // on which trials are seen
  };
  /// @param briefing  what it points to outlives the rig
  /// @param person_seed   who it is follows from it: the same person in every session
  /// @param session_seed  every random number of theirs follows from it
  TrialsRig(const Briefing& briefing, std::uint64_t person_seed, std::uint64_t session_seed);
  ~TrialsRig() override;

  device::Device& device() override { return arms_.front()->device; }
  std::vector<DeviceSet::Arm> others() override;
  stimulus::Observer* subject() override;
  void attend() override;
  /// Decisions that are left to the session's thread; null: none are.
  const LeftDecision* left() const { return left_.get(); }
  /// Goes on from what an earlier run of the session left. Session's thread, before the first pass.
  void recall(const CarriedOver& before);
  /// Adaptation up to the end of the last pass, whether or not the participant has noticed that it
  /// ended. Session's thread, between passes.
  CarriedOver carried_over() const;

 private:
  /// A hand at its device.
  struct Arm {
    Arm(const Definition& definition, const device::VirtualDeviceParameters& electronics,
        const TrialDevice& held, const DeviceArm& arm);
    std::unique_ptr<subject::HandModel> hand;
    device::VirtualDevice device;
    DeviceArm arm;
  };
  class Participant;
  std::function<LeftDecision::Answer(const LeftDecision::DecisionRequest&)> decide_;
  std::unique_ptr<LeftDecision> left_;  // before the participant, who uses it
  std::vector<std::unique_ptr<Arm>> arms_;
  std::unique_ptr<Participant> participant_;
};

}  // namespace haptrial::protocols
