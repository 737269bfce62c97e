#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/record/drilling_types.h"
#include "core/record/run_types.h"
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

  /// Likewise of /tool.
  std::size_t tool_pieces() const { return tool_pieces_.size(); }
  std::vector<ToolRow> tool(std::size_t piece) const;

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
  // Of drillings.
  std::vector<RemovalRow> removals;
  std::vector<CameraRow> camera;
  std::vector<SplitRow> splits;
  std::vector<BoneRow> bones;
  std::vector<StructureRow> structures;
  std::vector<BoneRunRow> bone_runs;
  std::vector<BoneDensityRow> bone_densities;
  std::vector<ProcedureRow> procedures;
  bool drills() const { return !tool_pieces_.empty() || !bones.empty() || !removals.empty(); }

 private:
  struct Piece {
    std::uint64_t offset{0};
    std::size_t rows{0};
    std::uint64_t first_sequence{0};
  };
  std::vector<std::uint8_t> inflated(const Piece& piece) const;
  template <class Row>
  static void keep_in_order(std::vector<Row>& rows, const std::vector<Piece>& pieces,
                            std::size_t piece);

  std::span<const std::uint8_t> file_;
  std::vector<Piece> pieces_;
  std::vector<Piece> tool_pieces_;
};

}  // namespace haptrial::record
