#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/channel/channel_row.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::analysis {

/// How well a session recorded one of its channels.
struct ChannelQuality {
  std::string name;
  std::uint64_t samples{0};
  std::uint64_t missing{0};         // that the instrument counted and that never came
  std::uint64_t losses{0};          // times that no data came any more
  std::uint64_t faults{0};          // that the instrument stated
  std::uint64_t clock_steps{0};     // of the instrument's clock
  std::uint64_t messages{0};        // texts that the instrument gave
  double first{0.0};                // time of the first sample, since the session's first tick [s]
  double seconds{0.0};              // from the first sample to the last
  std::uint64_t breaks{0};          // intervals between samples in which the channel was lost
  double silence{0.0};              // sum of these intervals [s]
  double uncertainty{0.0};          // of the samples' times, median [s]
  double largest_uncertainty{0.0};  // [s]

  /// Samples a second while the channel was there; 0 if there are less than two [Hz]
  double rate() const;
};

/// Incidents of a session's channels, each with its whole text, which may fill several rows of
/// /channel_events; none without channels.
std::vector<channel::IncidentRow> channel_incidents(const record::SessionReader& reader);

/// The channels of a session, in the order of their names; none without.
/// @throws InputError when the file is damaged.
std::vector<ChannelQuality> channel_quality(const record::SessionReader& reader);

}  // namespace haptrial::analysis
