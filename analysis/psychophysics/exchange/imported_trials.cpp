#include "analysis/psychophysics/exchange/imported_trials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>

#include "analysis/files/csv.h"
#include "analysis/files/sha256.h"
#include "core/base/alike_names.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/record/rows/trial_rows.h"

namespace haptrial::analysis::trials {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostName = 32;  // bytes of an identifier
constexpr int kMostCount = 100'000;

/// The places of the columns in one table; none for a role that it has not.
class TableRows {
 public:
  TableRows(const CsvTable& table, const TrialColumns& columns, std::string own_name)
      : table_(table), columns_(columns), own_name_(std::move(own_name)) {
    for (const auto& [role, member] : TrialColumns::roles()) {
      if (const std::string& column = columns.*member; !column.empty()) {
        places_[member_key(member)] = table.column(column);
      }
    }
    for (const FactorColumn& factor : columns.factors) {
      factors_.push_back(table.column(factor.column));
    }
    for (const RowFilter& filter : columns.filters) {
      filters_.push_back(table.column(filter.column));
    }
  }

  bool passes_filters(std::size_t row) const {
    for (std::size_t i = 0; i < filters_.size(); ++i) {
      const std::string_view text = table_.text(row, filters_[i]);
      const auto& wanted = columns_.filters[i].value;
      if (wanted ? !is_same(text, *wanted) : is_missing(text)) {
        return false;
      }
    }
    return true;
  }

  /// Whether anything was presented or answered in a row.
  bool is_trial(std::size_t row) const {
    using C = TrialColumns;
    for (const auto member : {&C::level, &C::answer, &C::correct, &C::time}) {
      if (const auto at = place(member); at && !is_missing(table_.text(row, *at))) {
        return true;
      }
    }
    return std::ranges::any_of(factors_,
                               [&](std::size_t at) { return !is_missing(table_.text(row, at)); });
  }

  /// The word of a row that is read as no answer; empty for an answer, and for none.
  std::string_view missing_answer(std::size_t row) const {
    const auto at = place(&TrialColumns::answer);
    const std::string_view text = at ? table_.text(row, *at) : std::string_view();
    return is_missing(text) ? text : std::string_view();
  }

  /// @throws InputError as CsvTable::refuse_thousands() does
  void check_numbers() const {
    using C = TrialColumns;
    std::vector<std::size_t> columns = factors_;
    for (const Member member : {&C::level, &C::time, &C::outcome, &C::rating, &C::answer}) {
      if (const auto at = place(member)) {
        columns.push_back(*at);
      }
    }
    for (const std::size_t at : columns) {
      std::vector<std::size_t> rows;
      for (std::size_t row = 0; row < table_.rows(); ++row) {
        if (!is_missing(table_.text(row, at))) {
          rows.push_back(row);
        }
      }
      table_.refuse_thousands(at, rows);
    }
  }

  ImportedTrial trial(std::size_t row) const {
    using C = TrialColumns;
    ImportedTrial trial;
    trial.line = table_.line(row);
    trial.participant = participant(row);
    trial.session = count(row, &C::session);
    trial.block = count(row, &C::block);
    trial.track = word(row, &C::track);
    trial.probe = word(row, &C::probe);
    trial.probe = trial.probe == "no" ? "" : trial.probe;
    trial.level = trial.probe.empty() ? number(row, &C::level) : optional_number(row, &C::level);
    trial.answer = word(row, &C::answer);
    trial.rating = word(row, &C::rating);
    trial.outcome = optional_number(row, &C::outcome);
    trial.time = time(row);
    const bool answered = columns_.answer.empty() || !trial.answer.empty();
    trial.correct = answered ? truth(row, &C::correct) : -1;
    trial.simulated = truth(row, &C::simulated) == 1;
    for (const std::size_t at : factors_) {
      trial.factors.push_back(value(row, at));
    }
    return trial;
  }

 private:
  using Member = std::string TrialColumns::*;
  static std::size_t member_key(Member member) {
    const auto& roles = TrialColumns::roles();
    const auto at = std::ranges::find(roles, member, [](const auto& each) { return each.second; });
    return static_cast<std::size_t>(at - roles.begin());
  }

  /// 1.0 is 1: programs write it so where a column has gaps.
  static bool is_same(std::string_view text, std::string_view wanted) {
    const auto number = number_in(text), other = number_in(wanted);
    return text == wanted || (number && other && *number == *other);
  }

  std::optional<std::size_t> place(Member member) const {
    const auto found = places_.find(member_key(member));
    return found == places_.end() ? std::nullopt : std::optional(found->second);
  }

  std::string participant(std::size_t row) const {
    const auto at = place(&TrialColumns::participant);
    const std::string name(at ? table_.text(row, *at) : std::string_view(own_name_));
    const bool allowed =
        !name.empty() && name.size() <= kMostName && std::ranges::all_of(name, [](unsigned char c) {
          return c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '_');
        });
    if (!allowed && at) {
      table_.refuse(row, *at, "1 to 32 letters, digits, '-' and '_'");
    }
    if (!allowed) {
      throw InputError(
          fmt::format("{}: has no column of participants, and its name is no identifier; allowed: "
                      "--column participant=COLUMN, or a name of 1 to 32 letters, digits, '-' and "
                      "'_'",
                      table_.name()));
    }
    return name;
  }

  int count(std::size_t row, Member member) const {
    const auto at = place(member);
    if (!at) {
      return 1;
    }
    const auto value = number_in(table_.text(row, *at));
    if (!value || *value < 1.0 || *value > kMostCount || *value != std::floor(*value)) {
      table_.refuse(row, *at, "a whole number from 1 on; --column session= or block= does without");
    }
    return static_cast<int>(*value);
  }

  std::string word(std::size_t row, Member member) const {
    const auto at = place(member);
    if (!at || is_missing(table_.text(row, *at))) {
      return "";
    }
    const std::string_view text = unwrapped(table_.text(row, *at));
    if (text.size() > record::kTrialWordBytes) {
      table_.refuse(row, *at, "at most 64 bytes");
    }
    return std::string(text);
  }

  double number(std::size_t row, Member member) const {
    const auto at = place(member);
    if (!at) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const auto value = number_in(table_.text(row, *at));
    if (!value) {
      table_.refuse(row, *at, "a finite number; rows that are no trials go by --only COLUMN=VALUE");
    }
    return *value;
  }

  double optional_number(std::size_t row, Member member) const {
    const auto at = place(member);
    return at && is_missing(table_.text(row, *at)) ? std::numeric_limits<double>::quiet_NaN()
                                                   : number(row, member);
  }

  double time(std::size_t row) const {
    const auto at = place(&TrialColumns::time);
    const auto text = at ? unwrapped(table_.text(row, *at)) : std::string_view();
    if (is_missing(text)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const auto value = number_in(text);
    if (!value || *value < 0.0) {
      table_.refuse(row, *at, "a number of at least 0, or nothing");
    }
    return *value * columns_.time_unit;
  }

  /// 1, 0, or -1 without the column.
  int truth(std::size_t row, Member member) const {
    const auto at = place(member);
    if (!at) {
      return -1;
    }
    const std::string text = lower_case(table_.text(row, *at));
    constexpr std::array<std::string_view, 6> kRight{"1", "1.0", "true", "yes", "right", "correct"};
    constexpr std::array<std::string_view, 6> kWrong{"0",  "0.0",   "false",
                                                     "no", "wrong", "incorrect"};
    if (std::ranges::find(kRight, text) != kRight.end()) {
      return 1;
    }
    if (std::ranges::find(kWrong, text) == kWrong.end()) {
      table_.refuse(row, *at,
                    "1 or 0, true or false, right or wrong; rows that are no trials go by --only "
                    "COLUMN=VALUE");
    }
    return 0;
  }

  /// The number, if it is one, beside its text; settle_factors() keeps one of them.
  ImportedValue value(std::size_t row, std::size_t at) const {
    const std::string_view text = table_.text(row, at);
    if (is_missing(text) || text.size() > record::kTrialWordBytes) {
      table_.refuse(row, at,
                    is_missing(text)
                        ? "a level: this is what programs write where there is none; write another "
                          "word, or leave the rows out by --only COLUMN=VALUE"
                        : "a number or a word of at most 64 bytes; rows that are no trials go by "
                          "--only COLUMN=VALUE");
    }
    return {number_in(text).value_or(std::numeric_limits<double>::quiet_NaN()), std::string(text)};
  }

  const CsvTable& table_;
  const TrialColumns& columns_;
  std::string own_name_;
  std::map<std::size_t, std::size_t> places_;  // role to column
  std::vector<std::size_t> factors_, filters_;
};

/// The loops of PsychoPy that a row was written in, "blocks and trials"; empty: none.
std::string loops_around(const CsvTable& table, const std::vector<std::string>& loops,
                         std::size_t row) {
  std::vector<std::string> around;
  for (const std::string& loop : loops) {
    if (!is_missing(table.text(row, table.column(loop + std::string(kLoopNumber))))) {
      around.push_back(loop);
    }
  }
  return fmt::format("{}", fmt::join(around, " and "));
}

void read_table(const fs::path& file, ImportedStudy& study) {
  const std::string text = file_text(file);
  const CsvTable table = CsvTable::parse(text, file.string());
  const std::size_t source = study.sources.size();
  study.sources.push_back({file.filename().string(), sha256_of(text)});
  const TableRows rows(table, study.columns, file.stem().string());
  rows.check_numbers();
  const std::vector<std::string> loops = loops_of(table);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (!rows.passes_filters(row) || !rows.is_trial(row)) {
      ++study.left_out;
      continue;
    }
    ++study.loops[loops_around(table, loops, row)];
    ImportedTrial trial = rows.trial(row);
    trial.source = source;
    const bool answered = study.columns.answer.empty() ? trial.correct >= 0 : !trial.answer.empty();
    study.unanswered += answered ? 0 : 1;
    if (const auto word = rows.missing_answer(row); !word.empty()) {
      ++study.missing_answers[std::string(word)];
    }
    study.trials.push_back(std::move(trial));
  }
}

/// Warns of numbers that are written in several ways: 01 and 1 may have been meant as two codes.
void warn_of_spellings(ImportedStudy& study, std::size_t factor) {
  std::map<double, std::set<std::string>> spellings;
  for (const ImportedTrial& trial : study.trials) {
    spellings[trial.factors[factor].number].insert(trial.factors[factor].word);
  }
  for (const auto& [number, texts] : spellings) {
    if (texts.size() > 1) {
      study.warnings.push_back(
          fmt::format("WARNING: {} in {} are the same number and are taken for one level.",
                      fmt::join(texts, ", "), study.columns.factors[factor].column));
    }
  }
}

/// A factor with a word somewhere has words everywhere, each as its field spells it.
void settle_factors(ImportedStudy& study) {
  for (std::size_t f = 0; f < study.columns.factors.size(); ++f) {
    const bool words = std::ranges::any_of(study.trials, [&](const ImportedTrial& trial) {
      return std::isnan(trial.factors[f].number);
    });
    if (!words) {
      warn_of_spellings(study, f);
    }
    for (ImportedTrial& trial : study.trials) {
      ImportedValue& value = trial.factors[f];
      value = words ? ImportedValue{std::numeric_limits<double>::quiet_NaN(), value.word}
                    : ImportedValue{value.number, ""};
    }
  }
}

/// Answers, or ratings, that are all numbers are spelled in one way, the shortest there is:
/// programs write 1.0 for 1 where a column has gaps.
void settle_numbers(ImportedStudy& study, std::string ImportedTrial::*member, const char* what) {
  std::map<double, std::set<std::string>> spellings;
  for (const ImportedTrial& trial : study.trials) {
    const std::string& text = trial.*member;
    const auto number = number_in(text);
    if (!number && !text.empty()) {
      return;
    }
    if (number) {
      spellings[*number].insert(text);
    }
  }
  for (ImportedTrial& trial : study.trials) {
    if (const auto number = number_in(trial.*member)) {
      trial.*member = *std::ranges::min_element(spellings.at(*number), {}, &std::string::size);
    }
  }
  for (const auto& [number, texts] : spellings) {
    if (texts.size() > 1) {
      study.warnings.push_back(
          fmt::format("WARNING: {} are the same number and are taken for one {}.",
                      fmt::join(texts, ", "), what));
    }
  }
}

void warn_of_alike(ImportedStudy& study, const std::string& what,
                   const std::set<std::string>& names) {
  const auto warnings = alike_names_warnings(what, {names.begin(), names.end()});
  study.warnings.insert(study.warnings.end(), warnings.begin(), warnings.end());
}

/// Warns of names that may have been meant as one.
void warn_of_alike_names(ImportedStudy& study) {
  std::set<std::string> people, answers;
  std::vector<std::set<std::string>> levels(study.columns.factors.size());
  for (const ImportedTrial& trial : study.trials) {
    people.insert(trial.participant);
    answers.insert(trial.answer);
    for (std::size_t f = 0; f < levels.size(); ++f) {
      levels[f].insert(trial.factors[f].word);
    }
  }
  warn_of_alike(study, "participants", people);
  warn_of_alike(study, "answers", answers);
  for (std::size_t f = 0; f < levels.size(); ++f) {
    warn_of_alike(study, "levels of " + study.columns.factors[f].column, levels[f]);
  }
}

/// Warns of words in the answers' column that are taken for no answer.
void warn_of_missing(ImportedStudy& study) {
  for (const auto& [text, count] : study.missing_answers) {
    study.warnings.push_back(fmt::format(
        "WARNING: in {} '{}' is read as no answer, in {}; if it is one, write another word.",
        study.columns.answer, text, counted(count, "trial", "trials")));
  }
}

/// Warns of trials of several loops, such as practice and what follows it.
void warn_of_loops(ImportedStudy& study) {
  std::vector<std::string> all;
  for (const auto& [loops, count] : study.loops) {
    all.push_back(
        fmt::format("{} ({})", loops.empty() ? "none" : loops, counted(count, "trial", "trials")));
  }
  if (all.size() > 1) {
    study.warnings.push_back(
        fmt::format("WARNING: trials of several loops are put together: {}; if one is practice, "
                    "--only LOOP{} takes those of another alone.",
                    fmt::join(all, ", "), kLoopNumber));
  }
}

/// Warns of reaction times that nobody has, as of milliseconds under a name that says seconds.
void warn_of_unit(ImportedStudy& study) {
  constexpr double kLongest = 30.0;    // [s]
  constexpr double kShortest = 0.020;  // [s]
  std::vector<double> times;
  for (const ImportedTrial& trial : study.trials) {
    if (std::isfinite(trial.time)) {
      times.push_back(trial.time);
    }
  }
  if (times.empty()) {
    return;
  }
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::ranges::nth_element(times, middle);
  if (*middle > kLongest || *middle < kShortest) {
    const bool long_ones = *middle > kLongest;
    study.warnings.push_back(
        fmt::format("WARNING: half of the reaction times in {} are {} {:.3g} s; are these {}? "
                    "--time-unit says the unit.",
                    study.columns.time, long_ones ? "at least" : "at most", *middle,
                    long_ones ? "milliseconds" : "seconds"));
  }
}

/// PsychoPy writes a file for each session, and people seldom change its number.
void refuse_twins(const ImportedStudy& study) {
  std::map<std::pair<std::string, int>, std::size_t> owner;
  for (const ImportedTrial& trial : study.trials) {
    const auto [at, is_new] =
        owner.emplace(std::pair{trial.participant, trial.session}, trial.source);
    if (!is_new && at->second != trial.source) {
      throw InputError(fmt::format(
          "{}:{}: session {} of {} is also in {}; allowed: each session in one table, with its "
          "number in the column that --column session=COLUMN names",
          study.sources[trial.source].name, trial.line, trial.session, trial.participant,
          study.sources[at->second].name));
    }
  }
}

void check_columns(const TrialColumns& columns) {
  if (columns.answer.empty() && columns.correct.empty() && columns.time.empty() &&
      columns.level.empty()) {
    throw InputError(
        "no column says what was answered; name it: --column answer=COLUMN, correct=COLUMN or "
        "time=COLUMN");
  }
  if (!columns.time.empty() && !(columns.time_unit > 0.0)) {
    throw InputError(fmt::format(
        "{} may be seconds or milliseconds; add --time-unit s or --time-unit ms", columns.time));
  }
}

}  // namespace

ImportedStudy read_trial_tables(const std::vector<fs::path>& files, const TrialColumns& columns) {
  check_columns(columns);
  ImportedStudy study;
  study.columns = columns;
  for (const fs::path& file : files) {
    read_table(file, study);
  }
  if (study.trials.empty()) {
    throw InputError(fmt::format("{}: no row is a trial; the filters of --only leave none",
                                 files.front().string()));
  }
  settle_factors(study);
  settle_numbers(study, &ImportedTrial::answer, "answer");
  settle_numbers(study, &ImportedTrial::rating, "rating");
  warn_of_alike_names(study);
  warn_of_missing(study);
  warn_of_loops(study);
  warn_of_unit(study);
  refuse_twins(study);
  return study;
}

}  // namespace haptrial::analysis::trials
