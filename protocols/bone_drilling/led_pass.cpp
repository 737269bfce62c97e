#include "protocols/bone_drilling/led_pass.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/control/pd_controller.h"

namespace haptrial::protocols {
namespace {

/// Steps on a tick at most, where the bone has to catch up: a step takes about 80 us.
constexpr int kMostSteps = 4;
/// How long the hand feels what it felt last while a part is separated [ticks].
constexpr std::uint64_t kStillFelt = 20;

}  // namespace

LedPass::LedPass(const Parts& parts)
    : p_(parts),
      input_(parts.parameters),
      rows_(parts.simulator, parts.logs, parts.rate),
      touch_(parts.simulator),
      tool_(parts.simulator.output().tool),
      split_(parts.shared.step_is_done() ? Split::kDone : Split::kNone) {
  p_.shared.set_step_is_done(false);
  if (p_.real) {
    separator_ = std::thread([this] {
      while (!stop_.load(std::memory_order_relaxed)) {
        if (split_.load(std::memory_order_acquire) == Split::kAsked) {
          separate();
          split_.store(Split::kDone, std::memory_order_release);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
  }
}

LedPass::~LedPass() { rest(); }

void LedPass::rest() {
  stop_.store(true, std::memory_order_relaxed);
  if (separator_.joinable()) {
    separator_.join();
    p_.shared.set_step_is_done(split_.load(std::memory_order_relaxed) == Split::kDone);
  }
}

PassState LedPass::state() const noexcept {
  if (!completed_) {
    return outdated_ ? PassState::kAborted : PassState::kRunning;
  }
  return p_.shared.superseded() ? PassState::kAborted : PassState::kCompleted;
}

/// The step that separates parts; it allocates.
void LedPass::separate() {
  std::vector<bone::RecordedSplit> splits;
  for (std::size_t i = 0; i < splits_; ++i) {
    add_split(p_.shared.inbox().at(i), splits);
  }
  p_.simulator.tick(last_, splits);
}

void LedPass::after_step(const BoneStep& step) noexcept {
  p_.companions.after_tick(p_.simulator, last_.dt);
  record::LedRow row;
  row.sequence = sequence_;
  row.step = p_.shared.followed(step, p_.simulator);
  row.begins = std::exchange(first_step_, false);
  row.tool = step.reading.tool;
  row.orientation = step.reading.orientation;
  row.buttons = step.reading.buttons;
  row.keys = step.reading.keys;
  row.pedal = step.reading.pedal;
  p_.logs.led.push(row);
  rows_.log(sequence_, last_.tool.tip.velocity.norm());
  removed_ += p_.simulator.output().removed + p_.simulator.output().cut;
  camera_changed_ = camera_changed_ || p_.simulator.output().camera_changed;
  ++followed_;
  ++ticks_;
}

/// @returns whether another one may follow in this tick
bool LedPass::follow_step() noexcept {
  BoneParcels& inbox = p_.shared.inbox();
  splits_ = 0;
  while (splits_ < inbox.size() && kind_of(inbox.at(splits_)) == BoneParcelKind::kSplit) {
    ++splits_;
  }
  // Bone that is separated on a tick is recorded by the tick: it is the only step of it.
  if (splits_ == inbox.size() || (splits_ > 0 && followed_ > 0)) {
    return false;
  }
  const BoneStep step = step_of(inbox.at(splits_));
  last_ = input_.of(step.reading, 1.0 / p_.rate);
  if (split_.load(std::memory_order_acquire) != Split::kDone) {
    if (first_step_) {
      p_.simulator.begin(last_.functions);
    }
    if (splits_ == 0) {
      p_.simulator.tick(last_);
    } else if (p_.real) {
      split_.store(Split::kAsked, std::memory_order_release);
      return false;
    } else {
      separate();
    }
  }
  split_.store(Split::kNone, std::memory_order_relaxed);
  after_step(step);
  inbox.pop(splits_ + 1);
  return splits_ == 0;
}

bool LedPass::follow_next() noexcept {
  BoneParcels& inbox = p_.shared.inbox();
  if (inbox.size() == 0) {
    return false;
  }
  const BoneParcel& next = inbox.at(0);
  const BoneParcelKind kind = kind_of(next);
  if (kind == BoneParcelKind::kBegin) {
    outdated_ = !p_.shared.reach(begin_of(next));
    if (outdated_) {
      return false;
    }
    pass_reached_ = first_step_ = p_.shared.reached_trial() == p_.trial;
  } else if (p_.shared.reached_trial() != p_.trial) {
    // Left over from a trial that was left: its bone is gone.
  } else if (kind == BoneParcelKind::kEnd) {
    completed_ = pass_reached_;
    if (completed_) {
      p_.shared.reach_end();
    }
  } else {
    return follow_step();
  }
  inbox.pop();
  return !completed_;
}

void LedPass::follow() noexcept {
  followed_ = 0;
  removed_ = 0.0;
  camera_changed_ = false;
  while (followed_ < kMostSteps && follow_next()) {
  }
}

PassOutput LedPass::output(const Readings& readings) noexcept {
  const bone::SimulatorInput own = input_.of(as_recorded(readings[0]), last_.dt);
  const bone::BoneTouch::Felt felt = touch_.tick(p_.simulator, own.tool);
  const Eigen::Vector3d shake =
      shaking(p_.vibration, p_.simulator, felt.contact, felt.force.norm(), own.tool);
  const double share = readings[0].shares.stiffness;
  const Eigen::Vector3d wanted = share * (felt.force + felt.shaft) + shake;
  PassOutput out;
  out.most = p_.parameters.force_limit;
  out.force = control::saturate(wanted, out.most);
  out.intent.push = share * felt.drag + shake;
  out.intent.stimulus = shake;
  const int tool_before = std::exchange(tool_, p_.simulator.output().tool);
  out.goes_over = waited_ > 0 || tool_ != tool_before;
  out.saturated = wanted.norm() > out.most;
  out.stage = record::Stage::kRun;
  bone::DrillingView seen = view_of(p_.simulator, own);
  seen.progress = std::min(
      1.0, static_cast<double>(ticks_) / std::max(1.0, p_.parameters.time_limit * p_.rate));
  seen.time_limit = p_.parameters.time_limit;
  seen.elapsed = seen.progress * seen.time_limit;
  seen.tone = p_.logs.nerve_tone();
  out.shown = seen;
  rows_.log_camera(sequence_, camera_changed_);
  rows_.log_tool(removed_, felt.force);
  rows_.log_handpiece(felt.shaft);
  return out;
}

PassOutput LedPass::tick(const Readings& readings, double /*dt*/) noexcept {
  const bool separates = split_.load(std::memory_order_acquire) == Split::kAsked;
  if (!separates) {
    follow();
  }
  if (split_.load(std::memory_order_acquire) == Split::kAsked) {
    record::ToolRow row;
    row.active = true;
    p_.logs.set_tool(row);
    if (++waited_ > kStillFelt) {
      static_cast<Drive&>(out_) = {};
    }
    out_.goes_over = waited_ == kStillFelt + 1;
  } else {
    if (p_.nerves != nullptr) {
      p_.logs.set_nerves(p_.nerves->step(tool_at_nerves(p_.simulator, last_)));
    }
    out_ = output(readings);
    waited_ = 0;
  }
  out_.shown.tool = readings[0].tool.position;
  ++sequence_;
  return out_;
}

bool LedPass::wants_attention() noexcept {
  const bool wants = p_.logs.led.pushed() - attended_ >= p_.logs.led.capacity() / 4 ||
                     p_.logs.removals.taken() > p_.logs.removals.capacity() / 4;
  attended_ = wants ? p_.logs.led.pushed() : attended_;
  return wants;
}

}  // namespace haptrial::protocols
