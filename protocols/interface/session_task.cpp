#include "protocols/interface/session_task.h"

#include <algorithm>

namespace haptrial::protocols {
namespace {

constexpr double kNoticed = 0.9;                     // share of the damping
constexpr std::int64_t kLongestGap_ns = 50'000'000;  // between ticks

bool begins_stage(const PassOutput& out) noexcept {
  const auto onsets = out.onsets.all();
  return std::any_of(onsets.begin(), onsets.end(), [](const markers::Onset& onset) {
    return onset.what == record::MarkerOf::kStage || onset.what == record::MarkerOf::kInterval;
  });
}

}  // namespace

SessionTask::SessionTask(const Parts& parts, Leave leave, Origin origin)
    : devices_(parts.devices, parts.loop),
      log_(parts.log),
      device_log_(parts.device_log),
      tick_log_(parts.tick_log),
      window_(parts.window),
      pedal_(parts.pedal),
      channels_(parts.channels),
      onsets_(parts.onsets),
      observers_(parts.observers),
      leave_(leave),
      origin_(origin) {}

void SessionTask::start(Pass& pass, std::int32_t row) noexcept {
  result_ = {};  // while idle the servo thread leaves it alone
  asked_row_.store(row, std::memory_order_relaxed);
  busy_.store(true, std::memory_order_relaxed);
  asked_.store(&pass, std::memory_order_release);
}

bool SessionTask::idle() const noexcept { return !busy_.load(std::memory_order_acquire); }

void SessionTask::clear_fault() noexcept { clear_asked_.store(true, std::memory_order_release); }

void SessionTask::emergency_stop() noexcept { stop_asked_.store(true, std::memory_order_release); }

void SessionTask::break_off() noexcept {
  break_row_.store(asked_row_.load(std::memory_order_relaxed), std::memory_order_release);
}

bool SessionTask::at_rest() const noexcept {
  return idle() && force_gone_.load(std::memory_order_acquire);
}

bool SessionTask::stopped() const noexcept {
  return !stop_asked_.load(std::memory_order_acquire) &&
         force_gone_.load(std::memory_order_acquire);
}

/// Takes what comes in beside the devices; an alarm of a channel stops them. A channel that was
/// lost and came back between two passes has disturbed none.
SessionInputs SessionTask::inputs(std::int64_t time_ns) noexcept {
  SessionInputs inputs;
  if (window_ != nullptr) {
    inputs.typed = window_->take_typed();
    inputs.keys = window_->held();  // after the characters, for which keys wait
    inputs.pointer = window_->pointer();
  }
  if (pedal_ != nullptr) {
    inputs.pedal = pedal_->depth();
  }
  if (channels_ != nullptr) {
    channels_->take(origin_.time_ns + time_ns);
    inputs.channels = channels_->values();
    inputs.arrived = channels_->arrived();
    const channel::Alarm alarm = channels_->alarm();
    if (alarm == channel::Alarm::kBeyond) {
      devices_.trip(device::Fault::kBeyondLimit, channels_->sentence());
    } else if (alarm == channel::Alarm::kLost && pass_ != nullptr) {
      devices_.trip(device::Fault::kChannelLost, channels_->sentence());
    }
  }
  return inputs;
}

bool SessionTask::tick(const realtime::Tick& tick) noexcept {
  note_suspension(tick.suspended_ns);
  take_requests(tick.index);
  resume_after_gap(tick.time_ns);

  devices_.read(inputs(tick.time_ns), tick.dt);
  const bool runs = pass_ != nullptr && !broken_off_ && devices_.fault() == device::Fault::kNone;
  const PassOutput out = runs ? pass_->tick(devices_.readings(), tick.dt) : nothing();
  note_gains(out);
  go_over_if_changed(out);
  note_onsets(tick, out);  // before anybody sees what begins
  devices_.limit(out, pass_ != nullptr ? pass_->others() : std::span<const Drive>{}, tick.dt);
  if (take_stop()) {  // it came during the tick, which a slow device may draw out
    devices_.drop();
  }
  for (stimulus::Observer* observer : observers_) {
    observer->observe(out.shown, devices_.forces(), tick.dt);
  }
  const bool taken = devices_.write();
  force_gone_.store(taken && devices_.without_force(), std::memory_order_release);
  record(tick, out);

  const bool attention = pass_ != nullptr && pass_->wants_attention();
  const bool ended = end_if_over(tick.index);
  if (ended) {
    note_end(tick);
  }
  const std::uint64_t next = tick.index + 1;
  return leave_ == Leave::kNever ||
         !(ended || attention || next % kSlice == 0 || next == leave_before_);
}

markers::TimedOnset SessionTask::timed(const realtime::Tick& tick,
                                       const markers::Onset& onset) const noexcept {
  return {onset, 0, origin_.sequence + tick.index, origin_.time_ns + tick.time_ns, row_, false};
}

/// A pass begins with its trial; then its own onsets, or its stages.
void SessionTask::note_onsets(const realtime::Tick& tick, const PassOutput& out) noexcept {
  const bool begins = std::exchange(begins_, false);
  if (onsets_ == nullptr || pass_ == nullptr) {
    return;
  }
  const bool has_stages = !pass_->names_onsets();
  const bool next_stage = has_stages && (begins || out.stage != told_stage_);
  if (!begins && !next_stage && out.onsets.all().empty()) {
    return;
  }
  markers::TickOnsets begun;
  if (begins) {
    begun.add(timed(tick, {}));
  }
  for (const markers::Onset& onset : out.onsets.all()) {
    begun.add(timed(tick, onset));
  }
  told_stage_ = out.stage;
  if (next_stage && out.stage != record::Stage::kIdle) {
    markers::Onset onset{record::MarkerOf::kStage};
    onset.index = static_cast<std::int16_t>(static_cast<int>(out.stage) - 1);
    begun.add(timed(tick, onset));
  }
  onsets_->put(begun);
}

void SessionTask::note_end(const realtime::Tick& tick) noexcept {
  if (onsets_ == nullptr) {
    return;
  }
  markers::TimedOnset end = timed(tick, {});
  end.over = true;
  markers::TickOnsets ended;
  ended.add(end);
  onsets_->put(ended);
}

void SessionTask::record(const realtime::Tick& tick, const PassOutput& out) noexcept {
  const Readings readings = devices_.readings();
  const stimulus::Forces forces = devices_.forces();
  record::Sample sample;
  sample.sequence = origin_.sequence + tick.index;
  sample.time_ns = origin_.time_ns + tick.time_ns;
  sample.position = readings[0].tool.position;
  sample.velocity = readings[0].tool.velocity;
  sample.force = forces[0];
  sample.applied_force = out.force.y();  // the device pushes back with what the hand presses
  sample.target_force = out.target_force;
  sample.pass = pass_ != nullptr ? row_ : -1;
  sample.stage = out.stage;
  sample.saturated = out.saturated;
  log_.push(sample);
  for (std::size_t device = 1; device_log_ != nullptr && device < readings.size(); ++device) {
    device_log_->push({sample.sequence, static_cast<std::int32_t>(device),
                       readings[device].tool.position, readings[device].tool.velocity,
                       forces[device], static_cast<std::int32_t>(readings[device].buttons)});
  }
  if (tick_log_ != nullptr) {
    tick_log_->record(sample.sequence, readings, devices_.fault());
  }
}

void SessionTask::take_requests(std::uint64_t sequence) noexcept {
  // Looked at in the reverse of the order in which the session's thread asks: who sees that a pass
  // is to be broken off sees the pass, who sees the pass sees the clearing that came before it. The
  // stop is last, so that no clearing wipes it out.
  const std::int32_t broken = break_row_.load(std::memory_order_acquire);
  if (Pass* const asked = asked_.load(std::memory_order_acquire)) {
    asked_.store(nullptr, std::memory_order_relaxed);
    waiting_ = asked;
  }
  if (clear_asked_.load(std::memory_order_acquire)) {
    clear_asked_.store(false, std::memory_order_relaxed);
    devices_.reset();
  }
  take_stop();
  if (broken >= 0) {
    break_off_row(broken, sequence);
  }
  const bool faulty = devices_.fault() != device::Fault::kNone;  // it ends at once, and says so
  if (waiting_ != nullptr && devices_.may_begin() && (faulty || waiting_->may_begin())) {
    begin(sequence);
  }
}

/// Nothing is wrong, so the force is let go, not cut. Whoever asked when the pass had just ended
/// did not mean the next one.
void SessionTask::break_off_row(std::int32_t row, std::uint64_t sequence) noexcept {
  if (waiting_ != nullptr && asked_row_.load(std::memory_order_relaxed) == row) {
    begin(sequence);
  }
  if (pass_ != nullptr && row_ == row) {
    broken_off_ = true;
    devices_.release();
  }
  break_row_.compare_exchange_strong(row, -1, std::memory_order_relaxed);
}

/// @returns whether an emergency stop was asked for.
bool SessionTask::take_stop() noexcept {
  if (!stop_asked_.load(std::memory_order_acquire)) {
    return false;
  }
  devices_.trip(device::Fault::kEmergencyStop);
  stop_asked_.store(false, std::memory_order_release);
  return true;
}

void SessionTask::begin(std::uint64_t sequence) noexcept {
  pass_ = std::exchange(waiting_, nullptr);
  row_ = asked_row_.load(std::memory_order_relaxed);
  broken_off_ = false;
  begins_ = true;
  result_.begun = true;
  result_.first_sample = origin_.sequence + sequence;
  pass_->begin(result_.first_sample);
  devices_.engage();
}

PassOutput SessionTask::nothing() const noexcept {
  PassOutput out;
  out.shown.tool = devices_.readings()[0].tool.position;
  return out;
}

/// The device, rotation or grip that lost most counts.
void SessionTask::note_gains(const PassOutput& out) noexcept {
  control::GainShares least;
  for (const device::DeviceReading& reading : devices_.readings().all()) {
    if (reading.shares.damping < kNoticed) {
      least.damping = std::min(least.damping, reading.shares.damping);
      least.stiffness = std::min(least.stiffness, reading.shares.stiffness);
    }
  }
  if (out.stage == record::Stage::kRun && least.damping < kNoticed) {
    control::GainShares& result = result_.least_gains;
    result.damping = std::min(result.damping, least.damping);
    result.stiffness = std::min(result.stiffness, least.stiffness);
    ++result_.reduced_ticks;
  }
}

/// The first tick of a pass ramps in anyway.
void SessionTask::go_over_if_changed(const PassOutput& out) noexcept {
  if (pass_ == nullptr) {
    return;
  }
  const bool changed = std::exchange(felt_stage_, out.stage) != out.stage || begins_stage(out);
  if (changed && !begins_) {
    devices_.go_over();
  }
}

/// A pass that begins on this tick missed nothing.
void SessionTask::note_suspension(std::int64_t suspended_ns) noexcept {
  if (pass_ != nullptr && suspended_ns > 0) {
    result_.suspended_ns += suspended_ns;
    pass_->note_suspension();
  }
}

/// A process that was stopped and goes on, or a computer that slept.
void SessionTask::resume_after_gap(std::int64_t time_ns) noexcept {
  const std::int64_t before = std::exchange(last_tick_ns_, time_ns);
  if (before >= 0 && time_ns - before > kLongestGap_ns) {
    devices_.resume();
  }
}

bool SessionTask::end_if_over(std::uint64_t sequence) noexcept {
  if (pass_ == nullptr) {
    return false;
  }
  const device::Fault fault = devices_.fault();
  const bool cut = fault != device::Fault::kNone || broken_off_;
  const PassState state = cut ? PassState::kAborted : pass_->state();
  if (state == PassState::kRunning) {
    return false;
  }
  result_.state = state;
  result_.fault = fault;
  result_.device = devices_.faulty();
  result_.trouble = devices_.trouble();
  result_.last_sample = origin_.sequence + sequence;
  pass_ = nullptr;
  devices_.release();
  busy_.store(false, std::memory_order_release);
  return true;
}

}  // namespace haptrial::protocols
