#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "core/record/table/table.h"

namespace haptrial::channel {

inline constexpr std::size_t kMostQuantities = 64;  // of one channel

/// One thing that an instrument measures.
struct Quantity {
  std::string name;  // letters, digits and '_'
  std::string unit;  // "N", "V"; "1" for a pure number
};

/// A sample of a channel. Its time is an estimate (SampleClock), so that it comes with what it may
/// be wrong by.
struct ChannelRow {
  std::uint64_t sample{0};      // number from 0; what the instrument says it lost is left out
  std::int64_t time_ns{0};      // when it was measured, since the first tick of the session
  std::int64_t received_ns{0};  // when it had come, on the same clock
  double uncertainty{0.0};      // the time is within this of the truth in 95 % [s]
  double device_time{
      std::numeric_limits<double>::quiet_NaN()};  // by the instrument's own clock [s]
  std::array<double, kMostQuantities> values{};   // NaN: not measured
};

/// The table of one channel: /channel_NAME, with a column for each of its quantities.
class ChannelTable {
 public:
  /// @param chunk_rows  rows that are compressed together
  ChannelTable(const std::string& channel, const std::vector<Quantity>& quantities,
               std::size_t chunk_rows);
  const record::Table<ChannelRow>& table() const { return *table_; }

 private:
  std::vector<std::unique_ptr<const std::string>> texts_;  // to which the columns point
  std::unique_ptr<const record::Table<ChannelRow>> table_;
};

/// Something that befell a channel.
enum class Incident : std::uint8_t {
  kOpened,     // amount: samples a second, as far as it is known
  kLost,       // no data, or the connection is gone
  kBack,       // amount: seconds without data
  kGap,        // amount: samples that the instrument counted and that never came
  kRepeated,   // amount: samples that came again or too late, and were left out
  kMalformed,  // amount: bytes that made no sample
  kClockStep,  // amount: seconds by which the instrument's clock jumped ahead of the session's
  kStatus,     // amount: 0, or that of a fault of the instrument; the text says what it means
  kDropped,    // amount: samples for which the program had no room
  kMessage,  // the text is what the instrument said; amount: the time is within this of the truth,
             // 0 for the time at which it came [s]
  kClockOffset,  // amount: seconds to add to the instrument's times, as measured just now; the text
                 // has their uncertainty
};
const char* name_of(Incident what) noexcept;

/// A row of /channel_events.
struct IncidentRow {
  std::int64_t time_ns{0};  // since the first tick of the session
  std::string channel;
  Incident what{Incident::kOpened};
  double amount{0.0};
  std::string text;
};

}  // namespace haptrial::channel

namespace haptrial::record {

template <>
const Table<channel::IncidentRow>& table_of<channel::IncidentRow>();

}  // namespace haptrial::record
