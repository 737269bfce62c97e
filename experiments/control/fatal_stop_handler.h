#pragma once

namespace haptrial::experiments {

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
