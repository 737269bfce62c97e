#include "core/psychometric/procedure/staircase.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haptrial::psychometric {
namespace {

constexpr const char* kStaircase = "Staircase";
using Estimator = StaircaseParameters::Estimator;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The standard error of the middles of pairs; nothing with fewer than two.
std::optional<double> error_of_pairs(const std::vector<double>& reversals) {
  std::vector<double> middles;
  for (std::size_t i = reversals.size() % 2; i + 1 < reversals.size(); i += 2) {
    middles.push_back(0.5 * (reversals[i] + reversals[i + 1]));
  }
  if (middles.size() < 2) {
    return std::nullopt;
  }
  const double mean = mean_of(middles);
  double squares = 0.0;
  for (double middle : middles) {
    squares += (middle - mean) * (middle - mean);
  }
  const auto n = static_cast<double>(middles.size());
  return std::sqrt(squares / (n - 1.0) / n);
}

std::string name_of(Estimator estimator, std::size_t count) {
  const std::string number = std::to_string(count);
  switch (estimator) {
    case Estimator::kMeanOfReversals:
      return "mean of " + number + " reversals";
    case Estimator::kMedianOfReversals:
      return "median of " + number + " reversals";
    case Estimator::kMeanOfLevels:
      return "mean of " + number + " levels";
  }
  return {};
}

}  // namespace

Staircase::Staircase(const StaircaseParameters& parameters) : parameters_(parameters) {
  check(parameters_);
  state_ = begin(parameters_);
  next_ = {parameters_.start};
}

const Level& Staircase::next() const {
  checks::require_running(!finished(), kStaircase);
  return next_;
}

void Staircase::report(double answer, const Level& applied) {
  checks::require_running(!finished(), kStaircase);
  const bool right = checks::outcome_of(answer, 2, kStaircase) == 1;
  const double x = parameters_.axis.at(checks::single_level(applied, kStaircase));
  checks::require(std::isfinite(x), kStaircase,
                  "applied must be above the origin of a logarithmic scale");
  // A level that was applied as it was asked for has exactly the x of the track.
  const bool exact = applied[0] == next_[0];
  const double from = exact || !parameters_.step_from_applied ? state_.x : x;
  applied_.push_back(exact ? state_.x : x);
  if (advance(parameters_, state_, right, from)) {
    reversals_.push_back(applied_.back());
  }
  next_[0] = std::clamp(parameters_.axis.level(state_.x), parameters_.low, parameters_.high);
}

std::vector<double> Staircase::reversals() const {
  std::vector<double> levels;
  for (double x : reversals_) {
    levels.push_back(parameters_.axis.level(x));
  }
  return levels;
}

std::vector<double> Staircase::chosen() const {
  const auto& all = parameters_.estimator == Estimator::kMeanOfLevels ? applied_ : reversals_;
  std::size_t first = std::min<std::size_t>(parameters_.skip, all.size());
  if (parameters_.last > 0 && all.size() > static_cast<std::size_t>(parameters_.last)) {
    first = all.size() - static_cast<std::size_t>(parameters_.last);
  }
  return {all.begin() + static_cast<std::ptrdiff_t>(first), all.end()};
}

std::optional<double> Staircase::target() const {
  return parameters_.up == 1 ? std::optional(balance_of(parameters_.down, parameters_.steps.back()))
                             : std::nullopt;
}

std::vector<Estimate> Staircase::estimates() const {
  const std::vector<double> values = chosen();
  if (values.empty()) {
    return {};
  }
  const bool median = parameters_.estimator == Estimator::kMedianOfReversals;
  const double x = median ? median_of(values) : mean_of(values);
  const double level = parameters_.axis.level(x);
  Estimate estimate{name_of(parameters_.estimator, values.size()), level, std::nullopt};
  if (parameters_.estimator != Estimator::kMeanOfLevels) {
    if (const auto error = error_of_pairs(values)) {
      estimate.deviation = *error / parameters_.axis.gradient(level);
    }
  }
  return {estimate};
}

}  // namespace haptrial::psychometric
