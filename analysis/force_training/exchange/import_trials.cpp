#include "analysis/force_training/exchange/import_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "core/base/error.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;
using analysis::CsvTable;
using analysis::CurveColumns;

/// Trials that the rows of a table describe.
class TrialRows {
 public:
  TrialRows(const CurveStudy& study, const CsvTable& table)
      : columns_(study.columns), table_(table) {
    subject_ = columns_.place(table, "subject");
    trial_ = columns_.place(table, "trial");
    factors_ = study.factors;
    if (factors_.empty()) {
      factor_places_ = {columns_.place(table, "condition")};
      factors_ = {columns_.name("condition")};
      return;
    }
    if (!columns_.given("condition").empty()) {
      throw InputError("--column condition=... is given with --factor; leave one of them out");
    }
    for (const std::string& factor : factors_) {
      if (std::count(factors_.begin(), factors_.end(), factor) > 1) {
        throw InputError(fmt::format("--factor names {} twice; name each factor once", factor));
      }
      factor_places_.push_back(table.column(factor));
    }
  }

  const std::vector<std::string>& factors() const { return factors_; }
  std::size_t trial_column() const { return trial_; }

  bool is_test(std::size_t row) const {
    if (!columns_.has(table_, "phase")) {
      return true;
    }
    const std::size_t column = columns_.place(table_, "phase");
    const auto phase = table_.text(row, column);
    if (phase != "test" && phase != "training") {
      table_.refuse(row, column, "test or training");
    }
    return phase == "test";
  }

  ImportedTrial read(std::size_t row) const {
    ImportedTrial trial;
    trial.score.subject = name(row, subject_);
    for (const std::size_t factor : factor_places_) {
      trial.score.levels.push_back(name(row, factor));
    }
    trial.score.condition = fmt::format("{}", fmt::join(trial.score.levels, ", "));
    trial.score.trial = number(row, trial_);
    trial.score.block = optional_number(row, "block");
    trial.score.repetition = optional_number(row, "repetition");
    trial.simulated = columns_.has(table_, "simulated") && truth(row);
    return trial;
  }

  std::optional<double> rate(std::size_t row) const {
    if (!columns_.has(table_, "rate")) {
      return std::nullopt;
    }
    const std::size_t column = columns_.place(table_, "rate");
    const auto text = table_.text(row, column);
    if (text.empty()) {
      return std::nullopt;
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() ||
        !(value > 0.0 && value <= std::numeric_limits<double>::max())) {
      table_.refuse(row, column, "a number above 0 [Hz]");
    }
    return value;
  }

  std::string name(std::size_t row, std::size_t column) const {
    const auto text = table_.text(row, column);
    if (text.empty()) {
      table_.refuse(row, column, "a name");
    }
    return std::string(text);
  }

 private:
  std::int32_t optional_number(std::size_t row, const std::string& column) const {
    return columns_.has(table_, column) ? number(row, columns_.place(table_, column)) : 1;
  }

  std::int32_t number(std::size_t row, std::size_t column) const {
    const auto text = table_.text(row, column);
    std::int32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < 1) {
      table_.refuse(row, column, "a whole number from 1");
    }
    return value;
  }

  bool truth(std::size_t row) const {
    const std::size_t column = columns_.place(table_, "simulated");
    std::string text(table_.text(row, column));
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (text != "true" && text != "false" && text != "1" && text != "0") {
      table_.refuse(row, column, "true or false");
    }
    return text == "true" || text == "1";
  }

  const ImportColumns& columns_;
  const CsvTable& table_;
  std::size_t subject_{0}, trial_{0};
  std::vector<std::string> factors_;
  std::vector<std::size_t> factor_places_;
};

using Key = std::pair<std::string, std::int32_t>;

Key key_of(const ImportedTrial& trial) { return {trial.score.subject, trial.score.trial}; }

void require_tests(const CsvTable& table, bool any) {
  if (!any) {
    throw InputError(
        fmt::format("{}: has no row of the phase test; add at least one", table.name()));
  }
}

/// A table with a row for each trial, and the files that it names.
class FilesOfTrials final : public ImportedTrials {
 public:
  explicit FilesOfTrials(const CurveStudy& study) : study_(study) {
    const CsvTable table = CsvTable::load(study.table);
    const TrialRows rows(study, table);
    factors_ = rows.factors();
    const auto [target, applied] = file_columns(table);
    std::map<Key, std::pair<std::size_t, Files>> known;  // line, files
    for (std::size_t row = 0; row < table.rows(); ++row) {
      if (!rows.is_test(row)) {
        continue;
      }
      const ImportedTrial trial = rows.read(row);
      const Files files{study.folder / rows.name(row, target),
                        study.folder / rows.name(row, applied), rows.rate(row)};
      const auto [twin, is_new] = known.emplace(key_of(trial), std::pair(table.line(row), files));
      if (!is_new) {
        table.refuse(
            row, rows.trial_column(),
            fmt::format("a test that the table has once; line {} is of the same subject and trial",
                        twin->second.first));
      }
      trials_.push_back(trial);
    }
    require_tests(table, !trials_.empty());
    std::sort(trials_.begin(), trials_.end(),
              [](const auto& a, const auto& b) { return key_of(a) < key_of(b); });
    for (auto& [key, value] : known) {
      files_.push_back(std::move(value.second));
    }
  }

  ImportedCurves curves(std::size_t i) const override {
    const Files& files = files_[i];
    const bool one_file = files.target == files.applied;
    const ImportColumns& names = study_.columns;
    const auto columns = [&](const char* force) {
      return CurveColumns{names.given("time"), one_file ? names.name(force) : names.given(force),
                          files.rate};
    };
    const auto table = CsvTable::load(files.target);
    ImportedCurves curves;
    curves.target = read_curve(table, columns("target_force"));
    curves.applied = one_file ? read_curve(table, columns("applied_force"))
                              : read_curve(CsvTable::load(files.applied), columns("applied_force"));
    return curves;
  }

  std::string place(std::size_t i) const override { return files_[i].applied.string(); }

 private:
  struct Files {
    fs::path target;
    fs::path applied;  // as target, where one file holds both
    std::optional<double> rate;
  };

  std::pair<std::size_t, std::size_t> file_columns(const CsvTable& table) const {
    const ImportColumns& names = study_.columns;
    if (!names.has(table, "file")) {
      return {names.place(table, "target"), names.place(table, "applied")};
    }
    if (names.has(table, "target") || names.has(table, "applied")) {
      throw InputError(fmt::format(
          "{}: has a column file and one of target or applied; keep file, or both of the others",
          table.name()));
    }
    return {names.place(table, "file"), names.place(table, "file")};
  }

  const CurveStudy& study_;
  std::vector<Files> files_;  // (trials)
};

/// A table with a row for each sample.
class RowsOfTrials final : public ImportedTrials {
 public:
  explicit RowsOfTrials(const CurveStudy& study)
      : table_(CsvTable::load(study.table)), rows_(study, table_) {
    factors_ = rows_.factors();
    const ImportColumns& names = study.columns;
    if (!names.has(table_, "rate") || names.has(table_, "time")) {
      time_ = names.place(table_, "time");
    }
    target_ = names.place(table_, "target_force");
    applied_ = names.place(table_, "applied_force");
    std::map<Key, std::pair<ImportedTrial, std::vector<std::size_t>>> found;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      if (!rows_.is_test(row)) {
        continue;
      }
      ImportedTrial trial = rows_.read(row);
      auto& [first, samples] = found[key_of(trial)];
      if (samples.empty()) {
        first = std::move(trial);
      } else {
        require_same(trial, first, row, samples.front());
      }
      samples.push_back(row);
    }
    require_tests(table_, !found.empty());
    for (auto& [key, value] : found) {
      trials_.push_back(std::move(value.first));
      samples_.push_back(std::move(value.second));
    }
  }

  ImportedCurves curves(std::size_t i) const override {
    const auto& rows = samples_[i];
    if (rows.size() < 2) {
      throw InputError(fmt::format("{}:{}: is the only row of {}; allowed: at least two",
                                   table_.name(), table_.line(rows.front()), place(i)));
    }
    analysis::TableCurve curve;
    if (time_) {
      curve.times = table_.numbers(*time_, rows);
      require_increasing(curve.times, rows);
    } else {
      const auto rate = rows_.rate(rows.front());
      if (!rate) {
        throw InputError(fmt::format("{}:{}: has neither a time nor a rate; give one of them",
                                     table_.name(), table_.line(rows.front())));
      }
      curve.rate = *rate;
    }
    ImportedCurves curves{curve, curve};
    curves.target.values = table_.numbers(target_, rows);
    curves.applied.values = table_.numbers(applied_, rows);
    return curves;
  }

  std::string place(std::size_t i) const override {
    return fmt::format("{}, trial {}", trials_[i].score.subject, trials_[i].score.trial);
  }

 private:
  void require_same(const ImportedTrial& trial, const ImportedTrial& first, std::size_t row,
                    std::size_t first_row) const {
    const auto rest = [](const ImportedTrial& t) {
      return std::tie(t.score.levels, t.score.block, t.score.repetition, t.simulated);
    };
    if (rest(trial) != rest(first)) {
      table_.refuse(row, rows_.trial_column(),
                    fmt::format("rows of one condition, block and repetition in each trial; line "
                                "{} of the same subject and trial has others",
                                table_.line(first_row)));
    }
    if (!time_ && rows_.rate(row) != rows_.rate(first_row)) {
      throw InputError(fmt::format("{}:{}: has another rate than line {} of the same subject and "
                                   "trial; allowed: one rate in each trial, or a time in each row",
                                   table_.name(), table_.line(row), table_.line(first_row)));
    }
  }

  void require_increasing(const std::vector<double>& times,
                          const std::vector<std::size_t>& rows) const {
    for (std::size_t k = 1; k < times.size(); ++k) {
      if (!(times[k] > times[k - 1])) {
        table_.refuse(rows[k], *time_,
                      fmt::format("above {}, the time of line {} of the same subject and trial; "
                                  "each trial of a subject needs a number of its own",
                                  times[k - 1], table_.line(rows[k - 1])));
      }
    }
  }

  const CsvTable table_;
  const TrialRows rows_;
  std::optional<std::size_t> time_;
  std::size_t target_{0}, applied_{0};
  std::vector<std::vector<std::size_t>> samples_;  // (trials) rows of the table
};

}  // namespace

std::unique_ptr<ImportedTrials> read_trials(const CurveStudy& study) {
  if (study.folder.empty()) {
    return std::make_unique<RowsOfTrials>(study);
  }
  return std::make_unique<FilesOfTrials>(study);
}

}  // namespace haptrial::exchange
