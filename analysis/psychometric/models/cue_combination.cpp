#include "analysis/psychometric/models/cue_combination.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

double normal_bound(double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  return normal_quantile(0.5 + 0.5 * level);
}

void check_sd(double sd, const char* name) {
  if (!(sd > 0.0) || !std::isfinite(sd)) {
    throw std::invalid_argument(std::string(name) + " must be above 0 and finite");
  }
}

double relative_error(const Estimated& sd, const char* name) {
  check_sd(sd.value, name);
  if (!(sd.error >= 0.0) || !std::isfinite(sd.error)) {
    throw std::invalid_argument(std::string("the error of ") + name +
                                " must not be negative, and finite");
  }
  return sd.error / sd.value;
}

double weight_of_first(double first_sd, double second_sd) {
  const double ratio = first_sd / second_sd;
  return 1.0 / (1.0 + ratio * ratio);
}

double sd_of_both(double first_sd, double second_sd) {
  return first_sd * second_sd / std::hypot(first_sd, second_sd);
}

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

}  // namespace

CombinedCues predict_combination(const Estimated& first_sd, const Estimated& second_sd,
                                 double level) {
  const double z = normal_bound(level);
  const double first = relative_error(first_sd, "first_sd");
  const double second = relative_error(second_sd, "second_sd");
  CombinedCues result;
  const double weight = weight_of_first(first_sd.value, second_sd.value);
  const double log_odds = 2.0 * std::log(second_sd.value / first_sd.value);
  const double odds_error = 2.0 * std::hypot(first, second);
  result.first_weight = {weight, weight * (1.0 - weight) * odds_error,
                         logistic(log_odds - z * odds_error), logistic(log_odds + z * odds_error)};
  const double sd = sd_of_both(first_sd.value, second_sd.value);
  const double log_error = std::hypot(weight * first, (1.0 - weight) * second);
  result.combined_sd = {sd, sd * log_error, sd * std::exp(-z * log_error),
                        sd * std::exp(z * log_error)};
  return result;
}

Defined<ObservedWeight> observed_weight(std::span<const ConflictPse> conflicts, double level) {
  const double z = normal_bound(level);
  double total = 0.0, x_mean = 0.0, y_mean = 0.0;
  for (const ConflictPse& c : conflicts) {
    check_sd(c.pse.error, "the error of a PSE");
    if (!std::isfinite(c.first) || !std::isfinite(c.second) || !std::isfinite(c.pse.value)) {
      throw std::invalid_argument("cues and PSEs must be finite");
    }
    const double weight = 1.0 / (c.pse.error * c.pse.error);
    total += weight;
    x_mean += weight * (c.first - c.second);
    y_mean += weight * (c.pse.value - c.second);
  }
  if (conflicts.size() < 2) {
    return Undefined{"there are fewer than two conflicts"};
  }
  x_mean /= total;
  y_mean /= total;
  double xx = 0.0, xy = 0.0;
  for (const ConflictPse& c : conflicts) {
    const double weight = 1.0 / (c.pse.error * c.pse.error);
    const double x = c.first - c.second - x_mean;
    xx += weight * x * x;
    xy += weight * x * (c.pse.value - c.second - y_mean);
  }
  const auto same = [&](const ConflictPse& c) {
    return c.first - c.second == conflicts.front().first - conflicts.front().second;
  };
  if (std::ranges::all_of(conflicts, same) || !(xx > 0.0)) {
    return Undefined{"the conflicts do not differ"};
  }
  ObservedWeight result;
  const double slope = xy / xx;
  const double error = 1.0 / std::sqrt(xx);
  result.first_weight = {slope, error, slope - z * error, slope + z * error};
  result.bias = y_mean - slope * x_mean;
  result.df = conflicts.size() - 2;
  for (const ConflictPse& c : conflicts) {
    const double left = c.pse.value - c.second - result.bias - slope * (c.first - c.second);
    result.chi_squared += left * left / (c.pse.error * c.pse.error);
  }
  return result;
}

CueComparison compare_cues(std::span<const CueParticipant> participants, double level) {
  normal_bound(level);
  std::vector<double> weights, predicted, observed_logs, predicted_logs, best_logs, sds;
  for (const CueParticipant& p : participants) {
    check_sd(p.first_sd, "first_sd");
    check_sd(p.second_sd, "second_sd");
    check_sd(p.combined_sd, "combined_sd");
    weights.push_back(p.first_weight);
    predicted.push_back(p.predicted_weight.value_or(weight_of_first(p.first_sd, p.second_sd)));
    sds.push_back(p.predicted_sd.value_or(sd_of_both(p.first_sd, p.second_sd)));
    check_sd(sds.back(), "predicted_sd");
    observed_logs.push_back(std::log(p.combined_sd));
    predicted_logs.push_back(std::log(sds.back()));
    best_logs.push_back(std::log(std::min(p.first_sd, p.second_sd)));
  }
  return {paired_t_test(weights, predicted, Tail::kTwoSided, level),
          paired_t_test(observed_logs, predicted_logs, Tail::kTwoSided, level),
          paired_t_test(observed_logs, best_logs, Tail::kLess, level),
          pearson_correlation(weights, predicted, level)};
}

}  // namespace haptrial::analysis
