#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

#include "core/channel/channel_row.h"
#include "core/channel/sample_clock.h"

namespace haptrial::channel {

/// One sample as an instrument gave it.
struct InstrumentSample {
  std::span<const double> values;  // in the order of the channel's quantities; NaN: not measured
  /// When it was measured, by the instrument's own clock; NaN: it has none [s]
  double device_time{std::numeric_limits<double>::quiet_NaN()};
  double waited{0.0};     // longest time that it may have lain there before it was read >= 0 [s]
  std::uint64_t lost{0};  // samples before it that the instrument counted and that never came
  /// When it was stamped, if the source itself knows that on the session's clock; `waited` and the
  /// estimate from `device_time` are then not used.
  std::optional<SampleTime> time{};
};

/// Takes what a source reads. The source's thread.
class ChannelInbox {
 public:
  virtual ~ChannelInbox() = default;
  /// A sample that has come just now.
  virtual void take(const InstrumentSample& sample) = 0;
  /// @param time_ns  when it happened, since the session's first tick; nothing: just now
  virtual void note(Incident what, double amount = 0.0, const std::string& text = "",
                    std::optional<std::int64_t> time_ns = {}) = 0;
  /// Time since the session's first tick [ns].
  virtual std::int64_t now() const = 0;
};

/// An instrument that is open. All members are called on the channel's own thread, so that they may
/// wait and allocate; a session waits for none of them. It closes when it is destroyed.
class ChannelSource {
 public:
  virtual ~ChannelSource() = default;
  /// Reads what comes within `patience`, and returns at once if something came.
  /// @throws RunError in one sentence if the instrument is lost; it is then opened anew
  virtual void read(ChannelInbox& into, std::chrono::milliseconds patience) = 0;
  /// Whether silence is no loss, as of events; read() then throws when the instrument is lost.
  virtual bool may_be_silent() const { return false; }
  /// Whether a silent instrument is opened anew, as one that may have restarted and waits for what
  /// is sent at the opening. Sources that find out by themselves throw in read().
  virtual bool is_reopened_when_silent() const { return false; }
  /// Whether samples wait for read() with their times. Others are read from the opening on, so that
  /// none of them is old when the session begins.
  virtual bool keeps_samples() const { return false; }
};

}  // namespace haptrial::channel
