#include "analysis/psychometric/models/magnitude.h"

#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "analysis/psychometric/models/errors_in_variables.h"
#include "analysis/statistics/base/decomposition.h"
#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Logarithms of a participant's trials at a level.
struct Repeats {
  std::vector<double> estimates;
  std::vector<double> measured;  // as many; NaN: the stimulus was not measured
};

double mean_of(const std::vector<double>& values) {
  return VectorXd::Map(values.data(), std::ssize(values)).mean();
}

/// Participant, then level.
using Logs = std::map<std::size_t, std::map<double, Repeats>>;

bool is_positive(double value) { return value > 0.0 && std::isfinite(value); }

Defined<Logs> logs_of(std::span<const MagnitudeTrial> trials) {
  Logs logs;
  for (const MagnitudeTrial& t : trials) {
    if (!is_positive(t.level) || !is_positive(t.estimate) ||
        !(std::isnan(t.measured) || is_positive(t.measured))) {
      return Undefined{"a level or an estimate is not above 0 or not finite"};
    }
    if (std::isnan(t.measured) != std::isnan(trials.front().measured)) {
      return Undefined{"some stimuli were measured and others were not"};
    }
    Repeats& repeats = logs[t.participant][t.level];
    repeats.estimates.push_back(std::log(t.estimate));
    repeats.measured.push_back(std::log(t.measured));
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

/// The means of a participant's levels.
struct Points {
  std::vector<double> x, y, counts;
};

Points points_of(const std::map<double, Repeats>& levels) {
  Points points;
  for (const auto& [at, repeats] : levels) {
    const double measured = mean_of(repeats.measured);
    points.x.push_back(std::isnan(measured) ? std::log(at) : measured);
    points.y.push_back(mean_of(repeats.estimates));
    points.counts.push_back(static_cast<double>(repeats.estimates.size()));
  }
  return points;
}

/// How repeated trials scatter around the means of their levels; nothing without repeated trials.
std::optional<RepeatScatter> scatter_of(const std::map<double, Repeats>& levels) {
  RepeatScatter sum;
  double df = 0.0;
  for (const auto& [at, repeats] : levels) {
    const double x = mean_of(repeats.measured), y = mean_of(repeats.estimates);
    for (std::size_t i = 0; i < repeats.estimates.size(); ++i) {
      const double u = repeats.measured[i] - x, v = repeats.estimates[i] - y;
      sum.xx += u * u;
      sum.yy += v * v;
      sum.xy += u * v;
    }
    df += static_cast<double>(repeats.estimates.size()) - 1.0;
  }
  return df > 0.0 ? std::optional(RepeatScatter{sum.xx / df, sum.yy / df, sum.xy / df})
                  : std::nullopt;
}

/// A slope with its standard error, infinite for two points.
struct Slope {
  double value{0.0}, error{0.0};
};

Slope least_squares(const Points& points) {
  const VectorXd x = VectorXd::Map(points.x.data(), std::ssize(points.x)),
                 y = VectorXd::Map(points.y.data(), std::ssize(points.y));
  const VectorXd u = x.array() - x.mean(), v = y.array() - y.mean();
  const double slope = u.dot(v) / u.squaredNorm();
  const auto df = static_cast<double>(points.x.size()) - 2.0;
  return {slope, df > 0.0 ? std::sqrt((v - slope * u).squaredNorm() / df) / u.norm()
                          : std::numeric_limits<double>::infinity()};
}

Defined<Slope> slope_of(const std::map<double, Repeats>& levels, const Points& points) {
  if (std::isnan(levels.begin()->second.measured.front())) {
    return least_squares(points);
  }
  const auto scatter = scatter_of(levels);
  if (!scatter) {
    return Undefined{
        "no level was presented twice, so that the error of the measured stimuli is "
        "not known"};
  }
  std::vector<NoisyPoint> noisy;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    noisy.push_back({points.x[i], points.y[i], points.counts[i]});
  }
  const auto line = noisy_line(noisy, *scatter);
  return line ? Defined<Slope>(Slope{line->slope, line->error}) : Undefined{line.because()};
}

double r_squared_of(const std::vector<double>& x, const std::vector<double>& y) {
  const VectorXd a = VectorXd::Map(x.data(), std::ssize(x)),
                 b = VectorXd::Map(y.data(), std::ssize(y));
  const VectorXd u = a.array() - a.mean(), v = b.array() - b.mean();
  const double all = v.squaredNorm();
  return all > 0.0 ? std::pow(u.dot(v), 2.0) / (u.squaredNorm() * all) : 1.0;
}

/// @param level  coverage of the interval
PersonalLine personal(const Points& points, const Slope& slope, double level) {
  const double df = static_cast<double>(points.x.size()) - 2.0;
  const double half = df > 0.0 ? t_quantile(0.5 + 0.5 * level, df) * slope.error : slope.error;
  const double mean_x = mean_of(points.x), mean_y = mean_of(points.y);
  double left = 0.0;
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    left += std::pow(points.y[i] - mean_y - slope.value * (points.x[i] - mean_x), 2.0);
  }
  return {slope.value, slope.value - half, slope.value + half, r_squared_of(points.x, points.y),
          df > 0.0 ? std::sqrt(left / df) : std::numeric_limits<double>::infinity()};
}

/// Logarithms of the moduli, with sum 0; nothing unless all participants are joined by levels.
std::optional<VectorXd> log_moduli(const Logs& logs) {
  const Index n = std::ssize(logs);
  std::map<double, std::pair<double, double>> levels;  // sum of the logs, number of participants
  for (const auto& [participant, own] : logs) {
    for (const auto& [level, repeats] : own) {
      levels[level].first += mean_of(repeats.estimates);
      levels[level].second += 1.0;
    }
  }
  // Normal equations of log estimate = participant + level, the levels eliminated.
  MatrixXd matrix = MatrixXd::Constant(n, n, 1.0 / static_cast<double>(n));  // sum of moduli is 0
  VectorXd right = VectorXd::Zero(n);
  Index i = 0;
  for (const auto& [participant, own] : logs) {
    for (const auto& [level, repeats] : own) {
      const auto& [sum, count] = levels[level];
      matrix(i, i) += 1.0;
      right[i] += mean_of(repeats.estimates) - sum / count;
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

/// Values of all participants at a level.
struct LevelValues {
  std::vector<double> x, y;  // logarithms of what was measured, and of equalised estimates
};

std::vector<MagnitudeLevel> level_means(const Logs& logs, const VectorXd& moduli, double level) {
  std::map<double, LevelValues> equalised;
  Index i = 0;
  for (const auto& [participant, own] : logs) {
    const Points points = points_of(own);
    std::size_t k = 0;
    for (const auto& [at, repeats] : own) {
      equalised[at].x.push_back(points.x[k]);
      equalised[at].y.push_back(points.y[k++] - moduli[i]);
    }
    ++i;
  }
  std::vector<MagnitudeLevel> result;
  for (const auto& [at, values] : equalised) {
    double error = 0.0;
    const double half = half_width(values.y, level, error);
    const double mean = mean_of(values.y);
    result.push_back({at, std::exp(mean_of(values.x)), std::exp(mean), std::exp(mean - half),
                      std::exp(mean + half), values.y.size()});
  }
  return result;
}

/// Every participant's line. Undefined as power_law(), for the first who has none.
Defined<std::vector<PersonalLine>> lines_of(const Logs& logs, double level) {
  std::vector<PersonalLine> lines;
  for (const auto& [participant, own] : logs) {
    const Points points = points_of(own);
    const auto slope = slope_of(own, points);
    if (!slope) {
      return Undefined{"of participant " + std::to_string(participant) + ", " + slope.because()};
    }
    lines.push_back(personal(points, *slope, level));
  }
  return lines;
}

/// Exponent, constant and fit over participants, from their lines and the levels.
void summarise(PowerLaw& law, double level) {
  law.exponent = mean_of(law.exponents);
  const double half = half_width(law.exponents, level, law.error);
  if (law.exponents.size() > 1) {
    law.low = law.exponent - half;
    law.high = law.exponent + half;
  } else {
    law.low = law.high = Undefined{"there is one participant only"};
  }
  std::vector<double> x, y;
  for (const MagnitudeLevel& l : law.levels) {
    x.push_back(std::log(l.measured));
    y.push_back(std::log(l.mean));
  }
  law.constant = std::exp(mean_of(y) - law.exponent * mean_of(x));
  law.r_squared = r_squared_of(x, y);
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
  const auto lines = lines_of(*logs, level);
  if (!lines) {
    return Undefined{lines.because()};
  }
  PowerLaw law;
  law.lines = *lines;
  Index i = 0;
  for (const auto& [participant, own] : *logs) {
    law.participants.push_back(participant);
    law.exponents.push_back(law.lines[static_cast<std::size_t>(i)].exponent);
    law.moduli.push_back(std::exp((*moduli)[i++]));
  }
  law.levels = level_means(*logs, *moduli, level);
  summarise(law, level);
  return law;
}

}  // namespace haptrial::analysis
