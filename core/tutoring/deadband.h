#pragma once

#include <cstdint>

#include "core/tutoring/held_force.h"
#include "core/tutoring/tutoring_law.h"

namespace haptrial::tutoring {

struct DeadbandParameters {
  double force_fraction{0.1};  // Weber fraction of force, 0 to 1
  double least_force{0.05};    // below which no difference is felt > 0 [N]
  double place{0.0005};        // of the tool, beside where it would have gone on > 0 [m]
  double keepalive{0.05};      // longest silence > 0 [s]
};

/// Expected state of the partner while nothing comes: the tool goes on evenly, for a while at most,
/// and the force holds. Both sides compute it from the message sent last.
/// @param since  the message [s]; a tool that is not heard of for longer than `most` stands still
Partner expected(const Partner& sent, double since, double most) noexcept;

/// Says which ticks need a message: those that the partner would feel or see wrongly without it.
/// Values are absolute, so a lost message is mended by the next one, and a silence ends after
/// `keepalive`. Without loss the partner's force is wrong by at most
/// max(force_fraction |f|, least_force) and its place by at most `place`, at every tick, also the
/// one of a message: what it says of the force is chosen within these bounds so as to last
/// (HeldForce). Source of the Weber rule: Hinterseer, Hirche, Chaudhuri, Steinbach and Buss (2008).
/// Servo thread: no allocation, lock, I/O or throw.
class Deadband {
 public:
  explicit Deadband(const DeadbandParameters& parameters = {}) noexcept : p_(parameters) {}

  /// A tick. @param news  a message goes in any case
  /// @returns whether it needs a message; sent() then counts as sent.
  bool due(const Partner& now, double dt, bool news = false) noexcept;
  /// Content of the last message.
  const Partner& sent() const noexcept { return sent_; }
  /// State of the partner without loss, of the last tick.
  Partner held() const noexcept { return expected(sent_, since_, p_.keepalive); }

  std::uint64_t ticks() const noexcept { return ticks_; }
  std::uint64_t messages() const noexcept { return messages_; }

 private:
  bool wrong(const Partner& now, double most) const noexcept;

  DeadbandParameters p_;
  HeldForce forces_;
  Partner sent_;
  double since_{0.0};  // the last message [s]
  std::uint64_t ticks_{0};
  std::uint64_t messages_{0};
};

}  // namespace haptrial::tutoring
