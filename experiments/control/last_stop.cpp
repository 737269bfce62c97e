#include "experiments/control/last_stop.h"

#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <initializer_list>

#include "experiments/control/interrupt.h"
#include "experiments/control/keyboard.h"

namespace haptrial::experiments {
namespace {

std::atomic<LastStop*> registered{nullptr};
static_assert(std::atomic<LastStop*>::is_always_lock_free);  // for a signal's handler

void pause_for(long nanoseconds) noexcept {
  timespec left{0, nanoseconds};
  while (::nanosleep(&left, &left) != 0 && errno == EINTR) {
  }
}

/// @returns whether the servo thread has commanded zero.
bool stopped_by_servo(LastStop& stop) noexcept {
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

extern "C" void stop_and_suspend(int) {
  const int error = errno;
  take_force_away();
  ::raise(SIGSTOP);
  errno = error;
}

void handle(int signal, void (*with)(int)) {
  struct sigaction now {};
  ::sigaction(signal, nullptr, &now);
  if (now.sa_handler == SIG_DFL && (now.sa_flags & SA_SIGINFO) == 0) {
    struct sigaction ours {};
    ours.sa_handler = with;
    ours.sa_flags = SA_RESTART;
    ::sigaction(signal, &ours, nullptr);
  }
}

}  // namespace

extern "C" void stop_and_die(int signal) {
  take_force_away();
  restore_terminal();
  ::signal(signal, SIG_DFL);
  ::raise(signal);  // comes when this handler returns
}

WatchedStop::WatchedStop(LastStop& stop) noexcept {
  registered.store(&stop);
  call_on_interrupt([](void* each) { static_cast<LastStop*>(each)->ask(); }, &stop);
}

WatchedStop::~WatchedStop() {
  call_on_interrupt(nullptr, nullptr);
  registered.store(nullptr);
}

void take_force_away() noexcept {
  LastStop* const stop = registered.load();
  if (stop == nullptr || stopped_by_servo(*stop)) {
    return;
  }
  constexpr unsigned kLongest = 2;  // [s]
  ::signal(SIGALRM, SIG_DFL);
  ::alarm(kLongest);
  stop->write_zero();
  constexpr long kHandOver = 3'000'000;  // to a library that commands from a thread of its own [ns]
  pause_for(kHandOver);
  ::alarm(0);
}

void watch_fatal_signals() {
  for (const int each :
       {SIGQUIT, SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS, SIGTRAP, SIGXCPU, SIGUSR1,
        SIGUSR2, SIGALRM, SIGVTALRM, SIGPROF, SIGIO, SIGPWR, SIGSTKFLT}) {
    handle(each, stop_and_die);
  }
  for (int each = SIGRTMIN; each <= SIGRTMAX; ++each) {
    handle(each, stop_and_die);
  }
  for (const int each : {SIGTSTP, SIGTTIN, SIGTTOU}) {
    handle(each, stop_and_suspend);
  }
  handle(SIGPIPE, SIG_IGN);  // a reader that leaves ends no session,
  handle(SIGXFSZ, SIG_IGN);  // and a file that may not grow gets its sentence
}

}  // namespace haptrial::experiments
