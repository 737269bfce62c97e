#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/network/link/meeting.h"
#include "core/network/link/sealer.h"
#include "core/realtime/block_log.h"

namespace haptrial::network {

/// A message and when it came, on this side's steady clock.
struct Arrived {
  TickMessage message;
  std::int64_t time_ns{0};
};

/// The link while a session runs: one thread that sends and receives, and two lock-free logs to and
/// from the servo thread, which never waits for it. It looks for messages to send every quarter of
/// a millisecond. Datagrams go to where the last authentic one came from.
class LinkThread {
 public:
  explicit LinkThread(Met met);
  ~LinkThread();
  LinkThread(const LinkThread&) = delete;
  LinkThread& operator=(const LinkThread&) = delete;

  /// Servo thread; wait-free. @returns false, and counts, where the log is full
  bool send(const TickMessage& message) noexcept { return out_.push(message); }
  /// Gives what has arrived to f(const Arrived&), oldest first. Servo thread; wait-free.
  template <class F>
  void receive(F&& f) noexcept {
    in_.flush([&](std::span<const Arrived> all) {
      for (const Arrived& arrived : all) {
        f(arrived);
      }
    });
  }

  struct Counts {
    std::uint64_t sent{0};
    std::uint64_t accepted{0};
    std::uint64_t foreign{0};
    std::uint64_t forged{0};
    std::uint64_t repeated{0};
    std::uint64_t failed{0};   // that the system did not take
    std::uint64_t dropped{0};  // for want of room in a log
  };
  Counts counts() const noexcept;  // any thread

 private:
  void run() noexcept;
  void take_in() noexcept;
  void send_out() noexcept;
  void publish() noexcept;

  Met met_;
  Sealer sealer_;
  Opener opener_;
  realtime::BlockLog<TickMessage> out_{64, 64};
  realtime::BlockLog<Arrived> in_{64, 64};
  Counts own_;  // the thread's
  std::atomic<std::uint64_t> sent_{0}, accepted_{0}, foreign_{0}, forged_{0}, repeated_{0},
      failed_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// The clock of arrivals [ns].
std::int64_t link_clock_ns() noexcept;

}  // namespace haptrial::network
