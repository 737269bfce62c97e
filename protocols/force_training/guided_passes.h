#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/point_state.h"
#include "core/stimulus/presentation.h"
#include "core/stimulus/stimulus.h"
#include "protocols/force_training/force_definition.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// One tick of a pass whose hand is where the pass wants it.
struct GuidedTick {
  record::Stage stage{record::Stage::kIdle};
  PointState hand;                                 // in W [m], [m/s]
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // on the hand, in W [N]
  double target_force{0.0};                        // [N]
  stimulus::Presentation seen;
};

/// One pass of a trial, tick by tick, as a perfect hand goes through it.
struct GuidedPass {
  record::Phase phase;
  std::vector<GuidedTick> ticks;
  bool completed{false};

  double lasts(record::Stage stage, double rate) const;  // [s]
  /// The middle one of the ticks of a stage; null without any.
  const GuidedTick* middle_of(record::Stage stage) const;
};

/// Force of the guidance on a hand that is beside the path, by how far.
struct ForceAside {
  int axis{0};                          // 0, 1, 2: x, y, z
  std::vector<double> offsets;          // ascending [m]
  std::vector<Eigen::Vector3d> forces;  // (offsets) [N]
};

/// A trial of a session before anybody runs it.
struct GuidedTrial {
  int most{1};  // trials of the session, practice included
  PlannedTrial plan;
  stimulus::Stimulus stimulus;
  std::vector<GuidedPass> passes;   // those of the session: training and test, or the test alone
  std::vector<ForceAside> aside{};  // of the first pass's run, shortly after it has begun
};

/// Runs the passes of a trial with a hand that waits at the start, follows the path exactly, and
/// goes back at the guide's speed. The forces are those that the pass itself returns.
/// @param definition, place  of the session
/// @param number  of the trial in the session, practice included, from 1
/// @throws InputError for a number beyond the session
GuidedTrial guided_trial(const ForceDefinition& definition, const SessionPlace& place, int number);

/// The passes of each trial of a session, in their order: one that gives nothing only tests.
std::span<const record::Phase> passes_of(const ForceDefinition& definition, int session);

/// The planned trials of a session, practice first.
std::vector<PlannedTrial> planned_trials_of(const ForceDefinition& definition,
                                            const SessionPlace& place);

}  // namespace haptrial::protocols
