#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/channel/channel.h"
#include "core/channel/channel_options.h"
#include "core/device/device.h"
#include "core/record/rows/rows.h"

namespace haptrial::channel {

/// Why the channels of a session stop its devices.
enum class Alarm : std::uint8_t {
  kNone,
  kLost,    // a channel that the session needs
  kBeyond,  // a value is beyond the limit that its channel states
};

/// The channels of a session: their tables, and their values one after the other. On a simulated
/// clock each quantity is a sine (SimulatedInput) and no instrument is opened, so that a dry run is
/// a function of its definition.
class ChannelSet {
 public:
  /// @param tables  that the session's file may have beside those of the channels; the chunks of
  /// each table have a length of their own, by which recovery tells them apart
  /// @param real    whether instruments are opened
  /// @throws std::invalid_argument if the chunks of these tables may be of one size
  ChannelSet(const std::vector<ChannelOptions>& options, const record::TableList& tables,
             bool real);

  /// The channels' own tables, and that of their incidents; none without channels.
  record::TableList tables() const;

  /// Opens the instruments and waits for each to answer; their data count from begin() on. Call
  /// before anything is recorded. @param first  number of the first sample
  /// of each channel: it goes on from an earlier run; empty: from 0. Session's thread.
  /// @returns a sentence for each that does not answer
  /// @throws RunError if the session needs it
  std::vector<std::string> start(const Channel::Now& now, const std::vector<std::uint64_t>& first);
  /// The session's clock runs. Session's thread.
  void begin();
  /// Gives the rows that have come to `put`. @param now_ns  time of the session. Session's thread.
  void collect(std::int64_t now_ns, const std::function<void(const record::Rows&)>& put);
  /// Losses, returns and faults since the last call, in sentences. Session's thread.
  std::vector<std::string> take_news();

  /// Takes the newest values. @param time_ns  of the tick, since the session's first. Servo thread:
  /// wait-free.
  void take(std::int64_t time_ns) noexcept;
  /// The values that take() took: each quantity of each channel, in their order; NaN where there is
  /// none. Servo thread.
  std::span<const double> values() const noexcept { return values_; }
  /// Every value that has come since the take() before the last, in the order of its channel. Servo
  /// thread.
  std::span<const device::ArrivedValue> arrived() const noexcept { return arrived_; }
  Alarm alarm() const noexcept { return alarm_; }
  /// The alarm in a sentence, a text that lasts as long as the set. Servo thread.
  const char* sentence() const noexcept { return sentence_; }

  /// Newest values of a channel for a console. Any thread but the servo thread.
  struct Seen {
    const ChannelOptions* options{nullptr};
    ChannelState state;
  };
  std::vector<Seen> seen() const;

 private:
  struct Part {
    ChannelOptions options;
    std::unique_ptr<ChannelTable> table;
    std::unique_ptr<Channel> channel;  // null on a simulated clock
    std::size_t at{0};                 // of its first value in values_
    std::uint64_t judged{0};           // samples beyond the limit (ChannelState::beyond)
    bool missing{false};               // start() named it, and its loss is no news
    std::uint64_t next{0};             // simulated samples so far
    std::string lost;                  // sentences of its alarms
    std::vector<std::string> beyond;   // of each quantity
  };
  void simulate(Part& part, std::int64_t now_ns,
                const std::function<void(const record::Rows&)>& put);
  void take_arrived(Part& part, std::int64_t time_ns) noexcept;
  void judge(const Part& part, bool lost, std::optional<std::size_t> beyond) noexcept;

  std::vector<Part> parts_;
  bool real_;
  std::vector<double> values_;
  std::vector<device::ArrivedValue> arrived_;  // never grows after start()
  Alarm alarm_{Alarm::kNone};
  const char* sentence_{""};
  std::vector<std::string> news_;
};

}  // namespace haptrial::channel
