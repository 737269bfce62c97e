#include "protocols/force_training/guided_passes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/base/error.h"
#include "core/control/minimum_jerk.h"
#include "protocols/force_training/recorded_pass.h"
#include "protocols/force_training/training_pass.h"

namespace haptrial::protocols {

using record::Phase;
using record::Stage;

namespace {

/// A hand that is where the pass wants it on the tick after the one that it saw.
class PerfectHand {
 public:
  PerfectHand(const stimulus::Stimulus& stimulus, const GuidanceParameters& guidance, bool stays)
      : path_(stimulus.path), speed_(guidance.approach_speed), stays_(stays) {
    hand_.position = path_.points().front();
  }

  const PointState& state() const { return hand_; }
  /// @param stage  of the tick that is over
  void go_on(Stage stage, double dt) {
    time_ = stage == stage_ ? time_ + dt : dt;
    if (stage == Stage::kReturn && stage_ != stage) {
      back_ = control::MinimumJerkMove(hand_.position, path_.points().front(), speed_);
    }
    stage_ = stage;
    if (stage == Stage::kRun && !stays_) {
      hand_ = path_.at(std::min(time_, path_.duration()));
    } else if (stage == Stage::kReturn) {
      hand_ = back_.at(time_);
    } else {
      hand_ = {path_.points().front(), Eigen::Vector3d::Zero()};
    }
  }

 private:
  const stimulus::SpatialTrajectory& path_;
  double speed_;  // on the way back [m/s]
  bool stays_;    // at the start, while an expert is seen
  PointState hand_;
  Stage stage_{Stage::kIdle};
  double time_{0.0};  // in the stage [s]
  control::MinimumJerkMove back_;
};

device::DeviceReading reading_of(const PointState& hand) {
  device::DeviceReading reading;
  reading.tool = hand;
  return reading;
}

class PassRunner {
 public:
  PassRunner(const ForceDefinition& d, const PlannedTrial& plan, const stimulus::Stimulus& stimulus,
             Phase phase)
      : pass_(make_pass(plan.condition, phase, stimulus, d.guidance, plan.block)),
        hand_(stimulus, d.guidance, phase == Phase::kTraining && plan.condition == kWatching),
        dt_(1.0 / d.rate) {
    pass_->begin(0);
  }

  bool runs() const { return pass_->state() == PassState::kRunning; }
  bool completed() const { return pass_->state() == PassState::kCompleted; }
  GuidedTick tick(const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) {
    PointState hand = hand_.state();
    hand.position += offset;
    const PassOutput out = pass_->tick(reading_of(hand), dt_);
    hand_.go_on(out.stage, dt_);
    return {out.stage, hand, out.force, out.target_force, stimulus::presentation_of(out.shown)};
  }

 private:
  std::unique_ptr<TrajectoryPass> pass_;
  PerfectHand hand_;
  double dt_;
};

/// Longest pass that is gone through; a hand that follows the path needs a small part of it [s].
constexpr double kLongest = 300.0;

GuidedPass guided_pass(const ForceDefinition& d, const GuidedTrial& trial, Phase phase) {
  PassRunner runner(d, trial.plan, trial.stimulus, phase);
  GuidedPass pass{phase, {}, false};
  while (runner.runs() && static_cast<double>(pass.ticks.size()) < kLongest * d.rate) {
    pass.ticks.push_back(runner.tick());
  }
  pass.completed = runner.completed();
  return pass;
}

/// The force on the first tick on which the hand is off the path, in a pass of its own.
Eigen::Vector3d force_aside(const ForceDefinition& d, const GuidedTrial& trial,
                            const Eigen::Vector3d& offset) {
  constexpr double kIntoRun = 0.1;  // [s]
  PassRunner runner(d, trial.plan, trial.stimulus, trial.passes.front().phase);
  int left = static_cast<int>(kIntoRun * d.rate);
  while (left > 0 && runner.runs()) {
    left -= runner.tick().stage == Stage::kRun ? 1 : 0;
  }
  return runner.tick(offset).force;
}

std::vector<ForceAside> forces_aside(const ForceDefinition& d, const GuidedTrial& trial) {
  constexpr int kSteps = 10;  // to either side
  // Twice as far as the weakest spring needs to reach the limit, so that the limit is seen.
  const double softest =
      std::max(1.0, std::min(d.guidance.trajectory.stiffness, d.guidance.plane.stiffness));
  const double far = std::min(0.03, 1.5 * d.guidance.force_limit / softest);
  std::vector<ForceAside> all;
  for (int axis = 0; axis < 3; ++axis) {
    ForceAside aside{axis, {}, {}};
    for (int i = -kSteps; i <= kSteps; ++i) {
      aside.offsets.push_back(far * i / kSteps);
      aside.forces.push_back(
          force_aside(d, trial, aside.offsets.back() * Eigen::Vector3d::Unit(axis)));
    }
    all.push_back(std::move(aside));
  }
  return all;
}

}  // namespace

double GuidedPass::lasts(Stage stage, double rate) const {
  return static_cast<double>(std::ranges::count(ticks, stage, &GuidedTick::stage)) / rate;
}

const GuidedTick* GuidedPass::middle_of(Stage stage) const {
  const auto count = std::ranges::count(ticks, stage, &GuidedTick::stage);
  const auto first = std::ranges::find(ticks, stage, &GuidedTick::stage);
  return count == 0 ? nullptr : &*(first + count / 2);
}

std::span<const Phase> passes_of(const ForceDefinition& d, int session) {
  static constexpr std::array kPhases{Phase::kTraining, Phase::kTest};
  const std::span all(kPhases);
  return d.session_plan(session).gives ? all : all.last(1);
}

std::vector<PlannedTrial> planned_trials_of(const ForceDefinition& d, const SessionPlace& place) {
  return plan_trials(d.design_of(place.session, place.participant), place.participant, place.seed,
                     place.person_seed);
}

GuidedTrial guided_trial(const ForceDefinition& d, const SessionPlace& place, int number) {
  const std::vector<PlannedTrial> plan = planned_trials_of(d, place);
  const auto most = static_cast<int>(plan.size());
  if (number < 1 || number > most) {
    throw InputError(
        fmt::format("--trial is {}; allowed: 1 to {}, the trials of a session of {} with those of "
                    "practice",
                    number, most, d.file_name));
  }
  const PlannedTrial& trial = plan[static_cast<std::size_t>(number - 1)];
  GuidedTrial guided{
      most, trial, stimulus::make_stimulus(d.trajectory, d.force_pattern, trial.stimulus_seed), {}};
  for (const Phase& phase : passes_of(d, place.session)) {
    guided.passes.push_back(guided_pass(d, guided, phase));
  }
  guided.aside = forces_aside(d, guided);
  return guided;
}

}  // namespace haptrial::protocols
