#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analysis/force_training/study/study_mixed.h"
#include "analysis/statistics/variance/anova.h"
#include "analysis/statistics/variance/repeated_anova.h"
#include "core/base/random.h"

namespace haptrial::test {

/// Studies without a difference between conditions, made from a study's scores.
enum class NullScheme {
  kBlocks,        // each participant's labels are shuffled over that participant's blocks
  kParticipants,  // each participant has the conditions' names permuted
  kSimulated,     // same design, normal scores with the variances of Variances
  kMissing        // the same, three of ten trials missing and a whole cell
};

/// Variances of the shipped study, as its mixed model estimates them.
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

inline Scores with_missing(Scores scores, RandomStream& random) {
  const auto first = std::pair(scores.front().subject, scores.front().condition);
  std::erase_if(scores, [&](const auto& score) {
    return random.uniform() < 0.3 || std::pair(score.subject, score.condition) == first;
  });
  return scores;
}

inline Scores null_study(const Scores& scores, NullScheme scheme, RandomStream& random) {
  switch (scheme) {
    case NullScheme::kBlocks:
      return with_shuffled_blocks(scores, random);
    case NullScheme::kParticipants:
      return with_permuted_names(scores, random);
    case NullScheme::kMissing:
      return with_missing(simulated(scores, random), random);
    case NullScheme::kSimulated:
      break;
  }
  return simulated(scores, random);
}

/// The scores of the first participants, by name.
inline Scores of_participants(const Scores& scores, std::size_t count) {
  std::set<std::string> names;
  for (const auto& score : scores) {
    names.insert(score.subject);
  }
  while (names.size() > count) {
    names.erase(std::prev(names.end()));
  }
  Scores kept;
  std::copy_if(scores.begin(), scores.end(), std::back_inserter(kept),
               [&](const auto& score) { return names.contains(score.subject); });
  return kept;
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

/// P values of the tests of one study without a difference.
struct NullTests {
  double mixed{1.0};                // mixed model with the design's terms, F
  std::vector<double> differences;  // its coefficients
  bool at_boundary{false};
  double intercept{1.0};  // mixed model with an intercept of each participant alone, F
  std::vector<double> intercept_differences;
  double pooled{1.0};    // analysis of variance of single trials
  double repeated{1.0};  // of participants' means, Greenhouse and Geisser
};

inline std::vector<double> differences_of(const analysis::MixedModel& model) {
  std::vector<double> p;
  for (std::size_t i = 1; i < model.coefficients.size(); ++i) {
    p.push_back(model.coefficients[i].p);
  }
  return p;
}

inline NullTests null_tests(const Scores& scores) {
  const std::vector<std::string> names = conditions_of(scores);
  NullTests tests;
  const auto study = analysis::study_mixed(scores, names);
  tests.mixed = study.omnibus->p;
  tests.differences = differences_of(*study.model);
  tests.at_boundary = study.model->at_boundary;

  Eigen::MatrixXd predictors = Eigen::MatrixXd::Zero(std::ssize(scores), std::ssize(names) - 1);
  std::vector<double> response;
  std::vector<std::size_t> people;
  std::map<std::string, std::size_t> numbers;
  std::vector<std::vector<double>> groups(names.size());
  for (const auto& score : scores) {
    const auto place = std::find(names.begin(), names.end(), score.condition) - names.begin();
    if (place > 0) {
      predictors(std::ssize(response), place - 1) = 1.0;
    }
    response.push_back(score.score);
    people.push_back(numbers.try_emplace(score.subject, numbers.size()).first->second);
    groups[static_cast<std::size_t>(place)].push_back(score.score);
  }
  const auto intercept = analysis::random_intercept_model(response, predictors, people);
  tests.intercept = analysis::joint_test(*intercept, analysis::sequential_contrasts(predictors))->p;
  tests.intercept_differences = differences_of(*intercept);
  tests.pooled = analysis::one_way_anova(groups)->p;
  tests.repeated = analysis::repeated_measures_anova(means_table(scores))->p_corrected;
  return tests;
}

inline std::vector<NullTests> null_studies(const Scores& scores, NullScheme scheme, int studies,
                                           std::uint64_t seed) {
  constexpr std::array<const char*, 4> kStreams{"null: blocks", "null: participants",
                                                "null: simulated", "null: missing"};
  RandomStream random(seed, kStreams[static_cast<std::size_t>(scheme)]);
  std::vector<NullTests> result;
  for (int i = 0; i < studies; ++i) {
    result.push_back(null_tests(null_study(scores, scheme, random)));
  }
  return result;
}

/// Number of studies in which a test came out below 0.05. @param p  of a study.
template <class P>
int count_below(const std::vector<NullTests>& studies, P&& p) {
  return static_cast<int>(std::count_if(studies.begin(), studies.end(),
                                        [&](const NullTests& study) { return p(study) < 0.05; }));
}

}  // namespace haptrial::test
