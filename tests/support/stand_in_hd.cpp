// A stand-in for 3D Systems' OpenHaptics HD library: its C functions, over a simulated handle, with
// a scheduler on a thread of its own, or one that a test steps by hand.

#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <chrono>
#include <limits>
#include <mutex>
#include <thread>

#include "tests/support/stand_in_handle.h"

using haptrial::test::Failure;
using haptrial::test::StandInHandle;
using haptrial::test::StandInSetup;
using haptrial::test::StandInView;

namespace {

using Callback = unsigned (*)(void*);
struct ErrorInfo {
  unsigned code;
  int internal;
  unsigned device;
};

constexpr double kMillimetre = 1e-3;  // [m]
constexpr unsigned kInvalid = 0xFFFFFFFF;

StandInHandle handle;
std::recursive_mutex mutex;  // of the handle
Callback callback = nullptr;
void* user = nullptr;
bool manual = false;
double rate = 1000.0;
std::atomic<unsigned> error{0};
std::thread scheduler;
std::atomic<bool> stop{false};

unsigned present_error() {
  return handle.fails(Failure::kLostLink)              ? 0x302
         : handle.fails(Failure::kTimeout)             ? 0x304
         : handle.fails(Failure::kForcesOffByVelocity) ? 0x203
         : handle.fails(Failure::kMotorsWarm)          ? 0x200
         : handle.fails(Failure::kForceRefused)        ? 0x204
                                                       : 0;
}

void period() {
  const std::lock_guard lock(mutex);
  if (handle.fails(Failure::kStall)) {
    ++handle.ticks;
    return;
  }
  if (callback != nullptr && callback(user) == 0) {
    callback = nullptr;
  }
  handle.step(1.0 / rate);
}

void schedule_periods() {
  const sched_param urgent{80};  // as a vendor's scheduler runs; refused, it is merely less even
  pthread_setschedparam(pthread_self(), SCHED_FIFO, &urgent);
  auto next = std::chrono::steady_clock::now();
  while (!stop) {
    period();
    next += std::chrono::nanoseconds(static_cast<long>(1e9 / rate));
    std::this_thread::sleep_until(next);
  }
}

}  // namespace

extern "C" {

void stand_in_reset() {
  const std::lock_guard lock(mutex);
  handle = {};
  callback = nullptr;
  error = 0;
}
void stand_in_fail(int failure, long tick) {
  const std::lock_guard lock(mutex);
  handle.failure = static_cast<Failure>(failure);
  handle.failure_tick = tick;
}
void stand_in_place(const double* p) {
  const std::lock_guard lock(mutex);
  const double in_metres[3] = {kMillimetre * p[0], kMillimetre * p[1], kMillimetre * p[2]};
  handle.place(in_metres);
}
void stand_in_turn(const double* rows) {
  const std::lock_guard lock(mutex);
  std::copy_n(rows, 9, handle.turn.begin());
}
void stand_in_activate() {
  const std::lock_guard lock(mutex);
  handle.active = true;
}
void stand_in_buttons(unsigned mask) {
  const std::lock_guard lock(mutex);
  handle.buttons = mask;
}
void stand_in_view(StandInView* out) {
  const std::lock_guard lock(mutex);
  handle.view(out, kMillimetre);
}
void stand_in_setup(StandInSetup* out) {
  const std::lock_guard lock(mutex);
  *out = handle.setup;
}
void stand_in_manual(int on) { manual = on != 0; }
void stand_in_step() { period(); }

unsigned hdInitDevice(const char*) {
  if (handle.fails(Failure::kNoDevice)) {
    error = 0x302;
    return kInvalid;
  }
  handle.note("init");
  handle.open = true;
  return 0;
}
void hdDisableDevice(unsigned) {
  handle.note("disable");
  handle.open = false;
}
void hdMakeCurrentDevice(unsigned) { handle.note("current"); }
void hdEnable(unsigned what) {
  handle.note("enable");
  handle.forces_on = handle.forces_on || what == 0x4000;
}
void hdDisable(unsigned what) { handle.forces_on = handle.forces_on && what != 0x4000; }
void hdSetSchedulerRate(unsigned long hz) {
  rate = static_cast<double>(hz);
  handle.setup.rate = rate;
  handle.note("rate");
}
unsigned long hdScheduleAsynchronous(Callback function, void* data, unsigned short) {
  const std::lock_guard lock(mutex);
  callback = function;
  user = data;
  handle.note("schedule");
  return 7;
}
void hdUnschedule(unsigned long) {
  const std::lock_guard lock(mutex);
  callback = nullptr;
}
void hdStartScheduler() {
  handle.note("start");
  if (manual) {
    period();
    return;
  }
  stop = false;
  scheduler = std::thread(schedule_periods);
}
void hdStopScheduler() {
  stop = true;
  if (scheduler.joinable()) {
    scheduler.join();
  }
}
void hdBeginFrame(unsigned) {}
void hdEndFrame(unsigned) { error = present_error(); }
void hdGetDoublev(unsigned what, double* out) {
  if (what == 0x2603) {
    *out = 3.3;
    return;
  }
  if (what == 0x2622) {
    *out = handle.active ? 515.0 : 0.0;
    return;
  }
  if (what == 0x2053) {
    std::copy_n(handle.spin.begin(), 3, out);
    return;
  }
  if (what == 0x2052) {
    std::fill_n(out, 16, 0.0);
    for (std::size_t i = 0; i < 9; ++i) {
      out[4 * (i % 3) + i / 3] = handle.turn[i];
    }
    out[15] = 1.0;
    return;
  }
  const StandInHandle::Vector& from = what == 0x2050 ? handle.position : handle.velocity;
  for (std::size_t i = 0; i < 3; ++i) {
    out[i] = from[i] / kMillimetre;
  }
  if (what == 0x2050 && handle.fails(Failure::kNotFinite)) {
    out[2] = std::numeric_limits<double>::infinity();
  }
  if (what == 0x2050 && handle.fails(Failure::kJump)) {
    out[1] += 20.0;
  }
}
void hdGetIntegerv(unsigned what, int* out) {
  *out = what == 0x2554 ? (handle.active ? 6 : 3) : static_cast<int>(handle.buttons);
}
void hdSetDoublev(unsigned what, const double* in) {
  if (what == 0x2700) {
    std::copy_n(in, 3, handle.force.begin());
  }
  if (what == 0x2701) {
    std::transform(in, in + 3, handle.torque.begin(), [](double t) { return 1e-3 * t; });
  }
}
ErrorInfo hdGetError() { return {error.exchange(0), 0, 0}; }

}  // extern "C"
