#include "analysis/reaching/learning/participant_intervals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

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
    const auto interval = bca_interval(estimates[k], std::move(replicates[k]), {jackknife[k]},
                                       expanded(how.level, participants));
    if (interval) {
      BootstrapInterval stated = *interval;
      stated.level = how.level;
      intervals.emplace_back(stated);
    } else {
      intervals.emplace_back(Undefined{interval.because()});
    }
  }
  return intervals;
}

}  // namespace haptrial::analysis
