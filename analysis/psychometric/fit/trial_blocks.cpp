#include "analysis/psychometric/fit/trial_blocks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

/// k log(k / (n p)), which is 0 for no trial.
double surprise_of(double count, double predicted) noexcept {
  return count > 0.0 ? count * std::log(count / predicted) : 0.0;
}

}  // namespace

double nine_digits(double level) {
  if (level == 0.0 || !std::isfinite(level)) {
    return level;
  }
  constexpr int kDigits = 9;
  const double scale = std::pow(10.0, kDigits - 1 - std::floor(std::log10(std::abs(level))));
  return std::round(level * scale) / scale;
}

std::vector<TrialBlock> pooled(std::span<const TrialBlock> blocks) {
  if (blocks.empty()) {
    throw std::invalid_argument("blocks: there are no trials");
  }
  for (const TrialBlock& block : blocks) {
    if (!std::isfinite(block.level) && block.level != kNoStimulus) {
      throw std::invalid_argument("level of a block must be finite");
    }
    if (block.total < 1 || block.correct < 0 || block.correct > block.total) {
      throw std::invalid_argument("correct of a block must lie in 0 .. total, and total above 0");
    }
  }
  std::vector<TrialBlock> rising(blocks.begin(), blocks.end());
  std::stable_sort(rising.begin(), rising.end(),
                   [](const TrialBlock& a, const TrialBlock& b) { return a.level < b.level; });
  std::vector<TrialBlock> result;
  for (const TrialBlock& block : rising) {
    if (!result.empty() && result.back().level == block.level) {
      result.back().correct += block.correct;
      result.back().total += block.total;
    } else {
      result.push_back(block);
    }
  }
  return result;
}

std::vector<double> coordinates(const psychometric::Axis& axis,
                                std::span<const TrialBlock> blocks) {
  std::vector<double> result;
  result.reserve(blocks.size());
  for (const TrialBlock& block : blocks) {
    result.push_back(block.level == kNoStimulus ? kNoStimulus : axis.at(block.level));
    if (!std::isfinite(result.back()) && block.level != kNoStimulus) {
      throw std::invalid_argument(
          "level of a block must lie above the origin of its axis, which takes the logarithm");
    }
  }
  return result;
}

double probability_of(const psychometric::PsychometricFunction& function, const TrialBlock& block) {
  return block.level == kNoStimulus ? function.parameters().guess : function(block.level);
}

PsychometricDeviance deviance_of(const psychometric::PsychometricFunction& function,
                                 std::span<const TrialBlock> blocks) {
  PsychometricDeviance result;
  for (const TrialBlock& block : blocks) {
    const auto n = static_cast<double>(block.total);
    const auto k = static_cast<double>(block.correct);
    const double p = probability_of(function, block);
    const double part =
        std::max(0.0, 2.0 * (surprise_of(k, n * p) + surprise_of(n - k, n * (1.0 - p))));
    result.deviance += part;
    result.residuals.push_back(std::copysign(std::sqrt(part), k / n - p));
  }
  return result;
}

}  // namespace haptrial::analysis
