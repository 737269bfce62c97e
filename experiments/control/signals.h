#pragma once

#include <csignal>

#include <array>

namespace haptrial::experiments {

/// Makes SIGINT, SIGTERM and a closed terminal (SIGHUP, unless it was ignored) ask the program to
/// stop from now on; a second SIGINT or SIGTERM, 0.3 s later or more, ends it at once, once the
/// force is zero.
void watch_for_interrupt();

/// Watches likewise until it goes out of scope. Work that comes after it and asks nobody whether to
/// stop then ends by the signals again, unless they were watched before.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  InterruptWatch(const InterruptWatch&) = delete;
  InterruptWatch& operator=(const InterruptWatch&) = delete;

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  std::array<struct sigaction, kSignals.size()> before_{};
};

/// Every signal that would kill the program takes the force away first, and so does one that
/// would suspend it (Ctrl-Z); SIGPIPE and SIGXFSZ are ignored. What is handled already stays.
/// SIGKILL and SIGSTOP cannot be caught: there the device's own watchdog takes the force away.
void watch_fatal_signals();

}  // namespace haptrial::experiments
