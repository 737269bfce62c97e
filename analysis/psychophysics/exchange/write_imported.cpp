#include "analysis/psychophysics/exchange/write_imported.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/psychophysics/exchange/imported_definition.h"
#include "analysis/psychophysics/exchange/trial_columns.h"
#include "core/base/error.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_facts.h"
#include "core/record/rows/trial_rows.h"

namespace haptrial::analysis::trials {
namespace {

double number_or_nan(const std::string& text) {
  return number_in(text).value_or(std::numeric_limits<double>::quiet_NaN());
}

/// Writes the rows of trials, one after the other.
class SessionRows {
 public:
  SessionRows(record::SessionWriter& writer, const ImportedStudy& study, const ImportedNames& names)
      : writer_(writer), study_(study), names_(names) {}

  void add(const ImportedTrial& trial) {
    add_answers(trial);
    add_level(trial);
    if (!study_.columns.probe.empty()) {
      add_variable({row_, 0, "probe", std::numeric_limits<double>::quiet_NaN(),
                    trial.probe.empty() ? "no" : trial.probe});
    }
    for (std::size_t i = 0; i < trial.factors.size(); ++i) {
      const ImportedValue& value = trial.factors[i];
      add_variable({row_, 0, study_.columns.factors[i].variable, value.number, value.word});
    }
    record::PassRow pass;
    pass.trial = row_ + 1;
    pass.condition = condition_of(trial);
    pass.phase = record::Phase(record::kPresentedPhase);
    pass.block = trial.block;
    pass.repetition = ++repetitions_[trial.block];
    pass.first_sample = pass.last_sample = static_cast<std::uint64_t>(row_);
    writer_.add_pass(pass);
    ++row_;
  }

 private:
  /// The level of a factor that is called "condition", else the levels of all factors.
  std::string condition_of(const ImportedTrial& trial) const {
    std::vector<std::string> levels;
    for (std::size_t i = 0; i < trial.factors.size(); ++i) {
      const ImportedValue& value = trial.factors[i];
      levels.push_back(value.word.empty() ? fmt::format("{}", value.number) : value.word);
      if (study_.columns.factors[i].variable == "condition") {
        return record::condition_label({levels.back()});
      }
    }
    return levels.empty() ? "trials" : record::condition_label(std::move(levels));
  }

  void add_variable(const record::VariableRow& row) { writer_.add(std::span(&row, 1)); }

  void add_answers(const ImportedTrial& trial) {
    const std::string answer = answer_word(study_, trial);
    if (!answer.empty() && !names_.answer.empty()) {
      record::ResponseRow row = response(names_.answer);
      row.value = value_of(trial, answer);
      row.text = answer;
      row.correct = trial.correct;
      row.reaction_time = trial.time;
      writer_.add_response(row);
    } else if (std::isfinite(trial.time) && !names_.answer.empty() &&
               study_.columns.answer.empty() && study_.columns.correct.empty()) {
      record::ResponseRow row = response(names_.answer);  // a time is all that was measured
      row.reaction_time = trial.time;
      writer_.add_response(row);
    }
    if (!trial.rating.empty() && !names_.rating.empty()) {
      record::ResponseRow row = response(names_.rating);
      row.value = number_or_nan(trial.rating);
      row.text = trial.rating;
      writer_.add_response(row);
    }
  }

  record::ResponseRow response(const std::string& question) const {
    record::ResponseRow row;
    row.trial = row_ + 1;
    row.pass = row_;
    row.question = question;
    row.sequence = static_cast<std::uint64_t>(row_);
    return row;
  }

  double value_of(const ImportedTrial& trial, const std::string& answer) const {
    if (names_.choices.empty()) {
      return number_or_nan(answer);
    }
    const auto found = std::ranges::find(names_.choices, answer);
    if (found == names_.choices.end()) {
      throw InputError(
          fmt::format("{}:{}: the answer is '{}'; allowed: {}, the choices of the "
                      "definition's {}",
                      study_.sources[trial.source].name, trial.line, answer,
                      fmt::join(names_.choices, ", "), names_.answer));
    }
    return names_.first + static_cast<double>(found - names_.choices.begin());
  }

  void add_level(const ImportedTrial& trial) {
    if (!std::isfinite(trial.level) || names_.level.empty()) {
      return;
    }
    add_variable({row_, 0, names_.level, trial.level, ""});
    if (!names_.level_is_set || !trial.probe.empty()) {
      return;
    }
    double outcome = trial.outcome;
    if (!std::isfinite(outcome)) {
      outcome = trial.correct >= 0 ? trial.correct : number_or_nan(trial.answer);
    }
    const record::LevelRow row{row_,         trial.track.empty() ? names_.track : trial.track,
                               names_.level, trial.level,
                               trial.level,  outcome};
    writer_.add(std::span(&row, 1));
  }

  record::SessionWriter& writer_;
  const ImportedStudy& study_;
  const ImportedNames& names_;
  std::map<int, int> repetitions_;  // by block
  std::int32_t row_{0};
};

}  // namespace

void write_imported(const std::filesystem::path& file, const record::SessionInfo& info,
                    const ImportedStudy& study, const std::vector<const ImportedTrial*>& trials,
                    const ImportedNames& names, const record::TableList& tables) {
  record::SessionWriter writer(file, info, tables);
  SessionRows rows(writer, study, names);
  for (const ImportedTrial* trial : trials) {
    rows.add(*trial);
  }
  const ImportSource& source = study.sources[trials.front()->source];
  const TableOrigin origin = study.columns.origin;
  writer.add_event(
      {0, record::kImportedEvent,
       fmt::format(
           "{}{}, SHA-256 {}", source.name,
           origin == TableOrigin::kPlain ? std::string() : fmt::format(" of {}", name_of(origin)),
           source.sha256)});
  writer.set_planned(static_cast<std::int32_t>(trials.size()));
  writer.set_timing({}, {0, 0, 0});
  writer.close();
}

}  // namespace haptrial::analysis::trials
