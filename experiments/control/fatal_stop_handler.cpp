#include "experiments/control/fatal_stop_handler.h"

#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>

#include "experiments/control/interrupt.h"
#include "experiments/control/keyboard.h"

namespace haptrial::experiments {
namespace {

std::atomic<FatalStopHandler*> registered{nullptr};
static_assert(std::atomic<FatalStopHandler*>::is_always_lock_free);  // for a signal's handler

void pause_for(long nanoseconds) noexcept {
  timespec left{0, nanoseconds};
  while (::nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

/// @returns whether the servo thread has commanded zero.
bool stopped_by_servo(FatalStopHandler& stop) noexcept {
  constexpr long kLook = 200'000;  // [ns]
  constexpr int kLooks = 250;
  stop.ask();
  if (stop.on_servo_thread()) {
    return false;
  }
  for (int i = 0; i < kLooks; ++i) {
    if (stop.done()) {
      return true;
    }
    pause_for(kLook);
  }
  return false;
}

}  // namespace

extern "C" void stop_and_die(int signal) {
  take_force_away();
  restore_terminal();
  ::signal(signal, SIG_DFL);
  ::raise(signal);  // comes when this handler returns
}

WatchedStop::WatchedStop(FatalStopHandler& stop) noexcept {
  [[maybe_unused]] static const int at_exit = std::atexit(take_force_away);
  registered.store(&stop);
  call_on_interrupt([](void* each) { static_cast<FatalStopHandler*>(each)->ask(); }, &stop);
}

WatchedStop::~WatchedStop() {
  call_on_interrupt(nullptr, nullptr);
  registered.store(nullptr);
}

void take_force_away() noexcept {
  FatalStopHandler* const stop = registered.load();
  if (stop == nullptr) {
    return;
  }
  constexpr unsigned kLongest = 2;  // [s]
  ::signal(SIGALRM, SIG_DFL);
  ::alarm(kLongest);
  if (!stopped_by_servo(*stop)) {
    stop->write_zero();
  }
  constexpr long kHandOver = 5'000'000;  // to a driver that commands from a thread of its own [ns]
  pause_for(kHandOver);
  ::alarm(0);
}

}  // namespace haptrial::experiments
