#include "analysis/psychophysics/data/trials_data.h"

#include <fmt/format.h>

#include <algorithm>

namespace haptrial::analysis::trials {

bool TrialsData::simulated() const {
  return std::any_of(sessions.begin(), sessions.end(),
                     [](const StudySession& session) { return session.simulated; });
}

const GivenAnswer* answer_to(const StudyTrial& trial, const std::string& question) {
  const auto at = std::find_if(trial.answers.begin(), trial.answers.end(), [&](const auto& each) {
    return question.empty() || each.question == question;
  });
  return at == trial.answers.end() ? nullptr : &*at;
}

const StageTime* last_stage(const StudyTrial& trial, const std::string& stage) {
  const auto at = std::find_if(trial.stages.rbegin(), trial.stages.rend(),
                               [&](const StageTime& each) { return each.stage == stage; });
  return at == trial.stages.rend() ? nullptr : &*at;
}

const GivenVariable* variable_of(const StudyTrial& trial, const std::string& name, int interval) {
  const auto at = std::find_if(
      trial.variables.begin(), trial.variables.end(),
      [&](const auto& each) { return each.name == name && each.interval == interval; });
  return at == trial.variables.end() ? nullptr : &*at;
}

std::string word_of(const GivenVariable& variable) {
  return variable.word.empty() ? fmt::format("{}", variable.value) : variable.word.text();
}

std::string factor_level(const TrialsData& data, const StudyTrial& trial,
                         const std::string& factor) {
  if (factor == "group") {
    return data.session_of(trial).group;
  }
  if (factor == "session") {
    const StudySession& session = data.session_of(trial);
    return session.name.empty() ? fmt::format("{}", session.session) : session.name;
  }
  if (factor == "condition") {
    return trial.condition;
  }
  if (factor == "probe") {
    return trial.probe;
  }
  if (factor == "track") {
    return trial.levels.empty() ? std::string() : trial.levels.front().track.text();
  }
  const GivenVariable* variable = variable_of(trial, factor);
  if (variable == nullptr && factor == "block") {
    return fmt::format("{}", trial.block);
  }
  return variable != nullptr ? word_of(*variable) : std::string();
}

}  // namespace haptrial::analysis::trials
