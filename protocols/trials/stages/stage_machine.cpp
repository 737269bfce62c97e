#include "protocols/trials/stages/stage_machine.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/scene/scene.h"

namespace haptrial::protocols {
namespace {

// Sums of periods come out a rounding below what a definition asks for.
constexpr double kRounding = 1e-9;  // [s]

void check_that(bool good, std::size_t stage, const char* sentence) {
  if (!good) {
    throw std::invalid_argument("stage " + std::to_string(stage + 1) + ": " + sentence);
  }
}

bool is_index(int index, std::size_t count) { return index < 0 || std::cmp_less(index, count); }

void check_stage(const Stage& stage, std::size_t number, std::size_t regions, std::size_t fields) {
  check_that(is_index(stage.until.inside, regions), number, "its region is not there");
  check_that(is_index(stage.until.contact, fields), number, "the field to touch is not there");
  check_that(stage.until.time >= 0.0 && stage.until.hold >= 0.0, number,
             "its times must be 0 or more");
  check_that(stage.timeout > 0.0, number, "its timeout must be above 0");
  if (stage.require) {
    const bool speed = stage.require->of == Requirement::Of::kSpeed;
    check_that(speed || (stage.require->field >= 0 && is_index(stage.require->field, fields)),
               number, "the field of its requirement is not there");
  }
}

}  // namespace

StageMachine::StageMachine(std::vector<Stage> stages, std::vector<scene::PlacedShape> regions,
                           std::size_t fields)
    : stages_(std::move(stages)), regions_(std::move(regions)), times_(stages_.size()) {
  if (stages_.empty()) {
    throw std::invalid_argument("StageMachine: there must be a stage");
  }
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    check_stage(stages_[k], k, regions_.size(), fields);
  }
}

void StageMachine::begin(scene::Scene& scene, int most_repeats) noexcept {
  std::fill(times_.begin(), times_.end(), StageTimes{});
  state_ = State::kRunning;
  tick_ = 0;
  repeats_ = 0;
  most_repeats_ = most_repeats;
  hands_known_ = false;
  enter(0, scene);
}

void StageMachine::enter(std::size_t stage, scene::Scene& scene) noexcept {
  stage_ = stage;
  times_[stage] = {};
  times_[stage].begin = tick_;
  in_stage_ = 0.0;
  held_ = -1.0;
  buttons_pressed_ = keys_pressed_ = 0;
  scene.switch_to(stages_[stage].fields);
  scene.forget_extremes();
}

void StageMachine::leave(StageEnd how, Consequence what, scene::Scene& scene) noexcept {
  times_[stage_].end = tick_;
  times_[stage_].how = how;
  if (what == Consequence::kRepeat && repeats_ < most_repeats_) {
    ++repeats_;
    ++tick_;
    enter(0, scene);
    return;
  }
  if (what != Consequence::kGoOn) {
    state_ = State::kAborted;
    return;
  }
  if (stage_ + 1 == stages_.size()) {
    state_ = State::kDone;
    return;
  }
  ++tick_;
  enter(stage_ + 1, scene);
}

void StageMachine::press(const device::DeviceReading& reading) noexcept {
  if (hands_known_) {
    buttons_pressed_ |= reading.buttons & ~buttons_before_;
    keys_pressed_ |= reading.keys & ~keys_before_;
  }
  buttons_before_ = reading.buttons;
  keys_before_ = reading.keys;
  hands_known_ = true;
}

bool StageMachine::holds(const Until& until, const device::DeviceReading& reading,
                         const scene::Scene& scene) const noexcept {
  const double speed = reading.tool.velocity.norm();
  const auto inside = [&] {
    return regions_[static_cast<std::size_t>(until.inside)].contains(reading.tool.position);
  };
  return (until.inside < 0 || inside()) &&
         (until.contact < 0 || scene.state(static_cast<std::size_t>(until.contact)).contact) &&
         speed < until.speed_below && speed > until.speed_above &&
         (until.buttons == 0 || (until.buttons & buttons_pressed_) != 0) &&
         (until.keys == 0 || (until.keys & keys_pressed_) != 0);
}

void StageMachine::measure(const Stage& stage, double speed, const scene::Scene& scene) noexcept {
  StageTimes& times = times_[stage_];
  if (times.onset < 0 && speed > stage.onset_speed) {
    times.onset = tick_;
  }
  if (!stage.require) {
    return;
  }
  double value = speed;
  if (stage.require->of != Requirement::Of::kSpeed) {
    const scene::FieldState& felt = scene.state(static_cast<std::size_t>(stage.require->field));
    value = stage.require->of == Requirement::Of::kDepth ? felt.depth : felt.force.norm();
  }
  times.most = std::max(times.most, value);
}

void StageMachine::tick(const device::DeviceReading& reading, scene::Scene& scene,
                        double dt) noexcept {
  if (state_ != State::kRunning) {
    return;
  }
  const Stage& stage = stages_[stage_];
  press(reading);
  measure(stage, reading.tool.velocity.norm(), scene);
  in_stage_ += dt;
  const bool now = holds(stage.until, reading, scene);
  held_ = now ? std::max(held_, 0.0) + (held_ < 0.0 ? 0.0 : dt) : -1.0;
  const bool reached =
      now && held_ >= stage.until.hold - kRounding && in_stage_ >= stage.until.time - kRounding;
  if (reached) {
    const bool enough = !stage.require || times_[stage_].most >= stage.require->at_least;
    leave(enough ? StageEnd::kReached : StageEnd::kTooLittle,
          enough ? Consequence::kGoOn : stage.require->otherwise, scene);
  } else if (in_stage_ >= stage.timeout - kRounding) {
    leave(StageEnd::kLate, stage.late, scene);
  } else {
    ++tick_;
  }
}

}  // namespace haptrial::protocols
