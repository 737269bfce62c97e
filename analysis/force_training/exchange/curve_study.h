#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/force_training/exchange/import_columns.h"
#include "analysis/statistics/design/analysis_plan.h"

namespace haptrial::exchange {

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
