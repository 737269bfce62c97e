#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/record/session_types.h"

namespace haptrial::record {

/// Every row that the chunks of a file hold, in order and once. Samples stay compressed until they
/// are asked for: an hour of them takes half a gigabyte.
class RecoveredRows {
 public:
  /// @param file  outlives this
  explicit RecoveredRows(std::span<const std::uint8_t> file);

  std::size_t sample_pieces() const { return pieces_.size(); }
  /// In ascending order of sequence numbers, from piece to piece as well.
  std::vector<Sample> samples(std::size_t piece) const;

  std::vector<PassRow> passes;
  std::vector<EventRow> events;
  std::vector<StimulusRow> stimuli;
  std::vector<TimingRow> timing;
  std::vector<FrameRow> frames;
  std::vector<EventRow> attributes;
  std::optional<TimingSummary> summary;

 private:
  struct Piece {
    std::uint64_t offset{0};
    std::size_t rows{0};
    std::uint64_t first_sequence{0};
  };
  std::span<const std::uint8_t> file_;
  std::vector<Piece> pieces_;
};

}  // namespace haptrial::record
