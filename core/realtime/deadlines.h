#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace haptrial::realtime {

/// When the ticks of one run of a real loop are due. Knows no clock: it is told the time, [ns] on
/// any clock that does not go back.
///
/// Tick i is due i periods after the first; after a delay ticks follow each other at half a period
/// until they are on time again. ServoLoop says why.
class Deadlines {
 public:
  static constexpr std::int64_t kHopelesslyLateNs = 100'000'000;

  /// The first tick is due at `first`; period_ns is at least 1.
  Deadlines(double period_ns, std::int64_t first) noexcept
      : period_ns_(period_ns),
        half_period_(static_cast<std::int64_t>(period_ns / 2)),
        hopeless_(std::max(kHopelesslyLateNs, static_cast<std::int64_t>(period_ns))),
        anchor_(first) {}

  /// When the next tick should start.
  std::int64_t wake() const noexcept {
    return first_ ? due() : std::max(due(), previous_ + half_period_);
  }

  struct Start {
    std::int64_t lateness;               // after the deadline [ns]
    std::optional<std::int64_t> period;  // since the start of the tick before [ns]
    bool resynchronised;                 // hopelessly late: this tick became the new first one
  };
  Start start(std::int64_t now) noexcept {
    Start s{now - due(), {}, false};
    if (!first_) {
      s.period = now - previous_;
    }
    if (s.lateness > hopeless_) {
      s.resynchronised = true;
      anchor_ = now;
      index_ = 0;
    }
    first_ = false;
    previous_ = now;
    return s;
  }

  /// @returns whether the tick overran: ended after the deadline of the next one.
  bool end(std::int64_t now) noexcept {
    ++index_;
    return now > due();
  }

 private:
  // The deadline comes from the index each time, rounded to a nanosecond: no rounding adds up.
  std::int64_t due() const noexcept {
    return anchor_ + static_cast<std::int64_t>(static_cast<double>(index_) * period_ns_ + 0.5);
  }

  double period_ns_;
  std::int64_t half_period_;
  std::int64_t hopeless_;
  std::int64_t anchor_;     // deadline of tick 0
  std::uint64_t index_{0};  // of the tick that runs or is next, since the anchor
  bool first_{true};
  std::int64_t previous_{0};  // start of the tick before, unless first_
};

}  // namespace haptrial::realtime
