#include "experiments/control/signals.h"

#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <ctime>

#include "experiments/control/keyboard.h"

namespace haptrial::experiments {
namespace {

constexpr double kOneWish = 0.3;    // [s]
std::atomic<double> first_at{0.0};  // [s]
static_assert(std::atomic<double>::is_always_lock_free);

double seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// `timeout` tells the program and then its group, which is one wish.
extern "C" void on_next_signal(int signal) {
  if (seconds() - first_at.load(std::memory_order_relaxed) > kOneWish) {
    stop_and_die(signal);
  }
}

extern "C" void on_signal(int signal) {
  interrupt();
  restore_terminal();
  if (signal != SIGHUP) {  // a shell and the system may both tell of a closed terminal
    first_at.store(seconds(), std::memory_order_relaxed);
    std::signal(signal, on_next_signal);
  }
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

void watch_for_interrupt() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) {
    std::signal(SIGHUP, SIG_IGN);  // nohup: the session is to outlive its terminal
  }
}

InterruptWatch::InterruptWatch() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], nullptr, &before_[i]);
  }
  watch_for_interrupt();
}

InterruptWatch::~InterruptWatch() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) {
    ::sigaction(kSignals[i], &before_[i], nullptr);
  }
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

namespace {

std::atomic<bool> asked{false};
std::atomic<void (*)(void*)> hook{nullptr};
std::atomic<void*> hook_with{nullptr};
static_assert(std::atomic<bool>::is_always_lock_free);  // so that a signal handler may set it

}  // namespace

bool interrupted() noexcept { return asked.load(); }

void interrupt() noexcept {
  asked.store(true);
  if (const auto call = hook.load()) {
    call(hook_with.load());
  }
}

void call_on_interrupt(void (*call)(void*), void* with) noexcept {
  hook.store(nullptr);
  hook_with.store(with);
  hook.store(call);
}

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
