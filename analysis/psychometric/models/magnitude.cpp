#include "analysis/psychometric/models/magnitude.h"

#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct Mean {
  double sum{0.0};
  double count{0.0};
  double value() const { return sum / count; }
};

/// Means of the logarithms: participant, then level.
using Logs = std::map<std::size_t, std::map<double, Mean>>;

Defined<Logs> logs_of(std::span<const MagnitudeTrial> trials) {
  Logs logs;
  for (const MagnitudeTrial& t : trials) {
    if (!(t.level > 0.0 && t.estimate > 0.0 && std::isfinite(t.level) &&
          std::isfinite(t.estimate))) {
      return Undefined{"a level or an estimate is not above 0 or not finite"};
    }
    Mean& mean = logs[t.participant][t.level];
    mean.sum += std::log(t.estimate);
    mean.count += 1.0;
  }
  if (logs.empty()) {
    return Undefined{"there are no estimates"};
  }
  for (const auto& [participant, levels] : logs) {
    if (levels.size() < 2) {
      return Undefined{"participant " + std::to_string(participant) +
                       " has estimates of one level only"};
    }
  }
  return logs;
}

struct Line {
  double slope, intercept, r_squared;
  double deviation, error;  // of the residuals, of the slope; infinite for two points
};

Line line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const VectorXd a = VectorXd::Map(x.data(), std::ssize(x)),
                 b = VectorXd::Map(y.data(), std::ssize(y));
  const VectorXd u = a.array() - a.mean(), v = b.array() - b.mean();
  const double slope = u.dot(v) / u.squaredNorm();
  const double all = v.squaredNorm(), left = (v - slope * u).squaredNorm();
  const auto df = static_cast<double>(x.size()) - 2.0;
  const double deviation =
      df > 0.0 ? std::sqrt(left / df) : std::numeric_limits<double>::infinity();
  return {slope, b.mean() - slope * a.mean(), all > 0.0 ? 1.0 - left / all : 1.0, deviation,
          deviation / u.norm()};
}

PersonalLine personal(const Line& line, std::size_t levels, double level) {
  const double half =
      levels > 2 ? t_quantile(0.5 + 0.5 * level, static_cast<double>(levels) - 2.0) * line.error
                 : line.error;
  return {line.slope - half, line.slope + half, line.r_squared, line.deviation};
}

/// Logarithms of the moduli, with sum 0; nothing unless all participants are joined by levels.
std::optional<VectorXd> log_moduli(const Logs& logs) {
  const Index n = std::ssize(logs);
  std::map<double, std::pair<double, double>> levels;  // sum of the logs, number of participants
  for (const auto& [participant, own] : logs) {
    for (const auto& [level, mean] : own) {
      levels[level].first += mean.value();
      levels[level].second += 1.0;
    }
  }
  // Normal equations of log estimate = participant + level, the levels eliminated.
  MatrixXd matrix = MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));  // sum of moduli is 0
  VectorXd right = VectorXd::Zero(n);
  Index i = 0;
  for (const auto& [participant, own] : logs) {
    for (const auto& [level, mean] : own) {
      const auto& [sum, count] = levels[level];
      matrix(i, i) += 1.0;
      right[i] += mean.value() - sum / count;
      Index j = 0;
      for (const auto& [other, theirs] : logs) {
        matrix(i, j++) -= theirs.contains(level) ? 1.0 / count : 0.0;
      }
    }
    ++i;
  }
  const double scale = matrix.diagonal().maxCoeff();
  if (!(solve_pivoted(matrix, right).smallest > 1e-10 * scale)) {
    return std::nullopt;
  }
  return solve_pivoted(matrix, right).solved;
}

/// Half the width of Student's interval of a mean; 0 for one value.
double half_width(const std::vector<double>& values, double level, double& error) {
  const VectorXd v = VectorXd::Map(values.data(), std::ssize(values));
  const auto n = static_cast<double>(values.size());
  if (values.size() < 2) {
    error = 0.0;
    return 0.0;
  }
  error = std::sqrt((v.array() - v.mean()).square().sum() / (n - 1.0) / n);
  return t_quantile(0.5 + 0.5 * level, n - 1.0) * error;
}

std::vector<MagnitudeLevel> level_means(const Logs& logs, const VectorXd& moduli, double level) {
  std::map<double, std::vector<double>> equalised;
  Index i = 0;
  for (const auto& [participant, own] : logs) {
    for (const auto& [at, mean] : own) {
      equalised[at].push_back(mean.value() - moduli[i]);
    }
    ++i;
  }
  std::vector<MagnitudeLevel> result;
  for (const auto& [at, values] : equalised) {
    double error = 0.0;
    const double half = half_width(values, level, error);
    const double mean = VectorXd::Map(values.data(), std::ssize(values)).mean();
    result.push_back(
        {at, std::exp(mean), std::exp(mean - half), std::exp(mean + half), values.size()});
  }
  return result;
}

}  // namespace

Defined<PowerLaw> power_law(std::span<const MagnitudeTrial> trials, double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  const auto logs = logs_of(trials);
  if (!logs) {
    return Undefined{logs.because()};
  }
  const auto moduli = log_moduli(*logs);
  if (!moduli) {
    return Undefined{"participants have no levels in common, so that their moduli cannot be told"};
  }
  PowerLaw law;
  Index i = 0;
  for (const auto& [participant, own] : *logs) {
    std::vector<double> x, y;
    for (const auto& [at, mean] : own) {
      x.push_back(std::log(at));
      y.push_back(mean.value());
    }
    law.participants.push_back(participant);
    const Line line = line_through(x, y);
    law.exponents.push_back(line.slope);
    law.lines.push_back(personal(line, x.size(), level));
    law.moduli.push_back(std::exp((*moduli)[i++]));
  }
  law.levels = level_means(*logs, *moduli, level);
  std::vector<double> x, y;
  for (const MagnitudeLevel& l : law.levels) {
    x.push_back(std::log(l.level));
    y.push_back(std::log(l.mean));
  }
  law.exponent = VectorXd::Map(law.exponents.data(), std::ssize(law.exponents)).mean();
  const double half = half_width(law.exponents, level, law.error);
  if (law.exponents.size() > 1) {
    law.low = law.exponent - half;
    law.high = law.exponent + half;
  } else {
    law.low = law.high = Undefined{"there is one participant only"};
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    sum += y[k] - law.exponent * x[k];
  }
  law.constant = std::exp(sum / static_cast<double>(x.size()));
  law.r_squared = line_through(x, y).r_squared;
  return law;
}

}  // namespace haptrial::analysis
