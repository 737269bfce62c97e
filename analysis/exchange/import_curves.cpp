#include "analysis/exchange/import_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "analysis/csv.h"
#include "analysis/curve_csv.h"
#include "analysis/score.h"
#include "analysis/study_parts.h"
#include "core/base/error.h"

namespace haptrial::exchange {
namespace {

namespace fs = std::filesystem;
using analysis::CsvTable;
using analysis::CurveColumns;
using analysis::TrialScore;

/// A row of the table.
struct Trial {
  TrialScore score;
  bool simulated{false};
  fs::path target;
  fs::path applied;  // as target, where one file holds both
  std::optional<double> rate;
};

/// Reads the rows of the table.
class Conditions {
 public:
  explicit Conditions(const CurveStudy& study)
      : study_(study), table_(CsvTable::load(study.table)) {
    subject_ = table_.column("subject");
    trial_ = table_.column("trial");
    condition_ = table_.column("condition");
    if (table_.has("file") && (table_.has("target") || table_.has("applied"))) {
      throw InputError(
          fmt::format("{}: has a column file and one of target or applied; allowed: file, or both "
                      "of the others",
                      table_.name()));
    }
    target_ = table_.column(table_.has("file") ? "file" : "target");
    applied_ = table_.column(table_.has("file") ? "file" : "applied");
  }

  /// By subject, then trial.
  std::vector<Trial> trials() const {
    std::vector<Trial> result;
    std::map<std::pair<std::string, std::int32_t>, std::size_t> lines;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      if (!is_test(row)) {
        continue;
      }
      Trial trial = read(row);
      const auto [twin, is_new] =
          lines.emplace(std::pair(trial.score.subject, trial.score.trial), table_.line(row));
      if (!is_new) {
        table_.refuse(row, trial_,
                      fmt::format("a test that the table has once; line {} is of the same subject "
                                  "and trial",
                                  twin->second));
      }
      result.push_back(std::move(trial));
    }
    if (result.empty()) {
      throw InputError(fmt::format("{}: has no test; allowed: one or more", table_.name()));
    }
    std::sort(result.begin(), result.end(), [](const Trial& a, const Trial& b) {
      return std::tie(a.score.subject, a.score.trial) < std::tie(b.score.subject, b.score.trial);
    });
    return result;
  }

 private:
  bool is_test(std::size_t row) const {
    if (!table_.has("phase")) {
      return true;
    }
    const std::size_t column = table_.column("phase");
    const auto phase = table_.text(row, column);
    if (phase != "test" && phase != "training") {
      table_.refuse(row, column, "test or training");
    }
    return phase == "test";
  }

  Trial read(std::size_t row) const {
    Trial trial;
    trial.score.subject = name(row, subject_);
    trial.score.condition = name(row, condition_);
    trial.score.levels = {trial.score.condition};
    trial.score.trial = number(row, trial_);
    trial.score.block = table_.has("block") ? number(row, table_.column("block")) : 1;
    trial.score.repetition =
        table_.has("repetition") ? number(row, table_.column("repetition")) : 1;
    trial.target = study_.folder / name(row, target_);
    trial.applied = study_.folder / name(row, applied_);
    trial.simulated = table_.has("simulated") && truth(row, table_.column("simulated"));
    if (table_.has("rate") && !table_.text(row, table_.column("rate")).empty()) {
      trial.rate = rate(row, table_.column("rate"));
    }
    return trial;
  }

  std::string name(std::size_t row, std::size_t column) const {
    const auto text = table_.text(row, column);
    if (text.empty()) {
      table_.refuse(row, column, "a name");
    }
    return std::string(text);
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

  double rate(std::size_t row, std::size_t column) const {
    const auto text = table_.text(row, column);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() ||
        !(value > 0.0 && value <= std::numeric_limits<double>::max())) {
      table_.refuse(row, column, "a number above 0 [Hz]");
    }
    return value;
  }

  bool truth(std::size_t row, std::size_t column) const {
    std::string text(table_.text(row, column));
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    if (text != "true" && text != "false" && text != "1" && text != "0") {
      table_.refuse(row, column, "true or false");
    }
    return text == "true" || text == "1";
  }

  const CurveStudy& study_;
  CsvTable table_;
  std::size_t subject_{0}, trial_{0}, condition_{0}, target_{0}, applied_{0};
};

analysis::RecallDetail detail_of(const Trial& trial, const CurveStudy& study,
                                 const analysis::ScoreParameters& parameters) {
  const bool one_file = trial.target == trial.applied;
  const auto columns = [&](const std::string& given, const char* standard) {
    return CurveColumns{study.time_column, given.empty() && one_file ? standard : given,
                        trial.rate};
  };
  const auto target_table = CsvTable::load(trial.target);
  const auto target = read_curve(target_table, columns(study.target_column, "target_force"));
  const auto applied =
      one_file ? read_curve(target_table, columns(study.applied_column, "applied_force"))
               : read_curve(CsvTable::load(trial.applied),
                            columns(study.applied_column, "applied_force"));
  try {
    return analysis::align_curves(target.view(), applied.view(), parameters);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", trial.applied.string(), error.what()));
  }
}

void add_subjects(analysis::StudyResult& result, const std::vector<Trial>& trials) {
  for (const auto& trial : trials) {
    auto& sessions = result.sessions;
    if (sessions.empty() || sessions.back().info.subject != trial.score.subject) {
      sessions.emplace_back();
      sessions.back().file = result.curves_from;
      sessions.back().info.subject = trial.score.subject;
      sessions.back().info.simulated = false;
    }
    auto& session = sessions.back();
    session.info.simulated = session.info.simulated || trial.simulated;
    ++session.test_passes;
    ++session.scored;
  }
}

}  // namespace

analysis::StudyResult analyze_curves(const CurveStudy& study,
                                     const analysis::ScoreParameters& parameters, int jobs,
                                     const Watch& watch) {
  check(parameters);
  std::vector<Trial> trials = Conditions(study).trials();
  share_out(
      trials.size(), jobs,
      [&](std::size_t i, Counter& counter) {
        fill(trials[i].score, detail_of(trials[i], study, parameters).score);
        counter.add(1);
        counter.check();
      },
      watch);
  analysis::StudyResult result;
  result.curves_from = study.table.filename().string();
  for (const auto& trial : trials) {
    result.scores.push_back(trial.score);
  }
  add_subjects(result, trials);
  result.statistics = study_statistics(result.scores);
  for (const auto& [which, at] : analysis::notable(result.scores)) {
    result.recalls.push_back(
        recall_picture(which, result.scores[at], detail_of(trials[at], study, parameters)));
  }
  result.parameters = described(parameters);
  return result;
}

}  // namespace haptrial::exchange
