#pragma once

#include <filesystem>
#include <string>

#include "analysis/exchange/export_sessions.h"
#include "analysis/study.h"

namespace haptrial::exchange {

/// A study that something else recorded: a folder of curves (.csv) and a table that says of which
/// trial each is (docs/guide-analyst.md). The table has a row for each trial and the columns
///
///     subject, trial, condition     required
///     file                          both curves, below the folder; or `target` and `applied`
///     block, repetition             from 1; 1 where the table has no such column
///     phase                         "test" is scored and "training" is not; all are tests without
///     rate                          of the curves [Hz], which then need no column of times
///     simulated                     true or false; false without
struct CurveStudy {
  std::filesystem::path folder;
  std::filesystem::path table;
  std::string time_column{};     // empty: "time"
  std::string target_column{};   // empty: "target_force" of a `file`, the only other of a `target`
  std::string applied_column{};  // empty: "applied_force", likewise
};

/// Scores and tests such a study as analyze_study() does that of session files. What only session
/// files hold (tracking, timing, device, stimulus) stays empty, and StudyResult::curves_from says
/// so.
/// @throws InputError, with file and line, for whatever a table or curve has that it should not.
analysis::StudyResult analyze_curves(const CurveStudy& study,
                                     const analysis::ScoreParameters& parameters, int jobs,
                                     const Watch& watch);

}  // namespace haptrial::exchange
