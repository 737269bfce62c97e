#include "protocols/psychophysics/definition/stage_machine.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>
#include <utility>

#include "core/scene/scene.h"
#include "protocols/psychophysics/definition/measurement.h"

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

/// Whether the bits name no more than `count` things.
bool are_indices(std::uint64_t bits, std::size_t count) {
  return count >= 64 || bits >> count == 0;
}

/// The lowest bit of a mask that is not 0, which is taken out.
std::size_t take_lowest(std::uint64_t& bits) noexcept {
  const auto lowest = static_cast<std::size_t>(std::countr_zero(bits));
  bits &= bits - 1;
  return lowest;
}

double fastest(std::span<const device::DeviceReading> readings) noexcept {
  double speed = 0.0;
  for (const device::DeviceReading& reading : readings) {
    speed = std::max(speed, reading.tool.velocity.norm());
  }
  return speed;
}

void check_stage(const Stage& stage, std::size_t number, std::size_t regions, std::size_t fields) {
  check_that(are_indices(stage.until.inside, regions), number, "its region is not there");
  check_that(are_indices(stage.until.contact, fields), number, "the field to touch is not there");
  check_that(stage.until.time >= 0.0 && stage.until.hold >= 0.0, number,
             "its times must be 0 or more");
  check_that(stage.timeout > 0.0, number, "its timeout must be above 0");
  if (stage.require) {
    const bool whole =
        stage.require->of == Requirement::Quantity::kSpeed || stage.require->measure >= 0;
    check_that(whole || (stage.require->field >= 0 && is_index(stage.require->field, fields)),
               number, "the field of its requirement is not there");
  }
}

}  // namespace

StageMachine::StageMachine(std::vector<Stage> stages, std::vector<StageRegion> regions,
                           std::size_t fields, std::vector<std::uint64_t> felt)
    : stages_(std::move(stages)),
      regions_(std::move(regions)),
      felt_(std::move(felt)),
      times_(stages_.size()) {
  if (stages_.empty()) {
    throw std::invalid_argument("StageMachine: there must be a stage");
  }
  for (const StageRegion& region : regions_) {
    if (region.device >= felt_.size()) {
      throw std::invalid_argument("StageMachine: a region is of a device that is not there");
    }
  }
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    check_stage(stages_[k], k, regions_.size(), fields);
  }
}

void StageMachine::begin(Scenes scenes, int most_repeats) noexcept {
  std::fill(times_.begin(), times_.end(), StageTimes{});
  state_ = State::kRunning;
  tick_ = 0;
  repeats_ = 0;
  most_repeats_ = most_repeats;
  hands_known_ = false;
  enter(0, scenes);
}

void StageMachine::enter(std::size_t stage, Scenes scenes) noexcept {
  stage_ = stage;
  times_[stage] = {};
  times_[stage].begin = tick_;
  in_stage_ = 0.0;
  held_ = -1.0;
  buttons_pressed_ = keys_pressed_ = 0;
  for (std::size_t device = 0; device < scenes.size(); ++device) {
    const std::uint64_t fields = stages_[stage].fields & felt_[device];
    if (stage == 0) {  // of an interval, or of its repetition
      scenes[device].restart_with(fields);
    } else {
      scenes[device].switch_to(fields);
    }
    scenes[device].forget_extremes();
  }
}

void StageMachine::leave(StageEnd how, Consequence what, Scenes scenes) noexcept {
  times_[stage_].end = tick_;
  times_[stage_].how = how;
  if (what == Consequence::kRepeat && repeats_ < most_repeats_) {
    ++repeats_;
    ++tick_;
    enter(0, scenes);
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
  enter(stage_ + 1, scenes);
}

void StageMachine::press(Readings readings) noexcept {
  std::uint32_t buttons = 0;
  std::uint32_t keys = 0;
  for (const device::DeviceReading& reading : readings) {
    buttons |= reading.buttons;
    keys |= reading.keys;
  }
  if (hands_known_) {
    buttons_pressed_ |= buttons & ~buttons_before_;
    keys_pressed_ |= keys & ~keys_before_;
  }
  buttons_before_ = buttons;
  keys_before_ = keys;
  hands_known_ = true;
}

/// The first region that its tool is not in, which "until inside" waits for.
StageMachine::MissedRegion StageMachine::first_outside(std::uint64_t regions,
                                                       Readings readings) const noexcept {
  while (regions != 0) {
    const std::size_t index = take_lowest(regions);
    const StageRegion& region = regions_[index];
    const Eigen::Vector3d& tip = region.of_cursor ? cursor_ : readings[region.device].tool.position;
    if (!region.shape.contains(tip)) {
      return {static_cast<int>(index), region.shape.distance(tip).distance};
    }
  }
  return {};
}

bool StageMachine::all_touch(std::uint64_t fields, Scenes scenes) const noexcept {
  while (fields != 0) {
    const std::size_t field = take_lowest(fields);
    for (std::size_t device = 0; device < scenes.size(); ++device) {
      const bool feels = (felt_[device] >> field & 1) != 0;
      if (feels && !scenes[device].state(field).contact) {
        return false;
      }
    }
  }
  return true;
}

/// Whether a channel's value is as asked; one that is not there never is. A value that need not
/// hold may be any of those that have come since the tick before.
bool StageMachine::measures(const Until& until, Readings readings) const noexcept {
  if (!until.channel) {
    return true;
  }
  const std::span<const double> values = readings.front().channels;
  const auto fits = [&](double value) { return value > until.above && value < until.below; };
  if (*until.channel < values.size() && fits(values[*until.channel])) {
    return true;
  }
  return until.hold <= 0.0 && std::ranges::any_of(readings.front().arrived, [&](const auto& each) {
           return each.place == *until.channel && each.age <= in_stage_ && fits(each.value);
         });
}

bool StageMachine::holds(const Until& until, Readings readings, Scenes scenes,
                         double speed) const noexcept {
  return first_outside(until.inside, readings).region < 0 && all_touch(until.contact, scenes) &&
         speed < until.speed_below && speed > until.speed_above &&
         (until.buttons == 0 || (until.buttons & buttons_pressed_) != 0) &&
         (until.keys == 0 || (until.keys & keys_pressed_) != 0) && measures(until, readings);
}

void StageMachine::measure(const Stage& stage, double speed, Scenes scenes) noexcept {
  StageTimes& times = times_[stage_];
  if (times.onset < 0 && speed > stage.onset_speed) {
    times.onset = tick_;
  }
  if (!stage.require || stage.require->measure >= 0) {
    return;
  }
  if (stage.require->of == Requirement::Quantity::kSpeed) {
    times.most = std::max(times.most, speed);
    return;
  }
  for (const scene::Scene& scene : scenes) {
    const scene::FieldState& felt = scene.state(static_cast<std::size_t>(stage.require->field));
    const bool depth = stage.require->of == Requirement::Quantity::kDepth;
    times.most = std::max(times.most, depth ? felt.depth : felt.force.norm());
  }
}

/// Whether what the stage requires was done. A measure without a value is not.
bool StageMachine::is_enough(const Stage& stage,
                             std::span<const Measurement> measurements) noexcept {
  if (!stage.require) {
    return true;
  }
  const auto measure = static_cast<std::size_t>(stage.require->measure);
  if (stage.require->measure >= 0 && measure < measurements.size()) {
    times_[stage_].most = measurements[measure].value();
  }
  return stage.require->holds(times_[stage_].most);
}

void StageMachine::tick(Readings readings, Scenes scenes, double dt, const Eigen::Vector3d& cursor,
                        std::span<const Measurement> measurements) noexcept {
  if (state_ != State::kRunning) {
    return;
  }
  cursor_ = cursor;
  const Stage& stage = stages_[stage_];
  const double speed = fastest(readings);
  press(readings);
  measure(stage, speed, scenes);
  in_stage_ += dt;
  const bool now =
      in_stage_ >= stage.until.time - kRounding && holds(stage.until, readings, scenes, speed);
  held_ = now ? std::max(held_, 0.0) + (held_ < 0.0 ? 0.0 : dt) : -1.0;
  if (now && held_ >= stage.until.hold - kRounding) {
    const bool enough = is_enough(stage, measurements);
    leave(enough ? StageEnd::kReached : StageEnd::kTooLittle,
          enough ? Consequence::kGoOn : stage.require->otherwise, scenes);
  } else if (in_stage_ >= stage.timeout - kRounding) {
    outside_ = first_outside(stage.until.inside, readings);
    leave(StageEnd::kLate, stage.late, scenes);
  } else {
    ++tick_;
  }
}

}  // namespace haptrial::protocols
