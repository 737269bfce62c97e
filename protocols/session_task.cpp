#include "protocols/session_task.h"

#include <algorithm>
#include <utility>

namespace haptrial::protocols {

SessionTask::SessionTask(device::Device& device, const device::EnvelopeLimits& limits, Log& log,
                         std::vector<stimulus::Observer*> observers, Leave leave, Origin origin,
                         ToolLog* tool_log, const std::atomic<std::uint32_t>* keys)
    : device_(device),
      envelope_(limits),
      log_(log),
      tool_log_(tool_log),
      keys_(keys),
      observers_(std::move(observers)),
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

void SessionTask::break_off() noexcept { break_asked_.store(true, std::memory_order_release); }

bool SessionTask::at_rest() const noexcept {
  return idle() && force_gone_.load(std::memory_order_acquire);
}

bool SessionTask::stopped() const noexcept {
  return !stop_asked_.load(std::memory_order_acquire) &&
         force_gone_.load(std::memory_order_acquire);
}

bool SessionTask::tick(const realtime::Tick& tick) noexcept {
  take_requests(tick.index);

  const bool read_ok = device_.read(reading_);
  reading_.keys = keys_ != nullptr ? keys_->load(std::memory_order_relaxed) : 0;
  envelope_.check(read_ok, reading_);
  PassOutput out = ask_pass(reading_, tick.dt);
  Eigen::Vector3d force = envelope_.limit(out.force, tick.dt, out.intent);
  if (take_stop()) {  // it came during the tick, which a slow device may draw out
    force.setZero();
  }
  for (stimulus::Observer* observer : observers_) {
    observer->observe(out.presentation, force, tick.dt);
  }
  const bool taken = device_.write(force);
  if (!taken) {
    envelope_.trip(device::Fault::kWriteFailed);
  }
  force_gone_.store(taken && force.isZero(0.0), std::memory_order_release);

  record::Sample sample;
  sample.sequence = origin_.sequence + tick.index;
  sample.time_ns = origin_.time_ns + tick.time_ns;
  sample.position = reading_.tool.position;
  sample.velocity = reading_.tool.velocity;
  sample.force = force;
  sample.applied_force = out.applied_force;
  sample.target_force = out.target_force;
  sample.pass = pass_ != nullptr ? row_ : -1;
  sample.stage = out.stage;
  sample.saturated = out.saturated;
  log_.push(sample);
  if (tool_log_ != nullptr) {
    push_tool(out.tool, sample.sequence);
  }

  const bool attention = pass_ != nullptr && pass_->wants_attention();
  const bool ended = end_if_over(tick.index);
  const std::uint64_t next = tick.index + 1;
  return leave_ == Leave::kNever ||
         !(ended || attention || next % kSlice == 0 || next == leave_before_);
}

void SessionTask::push_tool(record::ToolRow row, std::uint64_t sequence) noexcept {
  row.sequence = sequence;
  row.orientation = reading_.orientation;
  row.buttons = reading_.buttons;
  row.keys = reading_.keys;
  row.pedal = reading_.pedal;
  tool_log_->push(row);
}

void SessionTask::take_requests(std::uint64_t sequence) noexcept {
  // Looked at in the reverse of the order in which the session's thread asks: who sees the pass
  // sees the clearing that came before it. The stop is last, so that no clearing wipes it out.
  Pass* const asked = asked_.load(std::memory_order_acquire);
  if (clear_asked_.load(std::memory_order_acquire)) {
    clear_asked_.store(false, std::memory_order_relaxed);
    envelope_.reset();
  }
  take_stop();
  if (break_asked_.load(std::memory_order_acquire)) {
    break_asked_.store(false, std::memory_order_relaxed);
    if (waiting_ != nullptr) {
      begin(sequence);
    }
    broken_off_ = pass_ != nullptr;
    envelope_.release();  // nothing is wrong: the force is let go, not cut
  }
  if (asked != nullptr) {
    asked_.store(nullptr, std::memory_order_relaxed);
    waiting_ = asked;
  }
  if (waiting_ != nullptr && may_begin()) {
    begin(sequence);
  }
}

/// @returns whether an emergency stop was asked for.
bool SessionTask::take_stop() noexcept {
  if (!stop_asked_.load(std::memory_order_acquire)) {
    return false;
  }
  envelope_.trip(device::Fault::kEmergencyStop);
  stop_asked_.store(false, std::memory_order_release);
  return true;
}

/// Not before the force of the pass before has gone; a fault lets it begin, to end it.
bool SessionTask::may_begin() noexcept {
  const bool let_go = !envelope_.released() || envelope_.at_rest();
  return envelope_.fault() != device::Fault::kNone || (let_go && device_.ready());
}

void SessionTask::begin(std::uint64_t sequence) noexcept {
  pass_ = std::exchange(waiting_, nullptr);
  row_ = asked_row_.load(std::memory_order_relaxed);
  broken_off_ = false;
  result_.begun = true;
  result_.first_sample = origin_.sequence + sequence;
  pass_->begin(result_.first_sample);
  envelope_.engage();
}

PassOutput SessionTask::ask_pass(const device::DeviceReading& reading, double dt) noexcept {
  if (pass_ != nullptr && !broken_off_ && envelope_.fault() == device::Fault::kNone) {
    const PassOutput out = pass_->tick(reading, dt);
    if (out.stage == record::Stage::kRun && out.damping_share < 1.0) {
      result_.least_damping = std::min(result_.least_damping, out.damping_share);
      ++result_.reduced_ticks;
    }
    return out;
  }
  PassOutput nothing;
  nothing.presentation.tool = reading.tool.position;
  return nothing;
}

bool SessionTask::end_if_over(std::uint64_t sequence) noexcept {
  if (pass_ == nullptr) {
    return false;
  }
  const device::Fault fault = envelope_.fault();
  const bool cut = fault != device::Fault::kNone || broken_off_;
  const PassState state = cut ? PassState::kAborted : pass_->state();
  if (state == PassState::kRunning) {
    return false;
  }
  result_.state = state;
  result_.fault = fault;
  result_.last_sample = origin_.sequence + sequence;
  pass_ = nullptr;
  envelope_.release();
  busy_.store(false, std::memory_order_release);
  return true;
}

}  // namespace haptrial::protocols
