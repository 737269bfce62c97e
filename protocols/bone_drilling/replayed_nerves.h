#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/bone/nerve/monitor.h"
#include "core/bone/nerve/recorded_voice.h"
#include "core/record/read/session_reader.h"

namespace haptrial::protocols {

/// Sound of a session's nerve monitor in one of its trials, from the session's file.
class ReplayedNerves {
 public:
  /// @param card  samples a second of the sound [Hz]
  ReplayedNerves(const std::filesystem::path& session, const nerve::MonitorParameters& monitor,
                 int trial, double card);

  /// The ticks of the trial in their order, as the file numbers them.
  void tick(std::uint64_t sequence);
  /// Adds the next samples to what is there.
  void mix(std::span<float> part) noexcept { voice_.mix(part); }

 private:
  std::span<const record::EmgRow> samples_of(std::uint64_t sequence);
  void load(std::uint64_t sequence);

  record::SessionReader reader_;
  bool heard_;  // by the participant, in this trial
  std::uint64_t count_;
  nerve::RecordedVoice voice_;
  std::vector<record::EmgRow> rows_;  // from next_ - rows_.size() on
  std::uint64_t next_{0};             // row to be read next
};

}  // namespace haptrial::protocols
