#pragma once

#include <string>
#include <vector>

#include "analysis/bone_drilling/phases/phase_model.h"
#include "core/base/random.h"

namespace haptrial::test {

/// Actions in three phases, which differ in depth, force and tool; `apart` of 1 makes them hard to
/// mistake, 0 all alike. Each action has 1000 ticks. The phase of each is known.
inline analysis::drilling::PhaseCase made_case(const std::string& participant, double apart,
                                               RandomStream& random) {
  using namespace analysis::drilling;
  PhaseCase made;
  made.participant = participant;
  int phase = 0;
  for (std::size_t n = 0; n < 60; ++n) {
    phase = random.uniform() < 0.9 ? phase : (phase + 1) % 3;
    Action action;
    action.first = 1000 * n;
    action.last = 1000 * n + 999;
    action.word(ActionWord::kTool) =
        phase == 2 && random.uniform() < 0.9 * apart ? "diamond at work" : "cutting at work";
    action.word(ActionWord::kStructure) = random.uniform() < 0.5 ? "none" : "facial nerve";
    action.word(ActionWord::kView) = random.uniform() < 0.8 ? "still" : "moved";
    action.number(ActionNumber::kDepth) = 4.0 * apart * phase + random.normal();
    action.number(ActionNumber::kClearance) = 6.0 - apart * phase + random.normal();
    action.number(ActionNumber::kForce) = random.normal();
    action.number(ActionNumber::kSpeed) = 3.0 + random.normal();
    action.number(ActionNumber::kSeen) = 4.0;  // nobody zoomed
    made.actions.push_back(action);
    made.phase.push_back(phase);
  }
  return made;
}

inline std::vector<analysis::drilling::PhaseCase> made_cases(double apart, std::uint64_t seed,
                                                             int people = 6) {
  RandomStream random(seed, "made actions");
  std::vector<analysis::drilling::PhaseCase> cases;
  for (int n = 1; n <= people; ++n) {
    cases.push_back(made_case("P0" + std::to_string(n), apart, random));
  }
  return cases;
}

}  // namespace haptrial::test
