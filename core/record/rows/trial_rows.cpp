#include "core/record/rows/trial_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "core/base/utf8.h"
#include "core/record/table/schema.h"

namespace haptrial::record {
namespace {

constexpr std::size_t kEndingBytes = 16;
constexpr std::size_t kPaceBytes = 16;
constexpr std::size_t kQuestionNameBytes = 64;

EnumText paces() {
  const auto entry = [](OutOfTime how, const char* word) {
    return EnumText::Entry{static_cast<std::uint8_t>(how), word};
  };
  return EnumText({entry(OutOfTime::kTooFast, "too fast"), entry(OutOfTime::kTooSlow, "too slow")});
}

EnumText endings() {
  const auto entry = [](StageEnding ending, const char* word) {
    return EnumText::Entry{static_cast<std::uint8_t>(ending), word};
  };
  return EnumText({entry(StageEnding::kReached, "reached"), entry(StageEnding::kLate, "late"),
                   entry(StageEnding::kTooLittle, "too little"),
                   entry(StageEnding::kBrokenOff, "broken off")});
}

}  // namespace

template <>
const Table<VariableRow>& table_of<VariableRow>() {
  using R = VariableRow;
  using T = Table<R>;
  static const T table(
      {"variables",
       "what the variables of the definition were worth",
       256,
       RowsOf::kPass,
       {"pass", "interval"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("interval", &R::interval, "1", "of the pass, from 1; 0: the same in all"),
       T::text("name", &R::name, kTrialWordBytes, "of the variable"),
       T::column("value", &R::value, "1", "its number, in the definition's unit; NaN: a word"),
       T::text("word", &R::word, kTrialWordBytes, "its word; empty: a number")});
  return table;
}

template <>
const Table<LevelRow>& table_of<LevelRow>() {
  using R = LevelRow;
  using T = Table<R>;
  static const T table(
      {"levels", "what a procedure asked for and learnt", 96, RowsOf::kPass, {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::text("track", &R::track, kTrialWordBytes, "the procedure's name"),
       T::text("variable", &R::variable, kTrialWordBytes, "the variable that it sets"),
       T::column("asked", &R::asked, "1", "the level asked for, in the definition's unit"),
       T::column("applied", &R::applied, "1",
                 "the level presented, quantised and within the range"),
       T::column("outcome", &R::outcome, "1", "what the procedure learnt; NaN: nothing")});
  return table;
}

template <>
const Table<StageRow>& table_of<StageRow>() {
  using R = StageRow;
  using T = Table<R>;
  static const T table(
      {"stages", "how the stages of each interval went", 224, RowsOf::kPass, {"pass", "interval"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("interval", &R::interval, "1", "of the pass, from 1"),
       T::text("stage", &R::stage, kTrialWordBytes, "the definition's name for it"),
       T::column("first_sample", &R::first_sample, "1", "first tick, as in /samples"),
       T::column("last_sample", &R::last_sample, "1", "last tick, as in /samples"),
       T::column("onset_sample", &R::onset_sample, "1", "tick at which a movement began; -1: none"),
       T::word("ending", &R::ending, kEndingBytes, endings(),
               "reached, late, too little or broken off"),
       T::column("most", &R::most, "1",
                 "largest value of what is required of the stage, in SI; NaN: nothing is")});
  return table;
}

template <>
const Table<AdaptationRow>& table_of<AdaptationRow>() {
  using R = AdaptationRow;
  using T = Table<R>;
  static const T table(
      {"adaptation",
       "what a virtual participant had adapted to by the end of a pass",
       352,
       RowsOf::kPass,
       {"pass"}},
      {T::column("pass", &R::pass, "1", "row of /trials"),
       T::column("fast", &R::fast, "1", "state of the fast process, as a share of the field"),
       T::column("slow", &R::slow, "1", "state of the slow process, likewise")});
  return table;
}

template <>
const Table<OutOfTimeRow>& table_of<OutOfTimeRow>() {
  using R = OutOfTimeRow;
  using T = Table<R>;
  static const T table({"out_of_time",
                        "one row for each answer that came too early or too late",
                        72,
                        RowsOf::kPass,
                        {"pass"}},
                       {T::column("pass", &R::pass, "1", "row of /trials"),
                        T::text("question", &R::question, kQuestionNameBytes, "as in /responses"),
                        T::word("how", &R::how, kPaceBytes, paces(), "too fast or too slow"),
                        T::column("reaction_time", &R::reaction_time, "s", "as in /responses"),
                        T::column("limit", &R::limit, "s", "the limit that it broke"),
                        T::column("again", &R::again, "1",
                                  "1: the trial counts as not presented and came again later")});
  return table;
}

const TableList& out_of_time_tables() {
  static const TableList tables{&table_of<OutOfTimeRow>()};
  return tables;
}

const TableList& adaptation_tables() {
  static const TableList tables{&table_of<AdaptationRow>()};
  return tables;
}

const TableList& trial_tables() {
  static const TableList tables{&table_of<VariableRow>(), &table_of<LevelRow>(),
                                &table_of<StageRow>()};
  return tables;
}

std::string condition_label(std::vector<std::string> levels) {
  constexpr std::string_view kBetween = ", ";
  const std::string whole = fmt::format("{}", fmt::join(levels, kBetween));
  if (whole.size() <= kConditionBytes) {
    return whole;
  }
  const std::size_t room = (kConditionBytes + kBetween.size()) / levels.size();
  const std::size_t share = room > kBetween.size() ? room - kBetween.size() : 1;
  for (std::string& level : levels) {
    level = cut_text(level, share);
  }
  return std::string(cut_text(fmt::format("{}", fmt::join(levels, kBetween)), kConditionBytes));
}

}  // namespace haptrial::record
