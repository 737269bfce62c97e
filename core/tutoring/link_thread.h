#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

#include "core/realtime/block_log.h"
#include "core/tutoring/meeting.h"
#include "core/tutoring/sealer.h"
#include "core/tutoring/wire.h"

namespace haptrial::tutoring {

/// The link while a session runs: one thread that sends and receives, and two lock-free logs to and
/// from the servo thread, which never waits for it. It looks for messages to send every quarter of
/// a millisecond. The host's datagrams go to where the last authentic one came from. Times are of
/// this side's steady clock. What arrives before the first tick() is dropped: nobody listens yet.
class LinkThread final : public Wire {
 public:
  explicit LinkThread(EstablishedLink met);
  LinkThread(const LinkThread&) = delete;
  LinkThread& operator=(const LinkThread&) = delete;

  std::int64_t tick() noexcept override;
  void send(const TickMessage& message) noexcept override { out_.push(message); }
  void receive(Listener& listener) noexcept override;
  bool closed() const noexcept override { return false; }  // nobody can know
  void close(const TickMessage& last) noexcept override;
  WireCounts counts() const noexcept override;

 private:
  void run(const std::stop_token& stop) noexcept;
  void take_in() noexcept;
  void send_out() noexcept;
  void publish() noexcept;

  EstablishedLink met_;
  Sealer sealer_;
  Opener opener_;
  realtime::BlockLog<TickMessage> out_{64, 64};
  realtime::BlockLog<Arrived> in_{64, 64};
  WireCounts own_;  // the thread's
  std::atomic<std::uint64_t> sent_{0}, accepted_{0}, foreign_{0}, forged_{0}, repeated_{0},
      failed_{0};
  std::atomic<bool> heard_{false};  // somebody takes what arrives
  std::jthread thread_;             // last: it ends before what it uses
};

/// The clock of arrivals [ns].
std::int64_t link_clock_ns() noexcept;

}  // namespace haptrial::tutoring
