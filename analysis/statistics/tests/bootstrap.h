#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/base/resampling.h"

namespace haptrial::analysis {

/// An estimate with its bootstrap interval.
struct BootstrapInterval {
  double estimate{0.0};
  double low{0.0};
  double high{0.0};
  double level{0.95};
  double bias{0.0};          // z0, in standard normal units
  double acceleration{0.0};  // a
  std::size_t resamples{0};
  bool corrected{true};  // bias-corrected and accelerated; else percentiles
};

/// The rows drawn from each sample; a row may come more than once.
using DrawnRows = std::vector<std::vector<std::size_t>>;

/// A number from drawn rows. Called by several threads at once. Not finite: it does not exist.
using RowStatistic = std::function<double(const DrawnRows& rows)>;

/// The interval from given replicates.
/// @param replicates  the statistic of each resample.
/// @param jackknife   per sample, the statistic without each of its rows in turn.
/// Undefined when a number is not finite, all replicates are equal or lie on one side of the
/// estimate, or there are too few of them for the level.
/// Source: Efron 1987, Journal of the American Statistical Association 82; several samples and the
/// interpolation between order statistics: Davison and Hinkley 1997, Bootstrap Methods and their
/// Application, §5.3.2 and eq. 5.8.
Defined<BootstrapInterval> bca_interval(double estimate, std::vector<double> replicates,
                                        const std::vector<std::vector<double>>& jackknife,
                                        double level = 0.95);

/// The percentiles of given replicates, for where the corrected interval does not exist.
/// Undefined when a number is not finite or there are too few replicates for the level.
Defined<BootstrapInterval> percentile_interval(double estimate, std::vector<double> replicates,
                                               double level = 0.95);

/// Draws rows with replacement within each sample of the given sizes.
/// Undefined as bca_interval, and with fewer than two rows in a sample.
Defined<BootstrapInterval> bootstrap(const std::vector<std::size_t>& sizes,
                                     const RowStatistic& statistic, const Resampling& resampling,
                                     double level = 0.95);

/// The same for a number from values.
Defined<BootstrapInterval> bootstrap(
    std::span<const double> values,
    const std::function<double(std::span<const double> drawn)>& statistic,
    const Resampling& resampling, double level = 0.95);

/// mean(a) - mean(b), the samples drawn independently.
Defined<BootstrapInterval> bootstrap_difference(std::span<const double> a,
                                                std::span<const double> b,
                                                const Resampling& resampling, double level = 0.95);

}  // namespace haptrial::analysis
