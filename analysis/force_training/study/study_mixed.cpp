#include "analysis/force_training/study/study_mixed.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "analysis/statistics/base/p_adjust.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Groups = std::vector<std::size_t>;  // of the trials

std::vector<std::string> reference_first(std::vector<std::string> conditions,
                                         const std::string& reference) {
  if (!reference.empty()) {
    const auto place = std::find(conditions.begin(), conditions.end(), reference);
    if (place == conditions.end()) {
      throw std::invalid_argument("study_mixed: no condition is named " + reference);
    }
    std::rotate(conditions.begin(), place, place + 1);
  }
  return conditions;
}

template <class Key>
Groups grouped(std::span<const TrialScore> scores, Key&& key) {
  std::map<decltype(key(scores.front())), std::size_t> numbers;
  Groups groups;
  for (const TrialScore& score : scores) {
    groups.push_back(numbers.try_emplace(key(score), numbers.size()).first->second);
  }
  return groups;
}

/// Numbers are given in order of appearance, so that equal groupings have equal numbers.
std::size_t count_of(const Groups& groups) {
  return groups.empty() ? 0 : *std::max_element(groups.begin(), groups.end()) + 1;
}

struct Candidate {
  std::string words;
  std::string notation;
  Groups groups;
};

std::vector<Candidate> candidates(std::span<const TrialScore> scores) {
  return {
      {"participant", "(1 | subject)", grouped(scores, [](const auto& s) { return s.subject; })},
      {"condition within participant", "(1 | subject:condition)",
       grouped(scores, [](const auto& s) { return std::pair(s.subject, s.condition); })},
      {"block within participant", "(1 | subject:block)",
       grouped(scores, [](const auto& s) { return std::pair(s.subject, s.block); })}};
}

struct Terms {
  std::vector<StudyTerm> chosen;
  std::vector<Groups> groups;
  std::vector<std::string> left_out;
};

Terms terms_of(std::span<const TrialScore> scores) {
  Terms terms;
  for (Candidate& candidate : candidates(scores)) {
    const std::size_t count = count_of(candidate.groups);
    const auto same = std::find(terms.groups.begin(), terms.groups.end(), candidate.groups);
    if (count < 2) {
      terms.left_out.push_back("no term for the " + candidate.words + ": there is only one");
    } else if (count == scores.size()) {
      terms.left_out.push_back("no term for the " + candidate.words + ": each has a single trial");
    } else if (same != terms.groups.end()) {
      const auto place = static_cast<std::size_t>(same - terms.groups.begin());
      terms.left_out.push_back("no term for the " + candidate.words +
                               ": it groups the trials as the term for the " +
                               terms.chosen[place].words + " does");
    } else {
      terms.chosen.push_back({candidate.words, candidate.notation, count});
      terms.groups.push_back(std::move(candidate.groups));
    }
  }
  return terms;
}

/// A column for each condition but the first.
MatrixXd coded(std::span<const TrialScore> scores, const std::vector<std::string>& conditions) {
  MatrixXd predictors =
      MatrixXd::Zero(std::ssize(scores), std::max<Index>(std::ssize(conditions) - 1, 0));
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const auto place = std::find(conditions.begin(), conditions.end(), scores[i].condition);
    if (place == conditions.end()) {
      throw std::invalid_argument("study_mixed: " + scores[i].condition + " is not listed");
    }
    if (place != conditions.begin()) {
      predictors(static_cast<Index>(i), place - conditions.begin() - 1) = 1.0;
    }
  }
  return predictors;
}

/// Why there is nothing to fit; empty if there is something.
std::string nothing_to_fit(std::span<const TrialScore> scores,
                           const std::vector<std::string>& conditions, const Terms& terms) {
  if (scores.empty()) {
    return "there are no trials";
  }
  if (conditions.size() < 2) {
    return "there are fewer than two conditions";
  }
  for (const std::string& condition : conditions) {
    if (std::none_of(scores.begin(), scores.end(),
                     [&](const auto& s) { return s.condition == condition; })) {
      return "the condition " + condition + " has no trials";
    }
  }
  return terms.chosen.empty() ? "each participant has a single trial" : "";
}

/// The weights of the mean of condition a less that of b; 0 is the reference.
VectorXd difference(std::size_t a, std::size_t b, std::size_t conditions) {
  VectorXd weights = VectorXd::Zero(static_cast<Index>(conditions));
  if (a > 0) {
    weights[static_cast<Index>(a)] = 1.0;
  }
  if (b > 0) {
    weights[static_cast<Index>(b)] = -1.0;
  }
  return weights;
}

std::vector<MixedPair> pairs_of(const MixedModel& model,
                                const std::vector<std::string>& conditions) {
  std::vector<MixedPair> pairs;
  std::vector<Defined<Coefficient>> tests;
  for (std::size_t a = 0; a < conditions.size(); ++a) {
    for (std::size_t b = a + 1; b < conditions.size(); ++b) {
      tests.push_back(contrast(model, difference(a, b, conditions.size())));
      pairs.push_back({conditions[a], conditions[b], tests.back()});
    }
  }
  const auto adjusted = holm_over(tests);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].holm = adjusted[i];
  }
  return pairs;
}

}  // namespace

StudyMixed study_mixed(std::span<const TrialScore> scores,
                       const std::vector<std::string>& conditions, const std::string& reference) {
  StudyMixed study;
  study.conditions = reference_first(conditions, reference);
  Terms terms = terms_of(scores);
  const MatrixXd predictors = coded(scores, study.conditions);
  study.formula = "score ~ condition";
  for (const StudyTerm& term : terms.chosen) {
    study.formula += " + " + term.notation;
  }
  const std::string reason = nothing_to_fit(scores, study.conditions, terms);
  study.terms = std::move(terms.chosen);
  study.left_out = std::move(terms.left_out);
  if (!reason.empty()) {
    study.model = Undefined{reason};
    study.omnibus = Undefined{reason};
    return study;
  }
  std::vector<double> response;
  for (const TrialScore& score : scores) {
    response.push_back(score.score);
  }
  study.model = mixed_model(response, predictors, terms.groups);
  if (!study.model) {
    study.omnibus = Undefined{study.model.because()};
    return study;
  }
  study.omnibus = joint_test(*study.model, sequential_contrasts(predictors));
  study.pairs = pairs_of(*study.model, study.conditions);
  return study;
}

}  // namespace haptrial::analysis
