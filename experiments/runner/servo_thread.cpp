#include "experiments/runner/servo_thread.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

namespace haptrial::experiments {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

DeviceHangs::DeviceHangs()
    : RunError(
          "the device's library does not come back from a call; the device's own watchdog "
          "has to take the force away") {}

bool StallWatch::stalled() {
  constexpr milliseconds kOneLook{50};
  const auto now = Clock::now();
  const auto since = std::min<Clock::duration>(now - std::exchange(looked_, now), kOneLook);
  const std::uint64_t ticks = loop_.ticks();
  still_ = ticks == 0 || ticks != ticks_ ? Clock::duration{} : still_ + since;
  ticks_ = ticks;
  return still_ >= kLongest;
}

ServoThread::ServoThread(realtime::ServoLoop& loop, protocols::SessionTask& task, double fade)
    : loop_(loop), task_(task), fade_(fade) {}

ServoThread::~ServoThread() {
  if (runs()) {
    loop_.request_stop();
    thread_.join();
  }
}

void ServoThread::start() {
  over_ = false;
  thread_ = std::thread([this] {
    id_ = ::gettid();
    loop_.run(task_);
    over_ = true;
  });
}

bool ServoThread::is_current() const noexcept { return id_.load() == ::gettid(); }

void ServoThread::wait_for_rest() {
  constexpr milliseconds kSpare{500};
  StallWatch watch(loop_);
  const auto end = Clock::now() + fade_ + kSpare;
  while (!task_.at_rest() && !watch.stalled() && Clock::now() < end) {
    std::this_thread::sleep_for(milliseconds(1));
  }
}

void ServoThread::end() {
  if (!runs()) {
    return;
  }
  wait_for_rest();
  loop_.request_stop();
  constexpr milliseconds kPatience{1000};
  const auto end = Clock::now() + kPatience;
  while (!over_ && Clock::now() < end) {
    std::this_thread::sleep_for(milliseconds(1));
  }
  if (over_) {
    thread_.join();
    return;
  }
  hangs_ = true;
  thread_.detach();
  throw DeviceHangs();
}

SessionServo::SessionServo(realtime::ServoLoop& loop, const protocols::SessionTask::Parts& parts,
                           bool real, const protocols::Origin& origin)
    : task(parts,
           real ? protocols::SessionTask::Leave::kNever
                : protocols::SessionTask::Leave::kAfterPassOrSlice,
           origin),
      thread(loop, task, longest_fade(parts.devices.front().limits)),
      stop(task, thread, *parts.devices.front().device),
      arms_(parts.devices) {
  if (real) {
    watched.emplace(stop);
  }
}

void SessionServo::end() {
  try {
    thread.end();
  } catch (const DeviceHangs&) {
    watched.reset();  // the end of the program must not call a library that hangs
    throw;
  }
  for (const protocols::DeviceSet::Arm& arm : arms_) {
    arm.device->write(Eigen::Vector3d::Zero());
  }
}

double longest_fade(const device::EnvelopeLimits& limits) {
  return limits.ramp_out + limits.max_force / limits.max_force_rate;
}

}  // namespace haptrial::experiments
