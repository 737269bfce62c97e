#include "analysis/psychophysics/data/trials_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "analysis/files/delimited.h"

namespace haptrial::analysis::trials {
namespace {

using exchange::RowText;

const std::vector<std::string>& fixed_columns() {
  static const std::vector<std::string> names{
      "participant", "group",     "session",   "file",     "simulated", "pilot",   "trial",
      "attempt",     "block",     "condition", "probe",    "practice",  "status",  "counted",
      "start",       "saturated", "track",     "variable", "asked",     "applied", "outcome"};
  return names;
}

/// Names in the order in which they first occur.
template <class Key>
void note(std::vector<Key>& keys, const Key& key) {
  if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
    keys.push_back(key);
  }
}

/// The columns that depend on the study.
struct Columns {
  std::vector<std::string> dimensions;  // variables of levels, where there are several
  std::vector<std::string> questions;
  std::vector<std::string> limited;  // questions with an answer that was too fast or too slow
  std::vector<std::pair<std::string, int>> variables;  // with interval
  std::vector<std::pair<std::string, int>> stages;     // likewise
};

Columns columns_of(const TrialsData& data) {
  Columns columns;
  std::size_t most = 0;
  for (const StudyTrial& trial : data.trials) {
    most = std::max(most, trial.levels.size());
    for (const GivenLevel& level : trial.levels) {
      note(columns.dimensions, level.variable.text());
    }
    for (const GivenAnswer& answer : trial.answers) {
      note(columns.questions, answer.question.text());
      if (!answer.out_of_time.empty()) {
        note(columns.limited, answer.question.text());
      }
    }
    for (const GivenVariable& variable : trial.variables) {
      note(columns.variables, std::pair(variable.name.text(), variable.interval));
    }
    for (const StageTime& stage : trial.stages) {
      note(columns.stages, std::pair(stage.stage.text(), int{stage.interval}));
    }
  }
  if (most < 2) {
    columns.dimensions.clear();
  }
  std::sort(columns.stages.begin(), columns.stages.end(),
            [](const auto& a, const auto& b) { return a.second < b.second; });
  return columns;
}

/// Heading in which no name stands twice.
class Heading {
 public:
  explicit Heading(std::string& text) : row_(text, exchange::Delimited::kCsv) {}
  void add(std::string name) {
    while (!used_.insert(name).second) {
      name += "_";
    }
    row_.add(name);
  }
  void end() { row_.end(); }

 private:
  RowText row_;
  std::set<std::string> used_;
};

void add_heading(std::string& text, const Columns& columns) {
  Heading heading(text);
  for (const std::string& name : fixed_columns()) {
    heading.add(name);
  }
  for (const std::string& name : columns.dimensions) {
    heading.add("asked." + name);
    heading.add("applied." + name);
  }
  for (const std::string& name : columns.questions) {
    heading.add(name);
    heading.add(name + ".text");
    heading.add(name + ".correct");
    heading.add(name + ".rt");
  }
  for (const std::string& name : columns.limited) {
    heading.add(name + ".out_of_time");
  }
  for (const auto& [name, interval] : columns.variables) {
    heading.add(interval == 0 ? name == "block" ? "block.name" : name
                              : fmt::format("{}.{}", name, interval));
  }
  for (const auto& [name, interval] : columns.stages) {
    heading.add(fmt::format("{}.{}.s", name, interval));
  }
  heading.end();
}

void add_levels(RowText& row, const StudyTrial& trial, const Columns& columns) {
  if (trial.levels.empty()) {
    row.add_missing().add_missing().add_missing().add_missing().add_missing();
  } else {
    const GivenLevel& level = trial.levels.front();
    row.add(level.track).add(level.variable).add(level.asked).add(level.applied);
    row.add(level.outcome);
  }
  for (const std::string& name : columns.dimensions) {
    const auto at = std::find_if(trial.levels.begin(), trial.levels.end(),
                                 [&](const GivenLevel& each) { return each.variable == name; });
    const bool there = at != trial.levels.end();
    row.add(there ? at->asked : kNotKnown).add(there ? at->applied : kNotKnown);
  }
}

void add_answers(RowText& row, const StudyTrial& trial, const Columns& columns) {
  for (const std::string& name : columns.questions) {
    const GivenAnswer* answer = answer_to(trial, name);
    if (answer == nullptr) {
      row.add_missing().add_missing().add_missing().add_missing();
      continue;
    }
    row.add(answer->value).add(answer->text);
    answer->correct < 0 ? row.add_missing() : row.add(answer->correct);
    row.add(answer->reaction_time);
  }
  for (const std::string& name : columns.limited) {
    const GivenAnswer* answer = answer_to(trial, name);
    answer == nullptr ? row.add_missing() : row.add(answer->out_of_time);
  }
}

void add_trial(std::string& text, const TrialsData& data, const StudyTrial& trial,
               const Columns& columns) {
  RowText row(text, exchange::Delimited::kCsv);
  const StudySession& session = data.session_of(trial);
  row.add(session.participant).add(session.group).add(session.session).add(session.file);
  row.add(session.simulated ? 1 : 0).add(session.pilot ? 1 : 0);
  row.add(trial.trial).add(trial.attempt).add(trial.block).add(trial.condition).add(trial.probe);
  row.add(trial.practice ? 1 : 0);
  row.add(!trial.completed ? "aborted"
          : trial.again    ? "out of time"
          : trial.damaged  ? "damaged"
          : trial.left_out ? "marked as bad"
                           : "completed");
  row.add(trial.counts() ? 1 : 0).add(trial.start).add(trial.saturated);
  add_levels(row, trial, columns);
  add_answers(row, trial, columns);
  for (const auto& [name, interval] : columns.variables) {
    const GivenVariable* variable = variable_of(trial, name, interval);
    if (variable == nullptr) {
      row.add_missing();
    } else if (variable->word.empty()) {
      row.add(variable->value);
    } else {
      row.add(variable->word);
    }
  }
  for (const auto& [name, interval] : columns.stages) {
    // The last one counts: an interval that was repeated has stages of the same name before it.
    const auto at = std::find_if(trial.stages.rbegin(), trial.stages.rend(), [&](const auto& s) {
      return s.stage == name && s.interval == interval;
    });
    row.add(at != trial.stages.rend() ? static_cast<double>(at->ticks) / session.rate : kNotKnown);
  }
  row.end();
}

}  // namespace

void trials_csv(const TrialsData& data, const std::function<void(const std::string&)>& take) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // [bytes]
  const Columns columns = columns_of(data);
  std::string text;
  add_heading(text, columns);
  for (const StudyTrial& trial : data.trials) {
    add_trial(text, data, trial, columns);
    if (text.size() >= kPiece) {
      take(text);
      text.clear();
    }
  }
  take(text);
}

}  // namespace haptrial::analysis::trials
