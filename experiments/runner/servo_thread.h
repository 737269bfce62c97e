#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/realtime/servo_loop.h"
#include "experiments/control/signals.h"
#include "protocols/interface/session_task.h"

namespace haptrial::experiments {

/// The device's library does not come back from a call.
class DeviceHangs : public RunError {
 public:
  DeviceHangs();
};

/// Notices a servo loop that has ticked and does not tick any more. Asked often, every 50 ms at
/// least: only time that the asking thread itself saw pass counts, so that neither a suspended
/// program nor a busy machine looks like a loop that hangs.
class StallWatch {
 public:
  static constexpr std::chrono::milliseconds kLongest{1000};
  explicit StallWatch(const realtime::ServoLoop& loop) : loop_(loop) {}
  bool stalled();

 private:
  const realtime::ServoLoop& loop_;
  std::uint64_t ticks_{0};
  std::chrono::steady_clock::time_point looked_{std::chrono::steady_clock::now()};
  std::chrono::steady_clock::duration still_{};
};

/// The servo thread of a session on the real clock. It does not end before the force is zero: what
/// was let go fades over the envelope's ramp_out, with the loop that makes it fade. Session's
/// thread.
class ServoThread {
 public:
  /// @param fade  how long a force takes to go at most [s]. Loop and task outlive the thread.
  ServoThread(realtime::ServoLoop& loop, protocols::SessionTask& task, double fade);
  ~ServoThread();
  ServoThread(const ServoThread&) = delete;
  ServoThread& operator=(const ServoThread&) = delete;

  void start();
  bool runs() const { return thread_.joinable(); }
  /// Waits until the task is at rest, a bounded time, and ends the thread.
  /// @throws DeviceHangs when it does not end; the thread is then left to itself, and whatever it
  /// uses must not be destroyed before the program ends: hangs().
  void end();
  bool hangs() const { return hangs_; }
  /// Whether this is the calling thread. Also from a signal's handler.
  bool is_current() const noexcept;

 private:
  void wait_for_rest();

  realtime::ServoLoop& loop_;
  protocols::SessionTask& task_;
  std::chrono::duration<double> fade_;
  std::atomic<bool> over_{false};
  std::atomic<pid_t> id_{0};
  bool hangs_{false};
  std::thread thread_;
};

/// A stop that takes the force of a session away. All three outlive it.
class SessionStop final : public FatalStopHandler {
 public:
  SessionStop(protocols::SessionTask& task, const ServoThread& servo, device::Device& device)
      : task_(task), servo_(servo), device_(device) {}
  void ask() noexcept override { task_.emergency_stop(); }
  bool done() const noexcept override { return task_.stopped(); }
  bool on_servo_thread() const noexcept override { return servo_.is_current(); }
  void write_zero() noexcept override { device_.write(Eigen::Vector3d::Zero()); }

 private:
  protocols::SessionTask& task_;
  const ServoThread& servo_;
  device::Device& device_;
};

/// The servo side of a session: its task, the thread that runs it and the stop that takes its force
/// away, in the order in which they may go.
struct SessionServo {
  /// @param parts  outlive this, as the loop does
  SessionServo(realtime::ServoLoop& loop, const protocols::SessionTask::Parts& parts, bool real,
               const protocols::Origin& origin);
  /// Ends the thread once the force has faded, or a fault has cut it, and leaves none to any
  /// device.
  /// @throws DeviceHangs
  void end();

  protocols::SessionTask task;
  ServoThread thread;  // on a real clock
  SessionStop stop;
  std::optional<WatchedStop> watched;  // likewise

 private:
  std::vector<protocols::DeviceSet::Arm> arms_;
};

/// How long a force takes to go at most. [s]
double longest_fade(const device::EnvelopeLimits& limits);

}  // namespace haptrial::experiments
