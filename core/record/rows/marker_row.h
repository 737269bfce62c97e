#pragma once

#include <cstdint>
#include <limits>
#include <string>

#include "core/record/table/table.h"

namespace haptrial::record {

/// Event that begins at a marker.
enum class MarkerOf : std::uint8_t { kTrial, kInterval, kStage, kResponse };
const char* name_of(MarkerOf what) noexcept;

/// Output that a marker went to.
enum class MarkerOutput : std::uint8_t {
  kNone,    // nowhere: a simulated session, or nothing is connected
  kSerial,  // a serial line
  kStream,  // the Lab Streaming Layer
  kScreen,  // the photodiode's square
  kSound,   // the sound that begins with it
  kNeon,    // an event of an eye tracker's recording
};
const char* name_of(MarkerOutput way) noexcept;

/// An onset and where it went, a row of /markers: one for each way.
struct MarkerRow {
  std::int32_t pass{0};      // row of /trials
  std::int32_t trial{0};     // as in /trials
  std::int32_t interval{0};  // of the pass, from 1; 0: none
  MarkerOf what{MarkerOf::kTrial};
  std::string name;           // of the interval, stage or answer
  std::int32_t code{0};       // 1 to 255
  std::uint64_t sequence{0};  // of the tick
  std::int64_t time_ns{0};    // of the tick, since the first one of the session
  MarkerOutput way{MarkerOutput::kNone};
  double written{std::numeric_limits<double>::quiet_NaN()};  // when, on the same clock [s]
  double latency{std::numeric_limits<double>::quiet_NaN()};  // from the tick on [s]
  std::int64_t frame{-1};  // of this run's screen, from 0; -1: not the screen
};

/// Most bytes of a marker's name.
inline constexpr std::size_t kMarkerNameBytes = 64;

template <>
const Table<MarkerRow>& table_of<MarkerRow>();

}  // namespace haptrial::record
