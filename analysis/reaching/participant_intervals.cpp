#include "analysis/reaching/participant_intervals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "analysis/statistics/base/distributions.h"

namespace haptrial::analysis {
namespace {

double expanded(double level, std::size_t participants) {
  const auto n = static_cast<double>(participants);
  const double t = t_quantile(0.5 * (1.0 + level), n - 1.0);
  return 1.0 - 2.0 * normal_upper_tail(t * std::sqrt(n / (n - 1.0)));
}

/// (numbers x draws)
using Replicates = std::vector<std::vector<double>>;

void keep(const std::optional<std::vector<double>>& numbers, std::size_t draw, Replicates& all) {
  for (std::size_t k = 0; k < all.size(); ++k) {
    all[k][draw] = numbers ? (*numbers)[k] : std::numeric_limits<double>::quiet_NaN();
  }
}

Replicates drawn(std::size_t participants, std::size_t numbers,
                 const ParticipantEstimator& estimator, const Resampling& resampling) {
  Replicates all(numbers, std::vector<double>(resampling.count));
  for_each_part(resampling, [&](RandomStream& random, std::size_t first, std::size_t last) {
    std::vector<std::size_t> rows(participants);
    for (std::size_t i = first; i < last; ++i) {
      std::ranges::generate(rows, [&] { return random.below(participants); });
      keep(estimator(rows), i, all);
    }
  });
  return all;
}

Replicates without_each(std::size_t participants, std::size_t numbers,
                        const ParticipantEstimator& estimator) {
  Replicates all(numbers, std::vector<double>(participants));
  for (std::size_t i = 0; i < participants; ++i) {
    std::vector<std::size_t> rows(participants);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(i));
    keep(estimator(rows), i, all);
  }
  return all;
}

constexpr double kMostFailed = 0.1;  // share of draws without numbers that may be left out

bool is_missing(double value) { return std::isnan(value); }

/// The interval of one number; draws without it are left out.
Defined<BootstrapInterval> interval_of(double estimate, std::vector<double> replicates,
                                       const std::vector<double>& jackknife,
                                       std::size_t participants, double level) {
  if (std::ranges::any_of(jackknife, is_missing)) {
    return Undefined{"it does not exist without one of the participants"};
  }
  const std::size_t drawn = replicates.size();
  const std::size_t failed = std::erase_if(replicates, is_missing);
  if (static_cast<double>(failed) > kMostFailed * static_cast<double>(drawn)) {
    return Undefined{fmt::format("it does not exist for {} of {} resamples", failed, drawn)};
  }
  auto interval =
      bca_interval(estimate, std::move(replicates), {jackknife}, expanded(level, participants));
  if (!interval) {
    return Undefined{fmt::format("with {} participants {}", participants, interval.because())};
  }
  BootstrapInterval stated = *interval;
  stated.level = level;
  return stated;
}

}  // namespace

std::vector<Defined<BootstrapInterval>> participant_intervals(std::size_t participants,
                                                              const std::vector<double>& estimates,
                                                              const ParticipantEstimator& estimator,
                                                              const ParticipantResampling& how) {
  if (!(how.level > 0.0 && how.level < 1.0)) {
    throw std::invalid_argument("level of an interval must lie inside (0, 1)");
  }
  if (participants < 3) {
    return {estimates.size(), Undefined{"there are fewer than three participants"}};
  }
  Replicates replicates = drawn(participants, estimates.size(), estimator, how.resampling);
  const Replicates jackknife = without_each(participants, estimates.size(), estimator);
  std::vector<Defined<BootstrapInterval>> intervals;
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    intervals.push_back(
        interval_of(estimates[k], std::move(replicates[k]), jackknife[k], participants, how.level));
  }
  return intervals;
}

}  // namespace haptrial::analysis
