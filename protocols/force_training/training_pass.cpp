#include "protocols/force_training/training_pass.h"

#include <algorithm>
#include <stdexcept>

namespace haptrial::protocols {
namespace {

using stimulus::Instruction;

struct TrainingCondition {
  const char* name;
  PassKind kind;
};

// Source: Morris 2006, §4.2.4 for the first three, and §3.4.1 for the playback.
constexpr TrainingCondition kConditions[] = {
    // The device pushes the hand up with the target force, and the participant keeps the device in
    // the plane by opposing it. No picture of the force.
    {"haptic", {Instruction::kHoldPlane, RunLead::kGuided, false}},
    {"visual", {Instruction::kWatch, RunLead::kGuided, true, true, true}},
    {"visuohaptic", {Instruction::kMatch, RunLead::kGuided, true, true, true, true}},
    // The hand rests at the start; the marker moves along the path as the expert's tool does, and
    // the bar shows how hard the expert presses.
    {kWatching, {Instruction::kWatch, RunLead::kWatched, true, true, true}},
    // The hand is led along the path by the expert's, with the expert's forces
    // (tutoring::tutoring_force). Nothing is seen of either unless it is watched as well.
    {kPlayback, {Instruction::kFollow, RunLead::kPlayed, false, false}},
    {kWatchedPlayback, {Instruction::kFollow, RunLead::kPlayed, false, true, true}},
};

}  // namespace

const std::vector<std::string>& training_conditions() {
  static const std::vector<std::string> conditions = [] {
    std::vector<std::string> names;
    for (const TrainingCondition& condition : kConditions) {
      names.emplace_back(condition.name);
    }
    return names;
  }();
  return conditions;
}

bool has_expert(const std::string& condition) {
  return condition == kWatching || condition == kPlayback || condition == kWatchedPlayback;
}

std::unique_ptr<TrajectoryPass> make_training_pass(const std::string& condition,
                                                   const stimulus::Stimulus& stimulus,
                                                   const GuidanceParameters& parameters,
                                                   std::int32_t block) {
  const auto* known = std::ranges::find(kConditions, condition, &TrainingCondition::name);
  if (known == std::end(kConditions)) {
    throw std::invalid_argument("no training condition '" + condition + "'");
  }
  return std::make_unique<TrajectoryPass>(known->kind, stimulus, parameters, block);
}

}  // namespace haptrial::protocols
