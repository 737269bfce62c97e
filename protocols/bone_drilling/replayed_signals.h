#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/bone/hint/chime.h"
#include "core/bone/hint/hint_rows.h"
#include "core/bone/nerve/monitor.h"
#include "core/bone/nerve/nerve_voice.h"
#include "core/bone/simulator/drilling_view.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::protocols {

/// The hints that a session's participant saw, from the session's file.
class ReplayedHints {
 public:
  explicit ReplayedHints(const record::SessionReader& session);

  /// Adds the hints of a tick to its view. The ticks of a trial in their order.
  /// @param vital  names of the bone's structures, as DrillingView::hint_structure counts them
  bone::DrillingView with(bone::DrillingView seen, std::uint64_t sequence,
                          std::span<const std::string> vital);
  /// Adds the next samples of the chimes to what is there.
  void mix(std::span<float> part) noexcept { chime_.mix(part); }

 private:
  std::vector<record::HintRow> shown_;  // by their beginnings
  std::uint8_t before_{0};              // kinds on the tick before
  hint::Chime chime_;
};

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
