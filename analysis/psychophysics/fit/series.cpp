#include "analysis/psychophysics/fit/series.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/psychophysics/fit/surface_study.h"

namespace haptrial::analysis::trials {
namespace {

/// The two answers of a question in the whole study, in alphabetical order; fewer or more: none.
std::vector<std::string> two_answers(const TrialsData& data, const TrialsPlan& plan) {
  std::vector<std::string> words;
  for (const StudyTrial& trial : data.trials) {
    const GivenAnswer* answer = answer_to(trial, plan.question);
    if (trial.counts() && answer != nullptr && !answer->text.empty() &&
        std::find(words.begin(), words.end(), answer->text) == words.end()) {
      words.push_back(answer->text);
    }
  }
  std::sort(words.begin(), words.end());
  return words.size() == 2 ? words : std::vector<std::string>{};
}

void add_choice(LevelTrial& made, const StudyTrial& trial, const TrialsPlan& plan,
                const std::vector<std::string>& words) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  if (answer == nullptr || words.empty()) {
    return;
  }
  made.choice = answer->text == words.back() ? 1 : -1;
  made.side = made.outcome == 1 ? made.choice : -made.choice;
}

}  // namespace

std::string AnsweredSeries::condition() const { return fmt::format("{}", fmt::join(levels, ", ")); }

bool sets_other_level(const StudyTrial& trial, const TrialsPlan& plan) {
  return plan.level_is_set && !trial.levels.empty() &&
         std::ranges::none_of(
             trial.levels, [&](const GivenLevel& level) { return level.variable == plan.level; });
}

double level_of(const StudyTrial& trial, const TrialsPlan& plan) {
  if (plan.level.empty()) {
    return trial.levels.empty() ? kNotKnown : trial.levels.front().applied;
  }
  for (const GivenLevel& level : trial.levels) {
    if (level.variable == plan.level) {
      return level.applied;
    }
  }
  if (sets_other_level(trial, plan)) {
    return kNotKnown;
  }
  const GivenVariable* variable = variable_of(trial, plan.level);
  return variable == nullptr ? kNotKnown : variable->value;
}

int outcome_of(const StudyTrial& trial, const TrialsPlan& plan) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  if (!plan.yes.empty()) {
    return answer == nullptr ? -1 : answer->text == plan.yes ? 1 : 0;
  }
  if (plan.question.empty() && !trial.levels.empty()) {
    const double learnt = trial.levels.front().outcome;
    if (learnt == 0.0 || learnt == 1.0) {
      return static_cast<int>(learnt);
    }
  }
  return answer == nullptr ? -1 : answer->correct;
}

std::string yes_of(const TrialsPlan& plan) { return plan.yes.empty() ? "yes" : plan.yes; }

int signal_in(const StudyTrial& trial, const TrialsPlan& plan, int outcome) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  if (answer != nullptr && answer->correct >= 0) {
    return answer->correct == 1 ? outcome : 1 - outcome;
  }
  if (!trial.probe.empty()) {
    return 0;
  }
  const double level = level_of(trial, plan);
  return std::isfinite(level) ? (level > 0.0 ? 1 : 0) : -1;
}

std::vector<std::string> factors_of(const TrialsData& data, const StudyTrial& trial,
                                    const TrialsPlan& plan) {
  std::vector<std::string> levels;
  for (const std::string& factor : plan.by) {
    levels.push_back(factor_level(data, trial, factor));
  }
  return levels;
}

namespace {

/// The answer that counts 1 at every level; if the plan does not state it, the only one that always
/// did, whatever it is called. Empty: none, as where a formula counts places.
std::string counted_answer(const TrialsData& data, const TrialsPlan& plan) {
  if (!plan.yes.empty()) {
    return plan.yes;
  }
  std::map<std::string, std::pair<bool, bool>> counted;  // as 0, as 1
  for (const StudyTrial& trial : data.trials) {
    const GivenAnswer* answer = answer_to(trial, plan.question);
    const int outcome = outcome_of(trial, plan);
    if (trial.counts() && answer != nullptr && outcome >= 0 &&
        std::isfinite(level_of(trial, plan))) {
      bool& was = outcome == 1 ? counted[answer->text].second : counted[answer->text].first;
      was = true;
    }
  }
  std::vector<std::string> always;
  for (const auto& [text, was] : counted) {
    if (was.second && !was.first) {
      always.push_back(text);
    }
  }
  return always.size() == 1 ? always.front() : std::string();
}

/// 1 or 0 in a catch trial; -1: it is none. @param yes  counted_answer()
int answer_to_catch(const StudyTrial& trial, const TrialsPlan& plan, const std::string& yes) {
  const GivenAnswer* answer = answer_to(trial, plan.question);
  if (yes.empty() || !trial.counts() || trial.probe.empty() || answer == nullptr ||
      std::isfinite(level_of(trial, plan))) {
    return -1;
  }
  const int outcome = answer->text == yes ? 1 : 0;
  return signal_in(trial, plan, outcome) == 0 ? outcome : -1;
}

AnsweredSeries& series_with(const std::vector<std::string>& levels, const std::string& participant,
                            std::vector<AnsweredSeries>& own) {
  const auto at =
      std::ranges::find_if(own, [&](const AnsweredSeries& s) { return s.levels == levels; });
  if (at != own.end()) {
    return *at;
  }
  own.emplace_back();
  own.back().participant = participant;
  own.back().levels = levels;
  return own.back();
}

}  // namespace

std::vector<AnsweredSeries> series_of(const TrialsData& data, const TrialsPlan& plan) {
  const std::vector<std::string> words = two_answers(data, plan);
  const std::string yes = plan.guess_free ? counted_answer(data, plan) : std::string();
  std::map<std::string, std::vector<AnsweredSeries>> people;
  for (std::size_t i = 0; i < data.trials.size(); ++i) {
    const StudyTrial& trial = data.trials[i];
    if (plan.level.empty() && has_surface(trial)) {
      continue;  // a function of one variable would leave the others out
    }
    const std::string& participant = data.session_of(trial).participant;
    const std::vector<std::string> levels = factors_of(data, trial, plan);
    if (const int said = answer_to_catch(trial, plan, yes); said >= 0) {
      TrialBlock& catches = series_with(levels, participant, people[participant]).catches;
      catches.correct += said;
      ++catches.total;
      continue;
    }
    const double level = level_of(trial, plan);
    const int outcome = outcome_of(trial, plan);
    if (!trial.counts() || !std::isfinite(level) || outcome < 0) {
      continue;
    }
    LevelTrial made{i, level, level, outcome, 0, 0, ""};
    if (!trial.levels.empty()) {
      made.asked = trial.levels.front().asked;
      made.track = trial.levels.front().track;
    }
    add_choice(made, trial, plan, words);
    series_with(levels, participant, people[participant]).trials.push_back(std::move(made));
  }
  std::vector<AnsweredSeries> all;
  for (auto& [participant, own] : people) {
    std::erase_if(own, [](const AnsweredSeries& series) { return series.trials.empty(); });
    std::sort(own.begin(), own.end(),
              [](const AnsweredSeries& a, const AnsweredSeries& b) { return a.levels < b.levels; });
    for (AnsweredSeries& series : own) {
      series.trials.shrink_to_fit();
    }
    std::move(own.begin(), own.end(), std::back_inserter(all));
  }
  return all;
}

std::vector<TrialBlock> blocks_of(const AnsweredSeries& series) {
  std::map<double, TrialBlock> blocks;
  for (const LevelTrial& trial : series.trials) {
    const double level = nine_digits(trial.level);
    TrialBlock& block = blocks[level];
    block.level = level;
    block.correct += trial.outcome;
    ++block.total;
  }
  std::vector<TrialBlock> result;
  if (series.catches.total > 0) {
    result.push_back(series.catches);
  }
  for (const auto& [level, block] : blocks) {
    result.push_back(block);
  }
  return result;
}

}  // namespace haptrial::analysis::trials
