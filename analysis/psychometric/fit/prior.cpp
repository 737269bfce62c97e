#include "analysis/psychometric/fit/prior.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace haptrial::analysis {
double cosine_fall(double part) noexcept {
  return 0.5 + 0.5 * std::cos(std::numbers::pi * std::clamp(part, 0.0, 1.0));
}

StimulusRange stimulus_range(std::span<const double> coordinates) {
  std::vector<double> rising(coordinates.begin(), coordinates.end());
  std::erase_if(rising, [](double x) { return !std::isfinite(x); });
  std::sort(rising.begin(), rising.end());
  rising.erase(std::unique(rising.begin(), rising.end()), rising.end());
  if (rising.size() < 2) {
    throw std::invalid_argument("blocks: a fit takes at least two different levels");
  }
  StimulusRange range{rising.front(), rising.back(), rising.back() - rising.front()};
  for (std::size_t i = 1; i < rising.size(); ++i) {
    range.spacing = std::min(range.spacing, rising[i] - rising[i - 1]);
  }
  return range;
}

PsychometricPrior::PsychometricPrior(const StimulusRange& range, double width_scale, double beta)
    : range_(range),
      smallest_width_(range.spacing * width_scale),
      largest_width_((range.high - range.low) * width_scale),
      beta_(beta) {
  if (!(range.high > range.low && range.spacing > 0.0)) {
    throw std::invalid_argument("range of the levels must have high above low and spacing above 0");
  }
  if (!(beta >= 1.0)) {
    throw std::invalid_argument("beta_prior must be at least 1");
  }
  const double half = 0.5 * (range.high - range.low);
  // eta of 1 has no beta-binomial distribution.
  borders_ = {Border{range.low - half, range.high + half},
              Border{smallest_width_, 3.0 * largest_width_}, Border{0.0, 0.5}, Border{0.0, 0.5},
              Border{0.0, 1.0 - std::exp(-20.0)}};
}

double PsychometricPrior::density(Dimension dimension, double value) const noexcept {
  switch (dimension) {
    case kThreshold:
      return threshold(value);
    case kWidth:
      return width(value);
    default:
      return rate(value, borders_[dimension]);
  }
}

double PsychometricPrior::threshold(double value) const noexcept {
  const double s = range_.high - range_.low;
  const double outside = std::max({0.0, range_.low - value, value - range_.high});
  return cosine_fall(outside / (0.5 * s)) / (1.5 * s);
}

double PsychometricPrior::width(double value) const noexcept {
  const double d = smallest_width_, s = largest_width_;
  // If the levels are two, 2 d lies above s.
  const double rise = 1.0 - cosine_fall((value - d) / d);
  const double drop = value < 2.0 * d ? 1.0 : cosine_fall((value - s) / (2.0 * s));
  const double integral = 0.5 * d + std::max(s - 2.0 * d, 0.0) + s;
  return value > 3.0 * s ? 0.0 : rise * drop / integral;
}

double PsychometricPrior::rate(double value, const Border& border) const noexcept {
  if (value < border.low || value > 1.0) {
    return 0.0;
  }
  const double inside = 1.0 - std::pow(1.0 - border.high, beta_);
  return beta_ * std::pow(1.0 - value, beta_ - 1.0) / inside;
}

}  // namespace haptrial::analysis
