#pragma once

#include <filesystem>
#include <vector>

#include "analysis/power/power_result.h"
#include "experiments/power/power_part.h"
#include "experiments/power/power_question.h"

namespace haptrial::experiments {

/// A folder whose parts are the state of a simulation: question.toml, parts/, and once all parts
/// are there the report. Any number of processes may fill it at once.
class PowerFolder {
 public:
  /// Makes the folder, or goes on with one of the same question.
  /// @throws InputError for a folder of another question or program, or that cannot be written
  PowerFolder(std::filesystem::path folder, const PowerQuestion& question);

  bool has(const PowerUnit& unit) const;
  /// Whole or not at all; a part that came meanwhile is replaced by the same bytes.
  /// @throws RunError in the words of the system, as on a full disk
  void keep(const PowerUnit& unit, const std::vector<SimulatedStudy>& replications) const;
  std::vector<PowerUnit> missing() const;
  const std::vector<PowerUnit>& units() const { return units_; }
  const std::filesystem::path& path() const { return folder_; }

  /// Everything that the parts say, part after part: the same for any order of their making. What
  /// killed processes left behind is removed.
  /// @throws InputError where parts are missing, damaged or of something else
  analysis::PowerResult merged() const;

  /// The question that a folder was made for. @throws InputError for a folder without one, or of
  /// another program
  static PowerQuestion question_of(const std::filesystem::path& folder);

 private:
  std::filesystem::path folder_;
  const PowerQuestion& question_;
  std::vector<PowerUnit> units_;
};

}  // namespace haptrial::experiments
