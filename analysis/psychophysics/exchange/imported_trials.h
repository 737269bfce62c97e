#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "analysis/psychophysics/exchange/trial_columns.h"

namespace haptrial::analysis::trials {

/// Value of a factor: a number, or a word if the column holds any.
struct ImportedValue {
  double number{std::numeric_limits<double>::quiet_NaN()};  // NaN: it is a word
  std::string word;
};

/// One row of a table that is a trial.
struct ImportedTrial {
  std::size_t source{0};  // of the study's sources
  std::size_t line{0};    // of its file, from 1
  std::string participant;
  int session{1};
  int block{1};
  bool simulated{false};
  std::string track;
  std::string probe;  // empty: it is no catch trial
  double level{std::numeric_limits<double>::quiet_NaN()};
  std::string answer;                                        // empty: none was given
  int correct{-1};                                           // 1 right, 0 wrong, -1 not known
  double time{std::numeric_limits<double>::quiet_NaN()};     // reaction time [s]; NaN: not known
  std::string rating;                                        // empty: none
  double outcome{std::numeric_limits<double>::quiet_NaN()};  // NaN: not stated
  std::vector<ImportedValue> factors;                        // (factors of the columns)
};

/// A file that trials came from.
struct ImportSource {
  std::string name;    // without folder
  std::string sha256;  // of its bytes, hexadecimal
};

/// The trials of one or several tables, in the order of files and lines.
struct ImportedStudy {
  TrialColumns columns;
  std::vector<ImportSource> sources;
  std::vector<ImportedTrial> trials;
  std::size_t left_out{0};                             // rows that are no trials
  std::size_t unanswered{0};                           // trials without an answer
  std::map<std::string, std::size_t> missing_answers;  // trials by the word read as no answer
  std::map<std::string, std::size_t> loops;  // trials by the loops of PsychoPy around them
  std::vector<std::string> warnings;         // of what may not have been meant; each a sentence
};

/// Reads tables of one study. A row without a value in all of the columns that say what was
/// presented or answered is no trial, and is counted.
/// @param columns  with factors and filters; roles that are stated replace guesses
/// @throws InputError  FILE:LINE: COLUMN is 'FOUND'; allowed: ALLOWED
///   for a field that cannot be read; also for a column that is absent, a time without a unit, a
///   participant's session that two tables have, and no trials at all
ImportedStudy read_trial_tables(const std::vector<std::filesystem::path>& files,
                                const TrialColumns& columns);

}  // namespace haptrial::analysis::trials
