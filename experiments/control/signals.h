#pragma once

#include <array>
#include <csignal>

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

/// Whether the program was asked to stop. Any thread.
bool interrupted() noexcept;
/// Asks it to stop, as a signal does (signals.h). Any thread.
void interrupt() noexcept;

/// Sets a callback that the signal's handler calls as well, with `with`: only what a handler may do
/// (an atomic store). Null: nobody. Any thread.
void call_on_interrupt(void (*call)(void*), void* with) noexcept;

/// How the force is taken away from a signal's handler. Each does only what a handler may, but
/// write_zero(): it calls the vendor's library, the lesser evil when the program dies anyway and
/// the servo thread cannot do it any more.
class FatalStopHandler {
 public:
  virtual ~FatalStopHandler() = default;
  virtual void ask() noexcept = 0;                    // the servo thread to command zero
  virtual bool done() const noexcept = 0;             // whether the device has it
  virtual bool on_servo_thread() const noexcept = 0;  // whether that is the calling thread
  virtual void write_zero() noexcept = 0;             // on the device, at once
};

/// Stop that is watched while the object lives: an interrupt asks for it, and a signal that kills
/// the program takes the force away first, and so does a library that calls exit(). At most one at
/// a time.
class WatchedStop {
 public:
  explicit WatchedStop(FatalStopHandler& stop) noexcept;  // outlives this
  ~WatchedStop();
  WatchedStop(const WatchedStop&) = delete;
  WatchedStop& operator=(const WatchedStop&) = delete;
};

/// Asks the servo thread for zero and waits until the device has it, 50 ms at most; then, or when
/// the servo thread itself is the one that dies, writes zero to the device. A vendor's library that
/// hangs at that ends the program within two seconds. For a handler whose program is about to die.
void take_force_away() noexcept;

/// A signal's handler: takes the force away, puts the terminal back and dies of the signal.
extern "C" void stop_and_die(int signal);

}  // namespace haptrial::experiments
