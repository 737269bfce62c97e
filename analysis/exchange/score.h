#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/record/read/session_reader_forward.h"

namespace haptrial::analysis {

/// A number that a pass is worth.
struct ScoreValue {
  int pass{0};        // row of /trials, from 0
  double value{0.0};  // finite; a pass without a value is left out
};

/// A quantity that an analysis computes from a session, beside the report of its protocol. It is
/// one object without state, and lives as long as the program.
class Score {
 public:
  virtual ~Score() = default;
  virtual std::string_view name() const = 0;  // unlike every other score's
  virtual std::string_view unit() const = 0;  // "N", "m"; "1" for a share
  /// The scores of one session in the order of its passes; none where the session is of another
  /// kind.
  /// @throws InputError for a session that should have been of it
  virtual std::vector<ScoreValue> values(const record::SessionReader& session) const = 0;
};

/// Scores in the order in which they were added. Call before threads are started.
const std::vector<const Score*>& scores();
/// @throws std::invalid_argument for a name that is empty or taken
void add_score(const Score& score);

/// Writes every score of the sessions as a table of the columns subject, session, pass, trial,
/// phase, score, value and unit. @returns how many values it has
/// @throws RunError if it cannot be written
int write_scores(const std::vector<std::filesystem::path>& sessions,
                 const std::filesystem::path& table);

}  // namespace haptrial::analysis
