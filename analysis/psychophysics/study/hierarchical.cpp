#include "analysis/psychophysics/study/hierarchical.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "analysis/psychophysics/fit/function_fit.h"

namespace haptrial::analysis::trials {
namespace {

constexpr std::size_t kFewestPeople = 3;  // participants

/// People and conditions by number. Answers come by person and condition.
std::vector<hierarchical::PersonAnswers> answers_of(const std::vector<AnsweredSeries>& series,
                                                    HierarchicalFunctions& made) {
  std::set<std::vector<std::string>> levels;
  for (const AnsweredSeries& each : series) {
    levels.insert(each.levels);
  }
  made.levels.assign(levels.begin(), levels.end());
  made.conditions.resize(made.levels.size());
  std::vector<hierarchical::PersonAnswers> answers;
  for (const AnsweredSeries& each : series) {
    if (made.participants.empty() || made.participants.back() != each.participant) {
      made.participants.push_back(each.participant);
    }
    const auto condition =
        static_cast<std::size_t>(std::ranges::find(made.levels, each.levels) - made.levels.begin());
    made.conditions[condition] = each.condition();
    answers.push_back({made.participants.size() - 1, condition, blocks_of(each)});
  }
  std::ranges::sort(answers, [](const auto& a, const auto& b) {
    return std::pair(a.person, a.condition) < std::pair(b.person, b.condition);
  });
  return answers;
}

}  // namespace

Defined<HierarchicalFunctions> hierarchical_functions(const std::vector<AnsweredSeries>& series,
                                                      const TrialsPlan& plan, int threads) {
  HierarchicalFunctions made;
  std::vector<hierarchical::PersonAnswers> answers = answers_of(series, made);
  if (made.participants.size() < kFewestPeople) {
    return Undefined{"there are fewer than three participants"};
  }
  for (const hierarchical::PersonAnswers& each : answers) {
    made.condition_of.push_back(each.condition);
  }
  LikelihoodOptions options = likelihood_options(plan);
  if (std::ranges::any_of(series, [](const auto& each) { return each.catches.total > 0; })) {
    options.guess.high = kLargestRate;
  }
  hierarchical::Sampling sampling;
  sampling.seed = plan.seed;
  sampling.threads = threads;
  try {
    made.fit = hierarchical_fit(hierarchical::Model(std::move(answers), options), sampling);
  } catch (const std::invalid_argument& error) {
    return Undefined{error.what()};
  }
  return made;
}

}  // namespace haptrial::analysis::trials
