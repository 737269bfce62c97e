#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/record/table/table.h"

namespace haptrial::record {

/// The only phase of a trial that a definition states: everything of it is one pass.
inline constexpr const char* kPresentedPhase = "presented";

/// The value of a name of the definition, given by the trial or stated, a row of /variables.
struct VariableRow {
  std::int32_t pass{0};      // row of /trials
  std::int32_t interval{0};  // of the pass, from 1; 0: the same in all of them
  std::string name;
  double value{std::numeric_limits<double>::quiet_NaN()};  // NaN: it is a word
  std::string word;                                        // empty: it is a number
};

/// Level that a procedure asked for, and its outcome, a row of /levels; a level with several
/// dimensions has a row for each.
struct LevelRow {
  std::int32_t pass{0};  // row of /trials
  std::string track;     // the definition's name for it
  std::string variable;
  double asked{0.0};                                         // [unit of the variable]
  double applied{0.0};                                       // quantised, within the range [same]
  double outcome{std::numeric_limits<double>::quiet_NaN()};  // that it learnt; NaN: none
};

/// How a stage went, a row of /stages.
enum class StageEnding : std::uint8_t { kReached, kLate, kTooLittle, kBrokenOff };
struct StageRow {
  std::int32_t pass{0};      // row of /trials
  std::int32_t interval{0};  // of the pass, from 1
  std::string stage;
  std::uint64_t first_sample{0};  // sequence numbers, both inclusive
  std::uint64_t last_sample{0};
  std::int64_t onset_sample{-1};  // of the movement; -1: none was seen or asked for
  StageEnding ending{StageEnding::kReached};
  double most{std::numeric_limits<double>::quiet_NaN()};  // of what is required; NaN: nothing is
};

/// Adaptation of a virtual participant to a field by the end of a pass, in shares of the field
/// (core/subject/perceiver/two_rate.h); a row of /adaptation. A resumed session goes on from it.
struct AdaptationRow {
  std::int32_t pass{0};  // row of /trials
  double fast{0.0};
  double slow{0.0};
};

/// An answer that came before `too_fast` or after `too_slow` of its question, a row of
/// /out_of_time.
enum class OutOfTime : std::uint8_t { kTooFast, kTooSlow };
struct OutOfTimeRow {
  std::int32_t pass{0};  // row of /trials
  std::string question;
  OutOfTime how{OutOfTime::kTooFast};
  double reaction_time{0.0};  // as in /responses [s]
  double limit{0.0};          // that it broke [s]
  bool again{false};          // the trial counts as not presented and came again
};

/// Most bytes of a name or word of a definition.
inline constexpr std::size_t kTrialWordBytes = 64;

template <>
const Table<VariableRow>& table_of<VariableRow>();
template <>
const Table<LevelRow>& table_of<LevelRow>();
template <>
const Table<StageRow>& table_of<StageRow>();
template <>
const Table<AdaptationRow>& table_of<AdaptationRow>();
template <>
const Table<OutOfTimeRow>& table_of<OutOfTimeRow>();

/// Tables that every session of trials has, in the order in which they are created.
const TableList& trial_tables();
/// The one that only sessions of virtual participants who adapt have.
const TableList& adaptation_tables();
/// The one of sessions whose questions limit reaction times.
const TableList& out_of_time_tables();

/// The condition of a trial by the levels of its factors: joined by ", ". If they have more than
/// kConditionBytes, each is cut to its share of them, so that its beginning stays.
std::string condition_label(std::vector<std::string> levels);

}  // namespace haptrial::record
