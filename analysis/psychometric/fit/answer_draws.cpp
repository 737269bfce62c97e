#include "analysis/psychometric/fit/answer_draws.h"

#include <gsl/gsl_randist.h>

#include <algorithm>

#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

std::vector<double> expected_shares(std::span<const TrialBlock> blocks,
                                    const psychometric::PsychometricFunction& function) {
  std::vector<double> shares;
  for (const TrialBlock& block : blocks) {
    shares.push_back(std::clamp(probability_of(function, block), 0.0, 1.0));
  }
  return shares;
}

}  // namespace

AnswerDraws::AnswerDraws(std::span<const TrialBlock> blocks, std::span<const double> shares) {
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    std::vector<double>& below = below_.emplace_back();
    double sum = 0.0;
    for (int k = 0; k < blocks[i].total; ++k) {
      sum += gsl_ran_binomial_pdf(static_cast<unsigned>(k), shares[i],
                                  static_cast<unsigned>(blocks[i].total));
      below.push_back(sum);
    }
  }
}

AnswerDraws::AnswerDraws(std::span<const TrialBlock> blocks,
                         const psychometric::PsychometricFunction& function)
    : AnswerDraws(blocks, expected_shares(blocks, function)) {}

void AnswerDraws::draw(RandomStream& random, std::span<int> correct) const noexcept {
  for (std::size_t i = 0; i < below_.size(); ++i) {
    const auto place = std::upper_bound(below_[i].begin(), below_[i].end(), random.uniform());
    correct[i] = static_cast<int>(place - below_[i].begin());
  }
}

}  // namespace haptrial::analysis
