#include "analysis/psychophysics/fit/serial_regression.h"

#include <algorithm>
#include <cmath>

#include "analysis/psychometric/models/binomial_model.h"

namespace haptrial::analysis::trials {
namespace {

constexpr double kMostLogit = 7.0;

/// A trial beside its function.
struct Seen {
  const SerialTrial* trial{nullptr};
  double offset{0.0};  // logit psi
  int before{0};       // the choice of the trial before; 0: there is none
};

double logit(double p) { return std::clamp(std::log(p / (1.0 - p)), -kMostLogit, kMostLogit); }

double variance_at(double offset) {
  const double p = 1.0 / (1.0 + std::exp(-offset));
  return p * (1.0 - p);
}

std::vector<Seen> seen_of(std::span<const SerialTrial> trials, const SerialFunctions& functions) {
  std::vector<Seen> seen;
  for (const SerialTrial& trial : trials) {
    const auto& function = functions[trial.series];
    if (!function || !std::isfinite(function->parameters().axis.at(trial.level))) {
      continue;
    }
    const bool follows = !seen.empty() && seen.back().trial->session == trial.session;
    seen.push_back(
        {&trial, logit((*function)(trial.level)), follows ? seen.back().trial->choice : 0});
  }
  return seen;
}

BinomialData empty_rows(std::size_t count, Eigen::Index predictors) {
  BinomialData data;
  data.yes.reserve(count);
  data.trials.assign(count, 1);
  data.predictors.resize(static_cast<Eigen::Index>(count), predictors);
  return data;
}

/// Coefficient of the last predictor.
Defined<BinomialCoefficient> last_coefficient(const BinomialData& data) {
  const auto model = binomial_regression(data, BinomialLink::kLogit);
  if (!model) {
    return Undefined{model.because()};
  }
  return model->coefficients.back();
}

Defined<BinomialCoefficient> drift_of(const std::vector<Seen>& seen) {
  BinomialData data = empty_rows(seen.size(), 2);
  const double last = std::max(1.0, static_cast<double>(seen.size()) - 1.0);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    data.yes.push_back(seen[i].trial->outcome);
    const auto row = static_cast<Eigen::Index>(i);
    data.predictors(row, 0) = seen[i].offset;
    data.predictors(row, 1) = static_cast<double>(i) / last - 0.5;
  }
  return last_coefficient(data);
}

Defined<BinomialCoefficient> repetition_of(std::vector<Seen> seen) {
  std::erase_if(seen, [](const Seen& one) { return one.before == 0; });
  BinomialData data = empty_rows(seen.size(), 2);
  double weight = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Seen& one = seen[i];
    data.yes.push_back(one.trial->choice > 0 ? 1 : 0);
    const auto row = static_cast<Eigen::Index>(i);
    data.predictors(row, 0) = one.trial->side * one.offset;
    data.predictors(row, 1) = 0.5 * one.before;
    weight += variance_at(one.offset);
  }
  const Defined<BinomialCoefficient> found = last_coefficient(data);
  if (!found) {
    return found;
  }
  BinomialCoefficient unbiased = *found;
  unbiased.estimate += 1.0 / weight;
  return unbiased;
}

void take(const Defined<BinomialCoefficient>& found, Defined<double>& value, double& error) {
  if (!found) {
    value = Undefined{found.because()};
    return;
  }
  value = found->estimate;
  error = found->error;
}

}  // namespace

SerialCoefficients serial_coefficients(std::span<const SerialTrial> trials,
                                       const SerialFunctions& functions) {
  SerialCoefficients result;
  if (const auto seen = seen_of(trials, functions); !seen.empty()) {
    take(drift_of(seen), result.drift, result.drift_error);
    take(repetition_of(seen), result.repetition, result.repetition_error);
  }
  return result;
}

}  // namespace haptrial::analysis::trials
