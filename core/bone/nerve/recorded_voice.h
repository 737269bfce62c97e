#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bone/nerve/monitor.h"
#include "core/bone/nerve/nerve_rows.h"
#include "core/bone/nerve/nerve_voice.h"

namespace haptrial::nerve {

/// The sound of a nerve monitor from what a session file has of it: its electromyograms, and a tone
/// from the beginning of an event until the monitor closed it. One thread.
class RecordedVoice {
 public:
  struct Record {
    std::vector<record::NerveEventRow> events;          // by tick at which they were closed
    std::vector<record::NerveThresholdRow> thresholds;  // by tick
  };
  /// @param channels  of the monitor  @param card  samples a second of the sound [Hz]
  RecordedVoice(Record record, const MonitorParameters& monitor, std::size_t channels, double card);

  /// The ticks in their order. @param samples  of the tick  @param heard  by the participant
  void tick(std::uint64_t sequence, std::span<const record::EmgRow> samples, bool heard);
  /// Adds the next samples to what is there.
  void mix(std::span<float> part) noexcept { voice_.mix(part); }

 private:
  bool tone(std::size_t channel, std::uint64_t sequence) const;

  Record record_;
  MonitorParameters monitor_;
  std::size_t channels_;
  NerveVoice voice_;
  std::array<bool, kMostChannels> muted_{};
  std::size_t next_setting_{0};
};

}  // namespace haptrial::nerve
