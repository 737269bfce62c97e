#include "core/psychometric/quest/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/psychometric/quest/surprise.h"

namespace haptrial::psychometric {
namespace {

constexpr double kTie = 1e-15;          // [nat]
constexpr double kLeastWeight = 1e-20;  // smaller ones count as 0
constexpr double kOfLeast = 1e-12;      // more than what all that counts as 0 amounts to [nat]

/// What an error of a probability may change in its surprise.
double surprise_error(double p, double error) {
  return error * (1.0 + std::abs(std::log(std::max(p, error))));
}

struct Bounds {
  double low, high;
};

/// Information from sums in single precision: outcomes but the last, then h.
Bounds information_bounds(const std::vector<double>& sums) {
  const std::size_t known = sums.size() - 1;
  double last = 1.0;
  double entropy = 0.0;
  double error = kOfLeast + kSumError * sums[known];
  for (std::size_t o = 0; o < known; ++o) {
    last -= sums[o];
    entropy += surprise(sums[o]);
    error += surprise_error(sums[o], kSumError * sums[o] + std::numeric_limits<double>::min());
  }
  last = std::max(last, 0.0);
  entropy += surprise(last);
  error += surprise_error(last, kSumError);
  const double value = entropy - sums[known];
  return {value - error, value + error};
}

}  // namespace

StimulusSelection::StimulusSelection(const QuestTables& tables, InstructionSet set)
    : sums_(row_sums(set)),
      weights_(tables.padded(), 0.0f),
      row_sums_(tables.outcomes()),
      information_(tables.stimuli()) {}

void StimulusSelection::look_at_all(const QuestTables& tables,
                                    const std::vector<double>& posterior) {
  for (std::size_t c = 0; c < posterior.size(); ++c) {
    weights_[c] = posterior[c] < kLeastWeight ? 0.0f : static_cast<float>(posterior[c]);
  }
  double least = -std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < information_.size(); ++s) {
    sums_(tables.rows(s), row_sums_.size(), tables.padded(), weights_.data(), row_sums_.data());
    const Bounds bounds = information_bounds(row_sums_);
    least = std::max(least, bounds.low);
    information_[s] = bounds.high;
  }
  candidates_.clear();
  for (std::size_t s = 0; s < information_.size(); ++s) {
    if (information_[s] >= least - kTie) {
      candidates_.push_back(s);
    }
  }
}

std::size_t StimulusSelection::best(const QuestTables& tables,
                                    const std::vector<double>& posterior) {
  const bool marginal = !tables.groups().empty();
  if (marginal) {
    candidates_.resize(tables.stimuli());
    std::iota(candidates_.begin(), candidates_.end(), std::size_t{0});
  } else {
    look_at_all(tables, posterior);
  }
  if (candidates_.size() == 1) {
    return candidates_[0];
  }
  for (std::size_t s : candidates_) {
    information_[s] =
        marginal ? marginal_information(tables, posterior, s) : information(tables, posterior, s);
  }
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t s : candidates_) {
    most = std::max(most, information_[s]);
  }
  return *std::find_if(candidates_.begin(), candidates_.end(),
                       [&](std::size_t s) { return information_[s] >= most - kTie; });
}

double information(const QuestTables& tables, const std::vector<double>& posterior,
                   std::size_t stimulus) {
  const std::size_t outcomes = tables.outcomes();
  const auto sum = [&](std::size_t row) {
    return row_sum(tables.likelihood(stimulus, row), posterior.size(), posterior.data());
  };
  double entropy = 0.0;
  for (std::size_t o = 0; o < outcomes; ++o) {
    entropy += surprise(sum(o));
  }
  return entropy - sum(outcomes);
}

double marginal_information(const QuestTables& tables, const std::vector<double>& posterior,
                            std::size_t stimulus) {
  const auto& groups = tables.groups();
  std::vector<double> shares(tables.group_count());
  double information = 0.0;
  for (std::size_t o = 0; o < tables.outcomes(); ++o) {
    const double* likelihood = tables.likelihood(stimulus, o);
    std::fill(shares.begin(), shares.end(), 0.0);
    for (std::size_t c = 0; c < posterior.size(); ++c) {
      shares[groups[c]] += posterior[c] * likelihood[c];
    }
    double probability = 0.0;
    for (double share : shares) {
      information -= surprise(share);
      probability += share;
    }
    information += surprise(probability);
  }
  return information;
}

}  // namespace haptrial::psychometric
