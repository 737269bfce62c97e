#include "core/psychometric/procedure/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/psychometric/procedure/surprise.h"

namespace haptrial::psychometric {
namespace {

constexpr double kTie = 1e-15;          // [nat]
constexpr double kLeastWeight = 1e-20;  // smaller ones count as this: none is a denormal number
constexpr double kLeftOut = 1e-8;       // at most what the cells that are not summed have together

/// Bounds of an entropy [nat].
struct EntropyEstimate {
  double value{0.0};
  double error{0.0};

  /// A probability adds its surprise, and its error what it may change in it.
  void add(double p, double error_of_p) {
    const double least = std::max(p, error_of_p);
    const double logarithm = std::log(least);
    value -= p * logarithm;
    // Below its error a probability is taken to be its error, which changes no more than that.
    error += error_of_p * (least > p ? 2.0 - 2.0 * logarithm : 1.0 - logarithm);
  }
};

struct Bounds {
  double low, high;
};

/// Information from sums in single precision: outcomes but the last, then h.
Bounds information_bounds(const std::vector<double>& sums, double most_entropy) {
  const std::size_t known = sums.size() - 1;
  double last = 1.0;
  EntropyEstimate entropy{0.0, kLeftOut * most_entropy + kSumError * sums[known]};
  for (std::size_t o = 0; o < known; ++o) {
    last -= sums[o];
    entropy.add(sums[o], kSumError * sums[o] + kLeftOut);
  }
  entropy.add(std::max(last, 0.0), kSumError + kLeftOut);
  const double value = entropy.value - sums[known];
  return {value - entropy.error, value + entropy.error};
}

}  // namespace

StimulusSelection::StimulusSelection(const QuestTables& tables, InstructionSet set)
    : sums_(row_sums(set)),
      weights_(tables.padded(), 0.0f),
      row_sums_(tables.outcomes()),
      information_(tables.stimuli()) {}

/// A group counts if one of its cells has its share of what may be left out.
void StimulusSelection::take_groups(const std::vector<double>& posterior) {
  const double least = kLeftOut / static_cast<double>(posterior.size());
  groups_.clear();
  for (std::size_t begin = 0; begin < posterior.size(); begin += kColumns) {
    const std::size_t end = std::min(begin + kColumns, posterior.size());
    double most = 0.0;
    for (std::size_t c = begin; c < end; ++c) {
      most = std::max(most, posterior[c]);
      weights_[c] = static_cast<float>(std::max(posterior[c], kLeastWeight));
    }
    if (most >= least) {
      groups_.push_back(static_cast<std::uint32_t>(begin));
    }
  }
}

void StimulusSelection::look_at_all(const QuestTables& tables,
                                    const std::vector<double>& posterior) {
  take_groups(posterior);
  const double most_entropy = std::log(static_cast<double>(row_sums_.size()));
  double least = -std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; s < information_.size(); ++s) {
    sums_(tables.rows(s), row_sums_.size(), tables.padded(), {weights_.data(), groups_},
          row_sums_.data());
    const Bounds bounds = information_bounds(row_sums_, most_entropy);
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
