#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/anova.h"
#include "analysis/repeated_anova.h"
#include "analysis/study_mixed.h"
#include "core/base/random.h"

namespace haptrial::test {

/// Studies without a difference between conditions, made from a study's scores.
enum class NullScheme {
  kBlocks,        // each participant's labels are shuffled over that participant's blocks
  kParticipants,  // each participant has the conditions' names permuted
  kSimulated      // same design, normal scores with the variances of Variances
};

/// Of the shipped study, as its mixed model estimates them.
struct Variances {
  double subject{0.022};
  double cell{0.142};  // subject x condition
  double block{0.139};
  double residual{0.256};
};

using Scores = std::vector<analysis::TrialScore>;

inline void shuffle(std::vector<std::string>& values, RandomStream& random) {
  for (std::size_t i = values.size(); i > 1; --i) {
    std::swap(values[i - 1], values[random.below(i)]);
  }
}

inline std::vector<std::string> conditions_of(const Scores& scores) {
  std::set<std::string> names;
  for (const auto& score : scores) {
    names.insert(score.condition);
  }
  return {names.begin(), names.end()};
}

inline Scores with_shuffled_blocks(Scores scores, RandomStream& random) {
  std::map<std::string, std::map<int, std::string>> labels;  // of the blocks of each participant
  for (const auto& score : scores) {
    labels[score.subject][score.block] = score.condition;
  }
  for (auto& [subject, blocks] : labels) {
    std::vector<std::string> names;
    for (const auto& [block, name] : blocks) {
      names.push_back(name);
    }
    shuffle(names, random);
    auto next = names.begin();
    for (auto& [block, name] : blocks) {
      name = *next++;
    }
  }
  for (auto& score : scores) {
    score.condition = labels[score.subject][score.block];
  }
  return scores;
}

inline Scores with_permuted_names(Scores scores, RandomStream& random) {
  const std::vector<std::string> names = conditions_of(scores);
  std::map<std::string, std::vector<std::string>> permuted;  // by participant
  for (auto& score : scores) {
    auto [own, added] = permuted.try_emplace(score.subject, names);
    if (added) {
      shuffle(own->second, random);
    }
    const auto place = std::find(names.begin(), names.end(), score.condition) - names.begin();
    score.condition = own->second[static_cast<std::size_t>(place)];
  }
  return scores;
}

inline Scores simulated(Scores scores, RandomStream& random, const Variances& v = {}) {
  std::map<std::string, double> subjects;
  std::map<std::pair<std::string, std::string>, double> cells;
  std::map<std::pair<std::string, int>, double> blocks;
  const auto drawn = [&](auto& values, const auto& key, double variance) {
    const auto found = values.find(key);
    return found != values.end()
               ? found->second
               : values.emplace(key, std::sqrt(variance) * random.normal()).first->second;
  };
  for (auto& score : scores) {
    score.score = 2.0 + drawn(subjects, score.subject, v.subject);
    score.score += drawn(cells, std::pair(score.subject, score.condition), v.cell);
    score.score += drawn(blocks, std::pair(score.subject, score.block), v.block);
    score.score += std::sqrt(v.residual) * random.normal();
  }
  return scores;
}

inline Scores null_study(const Scores& scores, NullScheme scheme, RandomStream& random) {
  switch (scheme) {
    case NullScheme::kBlocks:
      return with_shuffled_blocks(scores, random);
    case NullScheme::kParticipants:
      return with_permuted_names(scores, random);
    case NullScheme::kSimulated:
      break;
  }
  return simulated(scores, random);
}

/// Participants' means by condition; a participant without one of them is left out.
inline std::vector<std::vector<double>> means_table(const Scores& scores) {
  const std::vector<std::string> names = conditions_of(scores);
  std::map<std::string, std::map<std::string, std::pair<double, int>>> sums;
  for (const auto& score : scores) {
    auto& [sum, count] = sums[score.subject][score.condition];
    sum += score.score;
    ++count;
  }
  std::vector<std::vector<double>> table;
  for (const auto& [subject, cells] : sums) {
    if (cells.size() == names.size()) {
      table.emplace_back();
      for (const auto& [name, sum] : cells) {
        table.back().push_back(sum.first / sum.second);
      }
    }
  }
  return table;
}

/// In how many studies each test came out below 0.05.
struct NullCounts {
  int studies{0};
  int omnibus{0};                // mixed model with the design's terms
  std::vector<int> differences;  // its coefficients
  int boundary{0};               // studies with a variance at 0
  int intercept_omnibus{0};      // mixed model with an intercept of each participant alone
  std::vector<int> intercept_differences;
  int pooled{0};    // analysis of variance of single trials
  int repeated{0};  // of participants' means, Greenhouse and Geisser
};

inline void count(NullCounts& counts, const Scores& scores) {
  constexpr double kLevel = 0.05;
  const std::vector<std::string> names = conditions_of(scores);
  const auto below = [](const auto& test) { return test && test->p < kLevel ? 1 : 0; };
  const auto add = [&](std::vector<int>& differences, const analysis::MixedModel& model) {
    differences.resize(names.size() - 1);
    for (std::size_t i = 0; i + 1 < names.size(); ++i) {
      differences[i] += model.coefficients[i + 1].p < kLevel ? 1 : 0;
    }
  };
  const auto study = analysis::study_mixed(scores, names);
  ++counts.studies;
  counts.omnibus += below(study.omnibus);
  counts.boundary += study.model->at_boundary ? 1 : 0;
  add(counts.differences, *study.model);

  Eigen::MatrixXd predictors(std::ssize(scores), std::ssize(names) - 1);
  std::vector<double> response;
  std::vector<std::size_t> people;
  std::map<std::string, std::size_t> numbers;
  std::vector<std::vector<double>> groups(names.size());
  for (const auto& score : scores) {
    const auto place = std::find(names.begin(), names.end(), score.condition) - names.begin();
    for (Eigen::Index j = 0; j < predictors.cols(); ++j) {
      predictors(std::ssize(response), j) = place == j + 1 ? 1.0 : 0.0;
    }
    response.push_back(score.score);
    people.push_back(numbers.try_emplace(score.subject, numbers.size()).first->second);
    groups[static_cast<std::size_t>(place)].push_back(score.score);
  }
  const auto intercept = analysis::random_intercept_model(response, predictors, people);
  counts.intercept_omnibus +=
      below(analysis::joint_test(*intercept, analysis::sequential_contrasts(predictors)));
  add(counts.intercept_differences, *intercept);
  counts.pooled += below(analysis::one_way_anova(groups));
  const auto repeated = analysis::repeated_measures_anova(means_table(scores));
  counts.repeated += repeated && repeated->p_corrected < kLevel ? 1 : 0;
}

inline NullCounts null_counts(const Scores& scores, NullScheme scheme, int studies,
                              std::uint64_t seed) {
  constexpr std::array<const char*, 3> kStreams{"null: blocks", "null: participants",
                                                "null: simulated"};
  RandomStream random(seed, kStreams[static_cast<std::size_t>(scheme)]);
  NullCounts counts;
  for (int i = 0; i < studies; ++i) {
    count(counts, null_study(scores, scheme, random));
  }
  return counts;
}

}  // namespace haptrial::test
