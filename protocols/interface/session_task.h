#pragma once

#include <atomic>
#include <utility>
#include <vector>

#include "core/channel/channel_set.h"
#include "core/device/pedal.h"
#include "core/realtime/block_log.h"
#include "core/realtime/servo_loop.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/session_types.h"
#include "core/stimulus/observer.h"
#include "core/stream/onset_log.h"
#include "protocols/interface/device_set.h"
#include "protocols/interface/pass.h"
#include "protocols/interface/window_input.h"

namespace haptrial::protocols {

/// How a pass ended.
struct PassResult {
  bool begun{false};  // the servo thread has taken it up
  PassState state{PassState::kRunning};
  device::Fault fault{device::Fault::kNone};
  std::size_t device{0};          // whose fault it was, from 0
  const char* trouble{""};        // what it said of it: a text of static duration
  std::uint64_t first_sample{0};  // sequence numbers, both inclusive
  std::uint64_t last_sample{0};
  // During the run, of what the definition asks for (HandleGuard).
  control::GainShares least_gains;
  std::uint64_t reduced_ticks{0};  // with noticeably less than all of the damping
  std::int64_t suspended_ns{0};    // for which the loop stood still
};

/// Start of a resumed session: number and time of its first tick.
struct Origin {
  std::uint64_t sequence{0};
  std::int64_t time_ns{0};
};

/// Task of every tick of a session:
///
///     devices -> envelopes -> pass -> envelopes -> devices, observers, logs
///
/// The same on a real and on a simulated clock. Where a pass goes over to another stage, the force
/// changes by degrees; after a gap of the loop (a suspended process) it ramps in anew. After a pass
/// the force is let go over the envelope's ramp_out, and the next one begins when it has gone and
/// the device is ready; between passes it is zero, and ticks are recorded all the same. The servo
/// thread calls tick(); the session's thread calls the rest.
class SessionTask final : public realtime::ServoTask {
 public:
  using Log = realtime::BlockLog<record::Sample>;
  using DeviceLog = realtime::BlockLog<record::DeviceRow>;  // of the devices after the first

  /// Ticks after which tick() asks ServoLoop::run to return. On a simulated clock the session's
  /// thread runs the loop itself and has to be let out, to empty the log, before the log is full.
  enum class Leave : std::uint8_t { kNever, kAfterPassOrSlice };
  static constexpr std::uint64_t kSlice = 512;  // [ticks]

  /// Parts that a task works with; all of it outlives the task.
  struct Parts {
    std::vector<DeviceSet::Arm> devices;  // 1 to kMostDevices
    control::HandleLoop loop{};           // of all of them
    Log& log;
    DeviceLog* device_log{nullptr};  // of the devices after the first
    TickLog* tick_log{nullptr};      // the protocol's own
    std::vector<stimulus::Observer*> observers{};
    WindowInput* window{nullptr};            // of the participant; null: there is none
    device::Pedal* pedal{nullptr};           // of all devices; null: as each says
    channel::ChannelSet* channels{nullptr};  // beside the devices; null: none
    markers::OnsetLog* onsets{nullptr};      // null: nobody is told what begins when
  };
  explicit SessionTask(const Parts& parts, Leave leave, Origin origin = Origin{});
  /// A task with one device.
  SessionTask(device::Device& device, const device::EnvelopeLimits& limits, Log& log,
              std::vector<stimulus::Observer*> observers, Leave leave, TickLog* tick_log = nullptr)
      : SessionTask(Parts{.devices = {{&device, limits}},
                          .log = log,
                          .tick_log = tick_log,
                          .observers = std::move(observers)},
                    leave) {}

  /// Hands a pass to the servo thread; it outlives the pass. Call only when idle().
  /// @param row  of /trials, for the samples
  void start(Pass& pass, std::int32_t row) noexcept;
  bool idle() const noexcept;
  /// Result of the last pass; call only when idle().
  const PassResult& result() const noexcept { return result_; }
  /// Asks tick() to let ServoLoop::run return after the tick before `index`, once. Between runs.
  void leave_before(std::uint64_t index) noexcept { leave_before_ = index; }
  /// Clears a fault before the next pass; the force ramps in again.
  void clear_fault() noexcept;
  /// Ends the pass that was started last as aborted without a fault: to repeat or to skip its
  /// trial. Nothing happens when it has ended.
  void break_off() noexcept;
  /// Force to zero from the next tick on, the present pass aborted. Also from a signal's handler.
  void emergency_stop() noexcept;
  /// Whether no pass runs and the device has taken a force of zero. Any thread.
  bool at_rest() const noexcept;
  /// Whether the device has taken the zero after emergency_stop(). Also from a signal's handler.
  bool stopped() const noexcept;

  bool tick(const realtime::Tick& tick) noexcept override;

 private:
  void note_suspension(std::int64_t suspended_ns) noexcept;
  void take_requests(std::uint64_t sequence) noexcept;
  SessionInputs inputs(std::int64_t time_ns) noexcept;
  bool take_stop() noexcept;
  void break_off_row(std::int32_t row, std::uint64_t sequence) noexcept;
  void begin(std::uint64_t sequence) noexcept;
  bool end_if_over(std::uint64_t sequence) noexcept;
  void record(const realtime::Tick& tick, const PassOutput& out) noexcept;
  PassOutput nothing() const noexcept;
  void note_gains(const PassOutput& out) noexcept;
  void go_over_if_changed(const PassOutput& out) noexcept;
  void resume_after_gap(std::int64_t time_ns) noexcept;
  void note_onsets(const realtime::Tick& tick, const PassOutput& out) noexcept;
  void note_end(const realtime::Tick& tick) noexcept;
  markers::TimedOnset timed(const realtime::Tick& tick, const markers::Onset& onset) const noexcept;

  DeviceSet devices_;
  Log& log_;
  DeviceLog* device_log_;
  TickLog* tick_log_;
  WindowInput* window_;
  device::Pedal* pedal_;
  channel::ChannelSet* channels_;
  markers::OnsetLog* onsets_;
  std::vector<stimulus::Observer*> observers_;
  Leave leave_;
  Origin origin_;
  std::uint64_t leave_before_{0};

  std::atomic<Pass*> asked_{nullptr};  // session thread -> servo thread
  std::atomic<std::int32_t> asked_row_{-1};
  std::atomic<bool> busy_{false};
  std::atomic<bool> force_gone_{true};  // the device took a force of zero last
  std::atomic<bool> clear_asked_{false};
  std::atomic<bool> stop_asked_{false};
  std::atomic<std::int32_t> break_row_{-1};  // of the pass to break off

  // Servo thread.
  Pass* waiting_{nullptr};  // until it may begin
  Pass* pass_{nullptr};
  std::int32_t row_{-1};
  bool broken_off_{false};
  bool begins_{false};                              // the pass has had no tick yet
  record::Stage told_stage_{record::Stage::kIdle};  // of the pass
  record::Stage felt_stage_{record::Stage::kIdle};
  std::int64_t last_tick_ns_{-1};  // -1: there was none
  PassResult result_;              // published by busy_
};

}  // namespace haptrial::protocols
