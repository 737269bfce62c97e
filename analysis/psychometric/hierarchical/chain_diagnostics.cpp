#include "analysis/psychometric/hierarchical/chain_diagnostics.h"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/base/require.h"

namespace haptrial::analysis {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

using Halves = std::vector<std::vector<double>>;  // of one length

/// The first and the last half of each chain; a middle draw of an odd length belongs to neither.
Halves split(const std::vector<std::span<const double>>& chains) {
  Halves halves;
  const std::size_t half = chains.front().size() / 2;
  for (const std::span<const double>& chain : chains) {
    halves.emplace_back(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(half));
    halves.emplace_back(chain.end() - static_cast<std::ptrdiff_t>(half), chain.end());
  }
  return halves;
}

/// Replaces draws by normal quantiles of their ranks over all halves; equal draws share a rank.
void normalise_ranks(Halves& halves) {
  struct Place {
    double draw;
    double* at;
  };
  std::vector<Place> order;
  for (std::vector<double>& half : halves) {
    for (double& draw : half) {
      order.push_back({draw, &draw});
    }
  }
  std::ranges::sort(order, {}, &Place::draw);
  const double count = static_cast<double>(order.size());
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    end = first + 1;
    while (end < order.size() && order[end].draw == order[first].draw) {
      ++end;
    }
    const double rank = 0.5 * static_cast<double>(first + 1 + end);
    const double z = gsl_cdf_ugaussian_Pinv((rank - 0.375) / (count + 0.25));
    for (std::size_t i = first; i < end; ++i) {
      *order[i].at = z;
    }
  }
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Means of the halves, and variance within and over all of them.
struct Variances {
  std::vector<double> means;
  double within{0.0};
  double total{0.0};  // (n - 1) / n within + between
};

Variances variances_of(const Halves& halves) {
  const double length = static_cast<double>(halves.front().size());
  Variances v;
  for (const std::vector<double>& half : halves) {
    v.means.push_back(mean_of(half));
    for (const double draw : half) {
      v.within += (draw - v.means.back()) * (draw - v.means.back());
    }
  }
  v.within /= (length - 1.0) * static_cast<double>(halves.size());
  const double grand = mean_of(v.means);
  double between = 0.0;
  for (const double mean : v.means) {
    between += (mean - grand) * (mean - grand) / static_cast<double>(halves.size() - 1);
  }
  v.total = (length - 1.0) / length * v.within + between;
  return v;
}

double r_hat_of(const Halves& halves) {
  const Variances v = variances_of(halves);
  return v.within > 0.0 ? std::sqrt(v.total / v.within) : kUnknown;
}

/// The autocorrelation at a lag, from all halves together.
double correlation_at(const Halves& halves, const Variances& v, std::size_t lag) {
  double mean = 0.0;
  for (std::size_t h = 0; h < halves.size(); ++h) {
    double sum = 0.0;
    for (std::size_t i = lag; i < halves[h].size(); ++i) {
      sum += (halves[h][i] - v.means[h]) * (halves[h][i - lag] - v.means[h]);
    }
    mean += sum / static_cast<double>(halves[h].size()) / static_cast<double>(halves.size());
  }
  const double length = static_cast<double>(halves.front().size());
  return 1.0 - (v.within - mean * length / (length - 1.0)) / v.total;
}

/// Geyer's sum over pairs of lags, which ends at the first that is not positive and never rises.
double effective_of(const Halves& halves) {
  const Variances v = variances_of(halves);
  const std::size_t length = halves.front().size();
  const double draws = static_cast<double>(length * halves.size());
  if (!(v.total > 0.0)) {
    return kUnknown;
  }
  double time = -1.0, before = std::numeric_limits<double>::infinity();
  for (std::size_t lag = 0; lag + 3 < length; lag += 2) {
    const double even = lag == 0 ? 1.0 : correlation_at(halves, v, lag);
    const double pair = even + correlation_at(halves, v, lag + 1);
    if (!(pair > 0.0)) {
      time += lag > 0 ? std::max(even, 0.0) : 0.0;
      break;
    }
    before = std::min(before, pair);
    time += 2.0 * before;
  }
  return draws / std::max(time, 1.0 / std::log10(draws));
}

}  // namespace

ChainDiagnostics chain_diagnostics(const std::vector<std::span<const double>>& chains) {
  require(!chains.empty() && chains.front().size() >= 8, "chains must have at least 8 draws");
  for (const std::span<const double>& chain : chains) {
    require(chain.size() == chains.front().size(), "chains must have one length");
    if (!std::ranges::all_of(chain, [](double draw) { return std::isfinite(draw); })) {
      return {kUnknown, kUnknown};
    }
  }
  Halves draws = split(chains);
  Halves distances = draws;
  std::vector<double> all;
  for (const std::vector<double>& half : draws) {
    all.insert(all.end(), half.begin(), half.end());
  }
  std::ranges::sort(all);
  const double median = 0.5 * (all[(all.size() - 1) / 2] + all[all.size() / 2]);
  for (std::vector<double>& half : distances) {
    std::ranges::for_each(half, [median](double& draw) { draw = std::abs(draw - median); });
  }
  normalise_ranks(draws);
  normalise_ranks(distances);
  return {std::max(r_hat_of(draws), r_hat_of(distances)), effective_of(draws)};
}

}  // namespace haptrial::analysis
