#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/files/csv.h"
#include "analysis/statistics/design/analysis_plan.h"

namespace haptrial::exchange {

/// The columns that an import reads, each by the name that it has in the tables: its own unless
/// given another.
class ImportColumns {
 public:
  ImportColumns() = default;
  /// @param given  "subject=Participant" each.
  /// @throws InputError for a column that no import reads, one that is given twice, or another
  /// form.
  explicit ImportColumns(const std::vector<std::string>& given);

  /// Name that was given to the column; empty if none was.
  const std::string& given(const std::string& column) const;
  std::string name(const std::string& column) const;
  /// Whether the table has it; a column whose name was given is always looked for.
  bool has(const analysis::CsvTable& table, const std::string& column) const;
  /// @returns its place. @throws InputError when the table has no such column.
  std::size_t place(const analysis::CsvTable& table, const std::string& column) const;

 private:
  std::map<std::string, std::string> names_;
};

/// All columns that an import reads.
const std::vector<std::string>& import_columns();

/// A study that something else recorded (docs/guide-analyst.md), in one of two forms:
///
/// - `folder` holds the curves (.csv), and `table` has a row for each trial;
/// - without a folder `table` holds everything, a row for each sample.
///
/// Columns of the table, each under the name that `columns` gives it:
///
///     subject, trial, condition     required; `factors` in place of condition
///     file                          both curves, below the folder; or `target` and `applied`
///     block, repetition             from 1; 1 where the table has no such column
///     phase                         "test" is scored and "training" is not; all are tests without
///     rate                          of the curves [Hz], which then need no column of times
///     simulated                     true or false; false without
///
/// and of the curves, in files of their own or in the table: time [s], target_force and
/// applied_force [N].
struct CurveStudy {
  std::filesystem::path folder;  // empty: the table holds the samples
  std::filesystem::path table;
  ImportColumns columns{};
  std::vector<std::string> factors{};  // names of columns; empty: the one column condition
  analysis::AnalysisPlan plan{};
};

}  // namespace haptrial::exchange
