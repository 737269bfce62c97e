#include "analysis/psychometric/fit/psychometric_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

/// k log(k / (n p)), which is 0 for no trial.
double surprise(double count, double predicted) noexcept {
  return count > 0.0 ? count * std::log(count / predicted) : 0.0;
}

}  // namespace

double PsychometricFunction::at(double level) const noexcept {
  double beyond = 0.0;
  const auto& p = parameters_;
  const double share = sigmoid_.share(sigmoid_.coordinate(level), p.threshold, p.width, beyond);
  return p.guess + (1.0 - p.guess - p.lapse) * share;
}

std::optional<double> PsychometricFunction::level_at(double probability) const noexcept {
  const auto& p = parameters_;
  if (!(probability > p.guess && probability < 1.0 - p.lapse)) {
    return std::nullopt;
  }
  return level_of_share((probability - p.guess) / (1.0 - p.guess - p.lapse));
}

double PsychometricFunction::level_of_share(double share) const noexcept {
  return sigmoid_.level(sigmoid_.inverse(share, parameters_.threshold, parameters_.width));
}

double PsychometricFunction::slope(double level) const noexcept {
  const auto& p = parameters_;
  const double by_coordinate =
      (1.0 - p.guess - p.lapse) * sigmoid_.slope(sigmoid_.coordinate(level), p.threshold, p.width);
  return sigmoid_.shape().logarithmic ? by_coordinate / level : by_coordinate;
}

std::vector<TrialBlock> pooled(std::span<const TrialBlock> blocks) {
  if (blocks.empty()) {
    throw std::invalid_argument("blocks: there are no trials");
  }
  for (const TrialBlock& block : blocks) {
    if (!std::isfinite(block.level)) {
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

std::vector<double> coordinates(const Sigmoid& sigmoid, std::span<const TrialBlock> blocks) {
  std::vector<double> result;
  result.reserve(blocks.size());
  for (const TrialBlock& block : blocks) {
    result.push_back(sigmoid.coordinate(block.level));
    if (!std::isfinite(result.back())) {
      throw std::invalid_argument(
          "level of a block must be above 0, as the sigmoid takes its logarithm");
    }
  }
  return result;
}

PsychometricDeviance deviance_of(const PsychometricFunction& function,
                                 std::span<const TrialBlock> blocks) {
  PsychometricDeviance result;
  for (const TrialBlock& block : blocks) {
    const auto n = static_cast<double>(block.total);
    const auto k = static_cast<double>(block.correct);
    const double p = function.at(block.level);
    const double part = std::max(0.0, 2.0 * (surprise(k, n * p) + surprise(n - k, n * (1.0 - p))));
    result.deviance += part;
    result.residuals.push_back(std::copysign(std::sqrt(part), k / n - p));
  }
  return result;
}

}  // namespace haptrial::analysis
