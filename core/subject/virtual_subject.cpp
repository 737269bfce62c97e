#include "core/subject/virtual_subject.h"

#include <algorithm>
#include <cmath>

namespace haptrial::subject {

using stimulus::Instruction;
using stimulus::Presentation;

namespace {
constexpr double kHomeStiffness = 100.0;  // [N/m]
constexpr double kSpeedSpan = 0.05;       // over which one's own speed is felt [s]
}  // namespace

VirtualSubject::VirtualSubject(const SubjectParameters& person,
                               const HandParameters& hand_parameters, HandModel& hand,
                               std::uint64_t seed, double step,
                               const std::optional<PaceParameters>& pace,
                               const std::optional<PathParameters>& path)
    : person_(person),
      hand_(hand),
      step_(step),
      muscle_lag_(hand_parameters.excitation_time + hand_parameters.activation_time),
      random_(seed, "mind"),
      motor_(person, step, RandomStream(seed, "motor")),
      bar_(person, random_) {
  if (pace) {
    pacer_.emplace(*pace, hand_parameters, RandomStream(seed, "pace"), step);
  }
  if (path) {
    path_.emplace(*path, hand_parameters, RandomStream(seed, "path"));
  }
}

void VirtualSubject::observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
                             double dt) noexcept {
  const Presentation seen = stimulus::presentation_of(shown);
  Sensed now;
  now.height = seen.show_target_bar ? seen.target_force : 0.0;
  now.mismatch = seen.show_applied_bar ? seen.target_force - seen.applied_force : 0.0;
  now.felt = forces[0].y();
  now.hand = seen.tool;
  now.progress = seen.progress;
  now.saturated = seen.show_saturation;
  past_[++now_ % kDelayLine] = now;

  // Before the first step along the path its progress is 0 still, but it is one's turn.
  const bool running = (seen.progress > 0.0 || seen.self_paced) && seen.progress < 1.0;
  if (running && !in_run_) {
    begin_pass(seen);
  }
  if (running) {
    gather(seen, now);
  } else if (in_run_) {
    end_pass();
  }
  in_run_ = running;

  HandCommand command;
  command.press = running ? motor_.press(hold_back(intended_press(seen, dt), dt)) : 0.0;
  const bool led = seen.instruction == Instruction::kFollow;
  command.holds_posture = running && (led || seen.instruction == Instruction::kHoldPlane);
  command.force = motor_.tremor();
  if (running && seen.self_paced && pacer_) {
    command.force += move_on(seen);
  }
  if (running && seen.instruction == Instruction::kReproduce && path_) {
    const double shift = (muscle_lag_ + wrong_in_time(seen.progress)) / pass_duration_;
    command.force += path_->drive(seen.progress + shift, seen.tool);
  }
  if (!seen.show_trajectory && !seen.engaged()) {  // nobody guides the hand: it rests in the middle
    command.force -= kHomeStiffness * seen.tool;
  }
  hand_.command(command);
}

void VirtualSubject::begin_pass(const Presentation& seen) noexcept {
  pass_duration_ = seen.pass_duration;
  if (seen.block != block_) {
    begin_block(seen.block);
  } else if (path_) {
    path_->begin(pass_duration_, false);
  }
  forget();
  exposure_.clear();
  correction_ = 0.0;
  boldness_ = 1.0;
  produced_scale_ = std::exp(person_.production_bias * random_.normal());
  if (pacer_) {
    pacer_->begin();
  }
  const double knot_time = pass_duration_ / ForceProfile::kKnots;
  SmoothNoise timing(knot_time, person_.timing_correlation);
  timing.restart(random_);
  for (double& shift : warp_) {
    shift = person_.timing_error * timing.next(random_);
  }
}

void VirtualSubject::begin_block(std::int32_t block) noexcept {
  block_ = block;
  memory_.clear();
  bar_.relax(person_.calibration_loss);
  if (path_) {
    path_->begin(pass_duration_, true);
  }
  for (const Lesson& lesson : lessons_) {
    if (lesson.block == block) {
      go_through(lesson);
    }
  }
}

void VirtualSubject::go_through(const Lesson& lesson) noexcept {
  for (int exposure = 0; exposure < lesson.exposures; ++exposure) {
    exposure_.clear();
    for (const LessonMoment& moment : lesson.moments) {
      Sensed sensed;
      sensed.height = moment.view.show_target_bar ? moment.view.target_force : 0.0;
      sensed.felt = moment.force;
      gather(moment.view, sensed);
    }
    end_pass();
    forget();
    if (path_) {
      path_->begin(pass_duration_, false);
    }
  }
  for (int session = 0; session < lesson.sessions_ago; ++session) {
    forget();
  }
}

void VirtualSubject::forget() noexcept {
  memory_.drift(person_.forgetting, person_.memory_correlation / pass_duration_, random_);
}

void VirtualSubject::gather(const Presentation& seen, const Sensed& now) noexcept {
  const bool led = seen.instruction == Instruction::kFollow;
  const bool felt_teaches =
      led || seen.instruction == Instruction::kHoldPlane || seen.instruction == Instruction::kMatch;
  if (path_ && seen.instruction != Instruction::kReproduce) {
    path_->take(seen.progress, seen.tool, seen.show_trajectory, led);
  }
  if (seen.show_target_bar) {
    exposure_.see(seen.progress, now.height);
  }
  if (felt_teaches) {
    exposure_.feel(seen.progress, now.felt, now.mismatch);
  }
}

void VirtualSubject::end_pass() noexcept {
  if (!exposure_.empty()) {
    memory_.learn(
        exposure_.perceived(person_, bar_, person_.memory_correlation / pass_duration_, random_));
    exposure_.clear();
  }
  if (path_) {
    path_->end();
  }
}

double VirtualSubject::intended_press(const Presentation& seen, double dt) noexcept {
  switch (seen.instruction) {
    case Instruction::kHoldPlane:
    case Instruction::kFollow:
      return oppose();
    case Instruction::kMatch:
      return match_bars(dt);
    case Instruction::kRecall:
    case Instruction::kReproduce:
      return recall(seen);
    case Instruction::kRest:
    case Instruction::kWatch:
      break;
  }
  return 0.0;
}

double VirtualSubject::oppose() const noexcept {
  // Force that is felt, and a push back to the plane. With the delay of the senses the push must
  // stay below the posture's own stiffness, or it would oscillate.
  constexpr double kPushBack = 100.0;  // [N/m]
  const Sensed& sensed = delayed(person_.haptic_delay);
  return sensed.felt + kPushBack * sensed.hand.y();
}

double VirtualSubject::hold_back(double press, double dt) noexcept {
  // A handle whose device saturates gives way: the hand eases off at once and takes its time to
  // trust again. Shares of the intended press per second.
  constexpr double kEaseOff = 5.0;
  constexpr double kTrust = 1.0;
  const bool gives_way = delayed(person_.haptic_delay).saturated;
  boldness_ = std::clamp(boldness_ + (gives_way ? -kEaseOff : kTrust) * dt, 0.0, 1.0);
  return boldness_ * press;
}

double VirtualSubject::match_bars(double dt) noexcept {
  // Follows the target bar ahead by its own delay, and removes what the bars still show; much
  // faster than this, a delay of 0.2 s would make the hand oscillate.
  constexpr double kCorrectionTime = 0.5;  // [s]
  constexpr double kSlopeSpan = 0.1;       // over which the bar's speed is seen [s]
  constexpr double kFurthest = 3.0;        // nobody expects a bar to grow on without end [N]
  const Sensed& seen = delayed(person_.visual_delay);
  const Sensed& before = delayed(person_.visual_delay + kSlopeSpan);
  const double lead = person_.visual_delay + muscle_lag_ + 0.5 * kSlopeSpan;
  const double rise = lead * (seen.height - before.height) / kSlopeSpan;
  const double ahead = seen.height + std::clamp(rise, -kFurthest, kFurthest);
  const double gain = bar_.gain();
  if (boldness_ == 1.0) {  // what is held back on purpose is no error
    correction_ += gain * seen.mismatch * dt / kCorrectionTime;
  }
  return std::max(0.0, gain * ahead + correction_);
}

double VirtualSubject::wrong_in_time(double progress) const noexcept {
  const double u =
      std::clamp(progress * ForceProfile::kKnots - 0.5, 0.0, ForceProfile::kKnots - 1.0);
  return warp_[static_cast<int>(u)];
}

double VirtualSubject::recall(const Presentation& seen) const noexcept {
  const double error = wrong_in_time(seen.progress);
  double ahead = (muscle_lag_ + error) / pass_duration_;
  if (seen.self_paced) {
    // How far the hand comes within the muscle's lag follows from its own speed; what is wrong with
    // the memory of places is as much of the path as it is of the time that is set.
    const double rate = (seen.progress - delayed(kSpeedSpan).progress) / kSpeedSpan;
    ahead = muscle_lag_ * rate + error / pass_duration_;
  }
  return std::max(0.0, produced_scale_ * memory_.at(seen.progress + ahead));
}

Eigen::Vector3d VirtualSubject::move_on(const Presentation& seen) noexcept {
  const Sensed& felt = delayed(person_.haptic_delay);
  const Sensed& before = delayed(person_.haptic_delay + kSpeedSpan);
  const double speed = (felt.hand - before.hand).dot(seen.direction) / kSpeedSpan;
  return pacer_->drive(seen.direction, speed);
}

const VirtualSubject::Sensed& VirtualSubject::delayed(double delay) const noexcept {
  const auto ticks = static_cast<std::uint32_t>(std::min(delay / step_, kDelayLine - 1.0));
  return past_[(now_ - ticks) % kDelayLine];
}

}  // namespace haptrial::subject
