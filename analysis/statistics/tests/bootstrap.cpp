#include "analysis/statistics/tests/bootstrap.h"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "analysis/statistics/base/descriptive.h"

namespace haptrial::analysis {
namespace {

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

// z0: how far the estimate lies off the middle of the (sorted) replicates. A tie, also one that
// only the order of a sum parts, counts half.
Defined<double> bias_correction(double estimate, const std::vector<double>& sorted) {
  const double rounding =
      1e-13 * std::max({std::abs(estimate), std::abs(sorted.front()), std::abs(sorted.back())});
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), estimate - rounding);
  const auto last = std::upper_bound(sorted.begin(), sorted.end(), estimate + rounding);
  const auto below = static_cast<double>(first - sorted.begin());
  const auto ties = static_cast<double>(last - first);
  const double share = (below + 0.5 * ties) / static_cast<double>(sorted.size());
  if (share <= 0.0 || share >= 1.0) {
    return Undefined{"every resample lies on the same side of the estimate"};
  }
  return gsl_cdf_ugaussian_Pinv(share);
}

// Acceleration from the influence of each row, by its jackknife.
double acceleration(const std::vector<std::vector<double>>& jackknife) {
  double squares = 0.0;
  double cubes = 0.0;
  for (const auto& sample : jackknife) {
    const auto m = moments(sample);
    if (!m) {
      continue;
    }
    const auto n = static_cast<double>(m->count);
    for (const double value : sample) {
      const double influence = -((value - m->origin) - m->offset) * (n - 1.0) / n;
      squares += influence * influence;
      cubes += influence * influence * influence;
    }
  }
  return squares > 0.0 ? cubes / (6.0 * squares * std::sqrt(squares)) : 0.0;
}

/// Why resamples do not reach so far out.
std::string beyond(std::size_t resamples, double fraction) {
  constexpr double kWorthMaking = 1e7;
  const double needed = 1.0 / std::min(fraction, 1.0 - fraction);
  return fmt::format("its ends lie beyond the {} resamples{}", resamples,
                     needed < kWorthMaking
                         ? fmt::format("; about {:.0f} would reach them", 2.0 * needed)
                         : ", as far as so few values take them");
}

// Quantile between order statistics, linear on the normal scale.
Defined<double> normal_interpolated(const std::vector<double>& sorted, double fraction) {
  const auto places = static_cast<double>(sorted.size()) + 1.0;
  const double place = places * fraction;
  const double below = std::floor(place);
  if (!(below >= 1.0 && below < places - 1.0)) {
    return Undefined{beyond(sorted.size(), fraction)};
  }
  const double low = gsl_cdf_ugaussian_Pinv(below / places);
  const double high = gsl_cdf_ugaussian_Pinv((below + 1.0) / places);
  const double part = (gsl_cdf_ugaussian_Pinv(fraction) - low) / (high - low);
  const auto k = static_cast<std::size_t>(below);
  return sorted[k - 1] + part * (sorted[k] - sorted[k - 1]);
}

DrawnRows drawn_rows(const std::vector<std::size_t>& sizes, RandomStream& random) {
  DrawnRows rows(sizes.size());
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    rows[s].resize(sizes[s]);
    std::generate(rows[s].begin(), rows[s].end(), [&] { return random.below(sizes[s]); });
  }
  return rows;
}

DrawnRows all_rows(const std::vector<std::size_t>& sizes) {
  DrawnRows rows(sizes.size());
  for (std::size_t s = 0; s < sizes.size(); ++s) {
    rows[s].resize(sizes[s]);
    std::iota(rows[s].begin(), rows[s].end(), std::size_t{0});
  }
  return rows;
}

std::vector<std::vector<double>> jackknife(const DrawnRows& all, const RowStatistic& statistic) {
  std::vector<std::vector<double>> result(all.size());
  for (std::size_t s = 0; s < all.size(); ++s) {
    for (std::size_t i = 0; i < all[s].size(); ++i) {
      DrawnRows rows = all;
      rows[s].erase(rows[s].begin() + static_cast<std::ptrdiff_t>(i));
      result[s].push_back(statistic(rows));
    }
  }
  return result;
}

std::vector<double> picked(std::span<const double> values, const std::vector<std::size_t>& rows) {
  std::vector<double> result(rows.size());
  std::transform(rows.begin(), rows.end(), result.begin(), [&](auto row) { return values[row]; });
  return result;
}

}  // namespace

Defined<BootstrapInterval> bca_interval(double estimate, std::vector<double> replicates,
                                        const std::vector<std::vector<double>>& jackknife,
                                        double level) {
  if (replicates.empty()) {
    return Undefined{"there are no resamples"};
  }
  if (!std::isfinite(estimate)) {
    return Undefined{"the statistic does not exist for these values"};
  }
  if (!all_finite(replicates) || !std::all_of(jackknife.begin(), jackknife.end(), all_finite)) {
    return Undefined{"the statistic does not exist for some resamples"};
  }
  std::sort(replicates.begin(), replicates.end());
  if (replicates.front() == replicates.back()) {
    return Undefined{"every resample gives the same value"};
  }
  const auto bias = bias_correction(estimate, replicates);
  if (!bias) {
    return Undefined{bias.because()};
  }
  const double a = acceleration(jackknife);
  const auto limit = [&](double z) -> Defined<double> {
    const double shifted = *bias + z;
    if (a * shifted >= 1.0) {
      return Undefined{"the statistic is too skewed for its interval"};
    }
    const double corrected = *bias + shifted / (1.0 - a * shifted);
    return normal_interpolated(replicates, gsl_cdf_ugaussian_P(corrected));
  };
  const double z = gsl_cdf_ugaussian_Pinv(0.5 * (1.0 + level));
  const auto low = limit(-z);
  const auto high = limit(z);
  if (!low || !high) {
    return Undefined{!low ? low.because() : high.because()};
  }
  return BootstrapInterval{estimate, *low, *high, level, *bias, a, replicates.size(), true};
}

Defined<BootstrapInterval> percentile_interval(double estimate, std::vector<double> replicates,
                                               double level) {
  if (!std::isfinite(estimate) || !all_finite(replicates)) {
    return Undefined{"the statistic does not exist for these values or some resamples"};
  }
  std::sort(replicates.begin(), replicates.end());
  const auto low = normal_interpolated(replicates, 0.5 * (1.0 - level));
  const auto high = normal_interpolated(replicates, 0.5 * (1.0 + level));
  if (!low || !high) {
    return Undefined{!low ? low.because() : high.because()};
  }
  return BootstrapInterval{estimate, *low, *high, level, 0.0, 0.0, replicates.size(), false};
}

Defined<BootstrapInterval> bootstrap(const std::vector<std::size_t>& sizes,
                                     const RowStatistic& statistic, const Resampling& resampling,
                                     double level) {
  if (sizes.empty() || *std::min_element(sizes.begin(), sizes.end()) < 2) {
    return Undefined{"resampling needs at least two values in each sample"};
  }
  const DrawnRows all = all_rows(sizes);
  std::vector<double> replicates(resampling.count);
  for_each_part(resampling, [&](RandomStream& random, std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      replicates[i] = statistic(drawn_rows(sizes, random));
    }
  });
  return bca_interval(statistic(all), std::move(replicates), jackknife(all, statistic), level);
}

Defined<BootstrapInterval> bootstrap(
    std::span<const double> values,
    const std::function<double(std::span<const double> drawn)>& statistic,
    const Resampling& resampling, double level) {
  if (const auto m = moments(values); !m) {
    return Undefined{m.because()};
  }
  return bootstrap(
      std::vector{values.size()},
      [&](const DrawnRows& rows) { return statistic(picked(values, rows.front())); }, resampling,
      level);
}

Defined<BootstrapInterval> bootstrap_difference(std::span<const double> a,
                                                std::span<const double> b,
                                                const Resampling& resampling, double level) {
  for (const auto& sample : {moments(a), moments(b)}) {
    if (!sample) {
      return Undefined{sample.because()};
    }
  }
  const auto difference = [&](const DrawnRows& rows) {
    return mean_difference(*moments(picked(a, rows[0])), *moments(picked(b, rows[1])));
  };
  return bootstrap({a.size(), b.size()}, difference, resampling, level);
}

}  // namespace haptrial::analysis
