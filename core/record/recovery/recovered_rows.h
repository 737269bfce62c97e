#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/record/recovery/recovered_table.h"
#include "core/record/rows/session_types.h"

namespace haptrial::record {

/// Every row that the chunks of a file hold, in order and once. Samples stay compressed until they
/// are asked for: an hour of them takes half a gigabyte.
class RecoveredRows {
 public:
  /// @param file    outlives this
  /// @param tables  of protocols, some of which the file may have
  RecoveredRows(std::span<const std::uint8_t> file, const TableList& tables);

  std::size_t sample_pieces() const { return samples_.pieces(); }
  /// Samples of a piece in ascending order of sequence numbers, from piece to piece as well.
  std::vector<Sample> samples(std::size_t piece) const;

  std::vector<PassRow> passes;
  std::vector<EventRow> events;
  std::vector<StimulusRow> stimuli;
  std::vector<TimingRow> timing;
  std::vector<FrameRow> frames;
  std::vector<EventRow> attributes;
  std::optional<TimingSummary> summary;
  std::vector<RunRow> runs;
  std::vector<BegunRow> begun;
  std::map<std::string, std::uint64_t> counts;  // rows of each table as stored, by its name
  std::vector<RecoveredTable> own;              // tables of protocols, all that were given

  /// The tables of `own` that the file had: those with rows, and the others of their groups.
  TableList tables() const;
  /// Whether some table has a row for each tick: nothing can go on behind a tick that is missing.
  bool needs_each_tick() const;

 private:
  void take_session_rows(const std::vector<RecoveredTable>& session);

  RecoveredTable samples_;
};

/// Finds the chunks of our datasets in a file without its structure: each is a zlib stream with a
/// checksum, and its size when inflated tells its dataset.
///
/// @param longest  chunk when inflated [bytes]
/// Calls found(offset, raw) for each stream that is whole, in the order of the file; `raw` is
/// inflated, and valid until found() returns.
void scan_chunks(
    std::span<const std::uint8_t> file, std::size_t longest,
    const std::function<void(std::uint64_t offset, std::span<const std::uint8_t> raw)>& found);

}  // namespace haptrial::record
