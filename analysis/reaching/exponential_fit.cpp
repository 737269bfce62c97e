#include "analysis/reaching/exponential_fit.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_min.h>

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

namespace haptrial::analysis {
namespace {

constexpr double kShortest = 0.1;  // [cycles]
constexpr double kLongest = 10.0;  // times the number of cycles
constexpr int kGrid = 60;

/// One for each cycle; the value of one without weight is 0.
struct Points {
  Eigen::ArrayXd value, weight;
  double count{0.0};  // with weight
};

/// Asymptote and amplitude at a time constant, and the weighted squares that are left.
struct LinearPart {
  double asymptote, amplitude, squares;
};

/// Weighted means of values and decay.
struct Centre {
  double value{0.0}, decay{0.0};
};

Centre centre_of(const Points& points, double factor) {
  Centre centre;
  double total = 0.0;
  double decay = 1.0;
  for (Eigen::Index n = 0; n < points.value.size(); ++n, decay *= factor) {
    total += points.weight[n];
    centre.value += points.weight[n] * points.value[n];
    centre.decay += points.weight[n] * decay;
  }
  return {centre.value / total, centre.decay / total};
}

LinearPart linear_part(const Points& points, double time_constant) {
  const double factor = std::exp(-1.0 / time_constant);
  const Centre centre = centre_of(points, factor);
  double spread = 0.0, common = 0.0, squares = 0.0;
  double decay = 1.0;
  for (Eigen::Index n = 0; n < points.value.size(); ++n, decay *= factor) {
    const double x = decay - centre.decay;
    spread += points.weight[n] * x * x;
    common += points.weight[n] * x * (points.value[n] - centre.value);
  }
  const double amplitude = spread > 0.0 ? common / spread : 0.0;
  decay = 1.0;
  for (Eigen::Index n = 0; n < points.value.size(); ++n, decay *= factor) {
    const double left = points.value[n] - centre.value - amplitude * (decay - centre.decay);
    squares += points.weight[n] * left * left;
  }
  return {centre.value - amplitude * centre.decay, amplitude, squares};
}

double squares_at(double log_time, void* points) {
  return linear_part(*static_cast<const Points*>(points), std::exp(log_time)).squares;
}

/// Searches between the neighbours of the best point of a grid.
double brent(Points& points, double low, double middle, double high) {
  const std::unique_ptr<gsl_min_fminimizer, decltype(&gsl_min_fminimizer_free)> search(
      gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent), gsl_min_fminimizer_free);
  gsl_function function{squares_at, &points};
  if (!(squares_at(middle, &points) < squares_at(low, &points) &&
        squares_at(middle, &points) < squares_at(high, &points)) ||
      gsl_min_fminimizer_set(search.get(), &function, middle, low, high) != GSL_SUCCESS) {
    return middle;
  }
  for (int i = 0; i < 100; ++i) {
    if (gsl_min_fminimizer_iterate(search.get()) != GSL_SUCCESS ||
        gsl_min_fminimizer_x_upper(search.get()) - gsl_min_fminimizer_x_lower(search.get()) <
            1e-9) {
      break;
    }
  }
  return gsl_min_fminimizer_x_minimum(search.get());
}

struct TimeConstant {
  double value;
  bool at_bound;
};

TimeConstant best_time_constant(Points& points) {
  const double low = std::log(kShortest);
  const double high = std::log(kLongest * static_cast<double>(points.value.size()));
  const double step = (high - low) / kGrid;
  std::vector<double> squares;
  for (int i = 0; i <= kGrid; ++i) {
    squares.push_back(squares_at(low + step * i, &points));
  }
  const auto best = std::ranges::min_element(squares) - squares.begin();
  const double at = low + step * static_cast<double>(best);
  if (best == 0 || best == kGrid) {
    return {std::exp(at), true};
  }
  return {std::exp(brent(points, at - step, at, at + step)), false};
}

/// Points of at least five values that are finite and vary; otherwise why not.
Defined<Points> points_of(std::span<const double> values, std::span<const double> weights) {
  const Eigen::Index n = std::ssize(values);
  Points points{Eigen::ArrayXd::Zero(n), Eigen::ArrayXd::Zero(n)};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double w = weights.empty() ? 1.0 : weights[k];
    if (!(w > 0.0)) {
      continue;
    }
    if (!std::isfinite(values[k]) || !std::isfinite(w)) {
      return Undefined{"a value is not finite"};
    }
    points.value[i] = values[k];
    points.weight[i] = w;
    points.count += 1.0;
    low = std::min(low, values[k]);
    high = std::max(high, values[k]);
  }
  if (points.count < 5.0) {
    return Undefined{"there are fewer than five cycles"};
  }
  if (low == high) {
    return Undefined{"the values do not vary"};
  }
  return points;
}

/// A fit, also where the time constant is at a bound.
struct BoundedFit {
  ExponentialFit fit;
  bool at_bound{false};
};

Defined<BoundedFit> bounded_fit(std::span<const double> values, std::span<const double> weights) {
  auto points = points_of(values, weights);
  if (!points) {
    return Undefined{points.because()};
  }
  Points own = *points;
  const TimeConstant best = best_time_constant(own);
  const LinearPart part = linear_part(own, best.value);
  BoundedFit result;
  result.at_bound = best.at_bound;
  result.fit = {part.asymptote, part.amplitude, best.value, 0.0, 0.0};
  const double mean = (own.weight * own.value).sum() / own.weight.sum();
  result.fit.r_squared = 1.0 - part.squares / (own.weight * (own.value - mean).square()).sum();
  result.fit.deviation = std::sqrt(part.squares / (own.count - 3.0) * own.count / own.weight.sum());
  return result;
}

Defined<BoundedFit> mean_fit(const CycleTable& table, std::span<const std::size_t> rows) {
  std::vector<double> means(table.cycles(), 0.0), counts(table.cycles(), 0.0);
  for (const std::size_t row : rows) {
    for (std::size_t c = 0; c < means.size(); ++c) {
      if (const auto& value = table.values[row][c]) {
        means[c] += *value;
        counts[c] += 1.0;
      }
    }
  }
  for (std::size_t c = 0; c < means.size(); ++c) {
    means[c] /= std::max(1.0, counts[c]);
  }
  return bounded_fit(means, counts);
}

/// An interval that ends where the search did is open on that side.
Defined<BootstrapInterval> opened(const Defined<BootstrapInterval>& interval, std::size_t cycles) {
  if (!interval) {
    return interval;
  }
  constexpr double kRounding = 1e-9;
  constexpr double kOpen = std::numeric_limits<double>::infinity();
  BootstrapInterval stated = *interval;
  if (stated.low <= kShortest * (1.0 + kRounding)) {
    stated.low = -kOpen;
  }
  if (stated.high >= kLongest * static_cast<double>(cycles) * (1.0 - kRounding)) {
    stated.high = kOpen;
  }
  return stated;
}

constexpr const char* kAtBound =
    "the values do not level off, or only those of the first cycle differ from the others";

}  // namespace

double ExponentialFit::at(double cycle) const {
  return asymptote + amplitude * std::exp(-cycle / time_constant);
}

Defined<ExponentialFit> fit_exponential(std::span<const double> values,
                                        std::span<const double> weights) {
  if (!weights.empty() && weights.size() != values.size()) {
    throw std::invalid_argument("weights must be none or as many as values");
  }
  const auto fit = bounded_fit(values, weights);
  if (!fit) {
    return Undefined{fit.because()};
  }
  if (fit->at_bound) {
    return Undefined{kAtBound};
  }
  return fit->fit;
}

Defined<LearningFit> fit_learning(const CycleTable& table, const ParticipantResampling& how) {
  std::vector<std::size_t> everybody(table.values.size());
  std::iota(everybody.begin(), everybody.end(), std::size_t{0});
  const auto whole = mean_fit(table, everybody);
  if (!whole) {
    return Undefined{whole.because()};
  }
  if (whole->at_bound) {
    return Undefined{kAtBound};
  }
  std::atomic<std::size_t> at_bound{0};
  const auto estimate =
      [&](std::span<const std::size_t> rows) -> std::optional<std::vector<double>> {
    const auto drawn = mean_fit(table, rows);
    if (!drawn) {
      return std::nullopt;
    }
    // A draw has as many rows as there are participants; the jackknife has fewer.
    at_bound += drawn->at_bound && rows.size() == everybody.size() ? 1 : 0;
    return std::vector{drawn->fit.asymptote, drawn->fit.amplitude, drawn->fit.time_constant};
  };
  const ExponentialFit& fit = whole->fit;
  const auto intervals = participant_intervals(
      everybody.size(), {fit.asymptote, fit.amplitude, fit.time_constant}, estimate, how);
  return LearningFit{fit, intervals[0], intervals[1], opened(intervals[2], table.cycles()),
                     at_bound.load()};
}

}  // namespace haptrial::analysis
