#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/record/rows/rows.h"
#include "core/record/table/table.h"

namespace haptrial::record {

inline constexpr std::size_t kEmgChannels = 8;
/// Electromyograms are recorded in multiples of this [V], half of their noise: finer steps would
/// store noise alone.
inline constexpr double kEmgResolution = 0x1p-19;

/// A channel of a nerve monitor, a row of /nerve_channels.
struct NerveChannelRow {
  std::int32_t channel{0};  // from 0
  std::string name;         // of the muscle
  std::string nerve;
  double rate{0.0};  // of its samples [Hz]
};

/// One sample of all channels, a row of /nerve_emg.
struct EmgRow {
  std::uint64_t sequence{0};                    // of the tick
  std::uint8_t sample{0};                       // of the tick, from 0
  std::array<double, kEmgChannels> channels{};  // [V]
};

/// A detected event, a row of /nerve_events.
struct NerveEventRow {
  enum class Kind : std::uint8_t { kBurst, kTrain, kResponse, kArtefact };
  std::uint64_t sequence{0};  // of the tick at which the monitor closed it
  std::int32_t channel{0};
  Kind kind{Kind::kBurst};
  std::uint64_t begin{0};  // tick
  std::uint64_t end{0};    // likewise, inclusive
  double peak{0.0};        // [V]
  double threshold{0.0};   // when it ended [V]
  double train_time{0.0};  // of its trains [s]
  bool heard{false};       // by the participant
};

/// How a channel was set from a tick on, a row of /nerve_thresholds.
struct NerveThresholdRow {
  enum class Cause : std::uint8_t { kStart, kMonitor, kTechnician };
  std::uint64_t sequence{0};
  std::int32_t channel{0};
  double threshold{0.0};  // [V]
  bool muted{false};
  Cause cause{Cause::kStart};
};

/// A discharge that was put into the electromyograms, a row of /nerve_discharges: the truth that
/// events are held against.
struct NerveDischargeRow {
  std::uint64_t sequence{0};  // of the tick on which it began
  std::int32_t channel{0};    // -1: all
  NerveEventRow::Kind kind{NerveEventRow::Kind::kBurst};
  std::uint64_t end{0};   // tick of its last sample
  double amplitude{0.0};  // peak [V]
  double distance{0.0};   // of the tool's surface from the nerve [m]
  double warmth{0.0};     // of the nerve, above the body's [K]
  double current{0.0};    // of the pulse that it answers to [A]; 0: none
};

/// A technician's setting of the probe, or a pulse of it, a row of /nerve_stimuli.
struct NerveStimulusRow {
  enum class Kind : std::uint8_t { kSet, kPulse, kSearch, kFound, kOutOfRange };
  std::uint64_t sequence{0};  // of the tick
  Kind kind{Kind::kSet};
  std::int32_t channel{-1};  // whose threshold is searched; -1: none
  double current{0.0};       // [A]
};

template <>
const Table<NerveChannelRow>& table_of<NerveChannelRow>();
template <>
const Table<EmgRow>& table_of<EmgRow>();
template <>
const Table<NerveEventRow>& table_of<NerveEventRow>();
template <>
const Table<NerveThresholdRow>& table_of<NerveThresholdRow>();
template <>
const Table<NerveDischargeRow>& table_of<NerveDischargeRow>();
template <>
const Table<NerveStimulusRow>& table_of<NerveStimulusRow>();

/// The tables of a nerve monitor, in the order in which they are created.
const TableList& nerve_tables();

/// Rows on their way to the file.
struct NerveRows {
  std::vector<EmgRow> emg;
  std::vector<NerveEventRow> events;
  std::vector<NerveThresholdRow> thresholds;
  std::vector<NerveDischargeRow> discharges;
  std::vector<NerveStimulusRow> stimuli;

  void append(const NerveRows& more);
  void clear();
};

}  // namespace haptrial::record
