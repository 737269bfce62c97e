#include "experiments/control/signals.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <initializer_list>

#include "experiments/control/fatal_stop_handler.h"
#include "experiments/control/interrupt.h"
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

}  // namespace haptrial::experiments
