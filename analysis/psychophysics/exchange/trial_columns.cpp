#include "analysis/psychophysics/exchange/trial_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <span>

#include "analysis/files/csv.h"
#include "core/base/error.h"
#include "core/base/nearest.h"

namespace haptrial::analysis::trials {
namespace {

using Names = std::span<const char* const>;
using Column = std::string TrialColumns::*;

/// The first of some names that a column has, whatever its case; empty: none has.
std::string named(const CsvTable& table, Names names) {
  for (const char* name : names) {
    const auto found =
        std::ranges::find(table.columns(), name, [](const auto& each) { return lower_case(each); });
    if (found != table.columns().end()) {
      return *found;
    }
  }
  return "";
}

/// The names of the columns with an ending, without it.
std::vector<std::string> stems(const CsvTable& table, std::string_view ending) {
  std::vector<std::string> found;
  for (const std::string& column : table.columns()) {
    if (column.ends_with(ending)) {
      found.push_back(column.substr(0, column.size() - ending.size()));
    }
  }
  return found;
}

/// The only column with an ending; empty: none has it, or several have.
std::string only(const CsvTable& table, std::string_view ending) {
  const std::vector<std::string> found = stems(table, ending);
  return found.size() == 1 ? found.front() + std::string(ending) : "";
}

constexpr std::array<const char*, 11> kParticipants{
    "participant",    "participant_id", "subject",      "subject_id",         "subj", "observer",
    "participant id", "subject id",     "prolific_pid", "participant_number", "id"};
constexpr std::array<const char*, 2> kSessions{"session", "session_number"};
constexpr std::array<const char*, 3> kBlocks{"block", "block_number", "block_index"};
constexpr std::array<const char*, 2> kTracks{"track", "staircase"};
constexpr std::array<const char*, 4> kLevels{"level", "intensity", "stimulus_level", "stim_level"};
constexpr std::array<const char*, 5> kAnswers{"response", "answer", "choice", "key_press", "resp"};
constexpr std::array<const char*, 6> kCorrect{"correct",  "is_correct", "corr",
                                              "accuracy", "acc",        "right"};
constexpr std::array<const char*, 8> kTimes{"rt",   "reaction_time", "response_time", "rt_ms",
                                            "rt_s", "reaction time", "rt (ms)",       "rt (s)"};
constexpr std::array<const char*, 3> kRatings{"rating", "confidence", "conf"};

/// PsychoPy names what a component wrote COMPONENT.keys, COMPONENT.corr and COMPONENT.rt; of
/// several components the one with right answers is meant.
void guess_component(const CsvTable& table, TrialColumns& columns) {
  const std::vector<std::string> judged = stems(table, ".corr");
  std::string component = judged.size() == 1 ? judged.front() : "";
  for (const char* ending : {".keys", ".response", ".clicked_name"}) {
    const std::string column =
        component.empty() ? only(table, ending) : component + std::string(ending);
    if (columns.answer.empty() && !column.empty() && table.has(column)) {
      columns.answer = column;
      component = column.substr(0, column.size() - std::string_view(ending).size());
    }
  }
  const auto beside = [&](const char* ending) {
    const std::string column = component + ending;
    return !component.empty() && table.has(column) ? column : std::string();
  };
  columns.correct = beside(".corr");
  columns.time = beside(".rt");
}

void guess_psychopy(const CsvTable& table, TrialColumns& columns) {
  columns.time_unit = 1.0;
  guess_component(table, columns);
  if (const std::string level = only(table, ".intensity"); !level.empty()) {
    columns.level = level;
  }
  if (const std::string track = only(table, ".label"); !track.empty()) {
    columns.track = track;
  }
}

TableOrigin origin_of(const CsvTable& table) {
  if (table.has("psychopyVersion") || table.has("expName") ||
      !stems(table, ".thisTrialN").empty()) {
    return TableOrigin::kPsychoPy;
  }
  return table.has("trial_type") && table.has("time_elapsed") ? TableOrigin::kJsPsych
                                                              : TableOrigin::kPlain;
}

/// A unit that the name of a column has at its end, "rt_ms" or "rt (s)" [s]; 0: none.
double unit_in(const std::string& column) {
  const std::string name = lower_case(column);
  for (const char* ending : {"_ms", "(ms)", "[ms]"}) {
    if (name.ends_with(ending)) {
      return 1e-3;
    }
  }
  for (const char* ending : {"_s", "(s)", "[s]"}) {
    if (name.ends_with(ending)) {
      return 1.0;
    }
  }
  return 0.0;
}

/// Both sides of the first "="; without one the right side is the whole.
std::pair<std::string, std::string> sides(std::string_view setting) {
  const auto at = setting.find('=');
  return at == setting.npos
             ? std::pair{std::string(setting), std::string(setting)}
             : std::pair{std::string(setting.substr(0, at)), std::string(setting.substr(at + 1))};
}

bool is_variable(std::string_view name) {
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::ranges::all_of(
             name, [](unsigned char c) { return (c < 128 && std::isalnum(c) != 0) || c == '_'; });
}

/// Names by which the analysis knows something else than a variable.
constexpr std::array<std::string_view, 8> kTaken{"group", "probe",    "track",   "trial",
                                                 "block", "interval", "session", "level"};

}  // namespace

const char* name_of(TableOrigin origin) {
  return origin == TableOrigin::kPsychoPy  ? "PsychoPy"
         : origin == TableOrigin::kJsPsych ? "jsPsych"
                                           : "a plain table";
}

const std::vector<std::pair<const char*, Column>>& TrialColumns::roles() {
  using C = TrialColumns;
  static const std::vector<std::pair<const char*, Column>> all{{"participant", &C::participant},
                                                               {"session", &C::session},
                                                               {"block", &C::block},
                                                               {"track", &C::track},
                                                               {"level", &C::level},
                                                               {"answer", &C::answer},
                                                               {"correct", &C::correct},
                                                               {"time", &C::time},
                                                               {"rating", &C::rating},
                                                               {"probe", &C::probe},
                                                               {"outcome", &C::outcome},
                                                               {"simulated", &C::simulated}};
  return all;
}

TrialColumns guess_columns(const CsvTable& table) {
  TrialColumns columns;
  columns.origin = origin_of(table);
  columns.participant = named(table, kParticipants);
  columns.session = named(table, kSessions);
  columns.level = named(table, kLevels);
  columns.rating = named(table, kRatings);
  columns.simulated = table.has("simulated") ? "simulated" : "";
  if (columns.origin == TableOrigin::kPsychoPy) {
    guess_psychopy(table, columns);
    return columns;
  }
  columns.answer = named(table, kAnswers);
  columns.correct = named(table, kCorrect);
  columns.time = named(table, kTimes);
  if (columns.origin == TableOrigin::kJsPsych) {
    columns.time_unit = 1e-3;
    return columns;
  }
  columns.block = named(table, kBlocks);
  columns.track = named(table, kTracks);
  columns.time_unit = unit_in(columns.time);
  return columns;
}

void set_column(std::string_view setting, TrialColumns& columns) {
  const auto [role, column] = sides(setting);
  const auto& roles = TrialColumns::roles();
  const auto found = std::ranges::find(roles, role, [](const auto& each) { return each.first; });
  if (found == roles.end() || setting.find('=') == setting.npos) {
    std::vector<std::string> known;
    for (const auto& [name, member] : roles) {
      known.emplace_back(name);
    }
    const std::string hint = did_you_mean(role, known);
    throw InputError(fmt::format("--column is '{}'{} allowed: ROLE=COLUMN, where ROLE is {}",
                                 setting, hint.empty() ? ";" : hint, fmt::join(known, ", ")));
  }
  columns.*found->second = column;
  const double unit = role == "time" ? unit_in(column) : 0.0;
  if (unit > 0.0 || (role == "time" && columns.origin == TableOrigin::kPlain)) {
    columns.time_unit = unit;  // not that of the column before
  }
}

void add_factor(std::string_view setting, TrialColumns& columns) {
  const auto [variable, column] = sides(setting);
  if (!is_variable(variable)) {
    throw InputError(fmt::format(
        "--factor is '{}'; allowed: NAME=COLUMN, where NAME has letters, digits and '_'", setting));
  }
  if (std::ranges::find(kTaken, variable) != kTaken.end()) {
    throw InputError(
        fmt::format("--factor is '{0}', and the analysis knows something else as {1}; allowed: "
                    "another name, as in {1}_factor={2}",
                    setting, variable, column));
  }
  const auto twin = std::ranges::find(columns.factors, variable, &FactorColumn::variable);
  if (twin != columns.factors.end()) {
    throw InputError(fmt::format("--factor gives {} twice; give each factor once", variable));
  }
  columns.factors.push_back({variable, column});
}

void add_filter(std::string_view setting, TrialColumns& columns) {
  const auto [column, value] = sides(setting);
  const bool any = setting.find('=') == setting.npos;
  columns.filters.push_back({column, any ? std::nullopt : std::optional(value)});
}

std::vector<std::string> loops_of(const CsvTable& table) { return stems(table, kLoopNumber); }

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string_view unwrapped(std::string_view text) {
  const bool list = text.size() > 2 && text.front() == '[' && text.back() == ']';
  if (list && text.find(',') == text.npos) {
    text = text.substr(1, text.size() - 2);
  }
  const bool quoted = text.size() > 2 && text.front() == text.back() &&
                      (text.front() == '\'' || text.front() == '"');
  return quoted ? text.substr(1, text.size() - 2) : text;
}

bool is_missing(std::string_view text) {
  constexpr std::array<std::string_view, 12> kMissing{
      "", ".", "null", "NULL", "None", "NA", "N/A", "n/a", "NaN", "nan", "undefined", "[]"};
  return std::ranges::find(kMissing, text) != kMissing.end();
}

}  // namespace haptrial::analysis::trials
