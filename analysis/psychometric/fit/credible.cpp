#include "analysis/psychometric/fit/credible.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haptrial::analysis {
namespace {

/// The value at which the distribution function of a marginal reaches `share`.
double quantile_of(const Marginal& marginal, double share) {
  double below = 0.0, edge = marginal.values.front();
  for (std::size_t i = 0; i < marginal.values.size(); ++i) {
    const double mass = marginal.density[i] * marginal.weights[i];
    if (below + mass >= share && mass > 0.0) {
      return edge + marginal.weights[i] * (share - below) / mass;
    }
    below += mass;
    edge += marginal.weights[i];
  }
  return marginal.values.back();
}

std::string rounded_percent(double share) {
  return std::to_string(static_cast<int>(std::lround(100.0 * share))) + " %";
}

/// The share of a marginal beyond a value.
double mass_where(const Marginal& marginal, double low, double high) {
  double mass = 0.0;
  for (std::size_t i = 0; i < marginal.values.size(); ++i) {
    if (marginal.values[i] >= low && marginal.values[i] <= high) {
      mass += marginal.density[i] * marginal.weights[i];
    }
  }
  return mass;
}

}  // namespace

std::array<Marginal, kDimensions> marginals_of(const PsychometricPosterior::Masses& masses,
                                               const GridAxes& axes) {
  std::array<Marginal, kDimensions> result;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    result[d] = {axes[d], std::vector<double>(axes[d].size(), 0.0), trapezoid_weights(axes[d])};
    // Cells are d's outer dimensions, d, and `inner` others.
    std::size_t inner = 1;
    for (std::size_t k = d + 1; k < kDimensions; ++k) {
      inner *= axes[k].size();
    }
    const std::size_t own = axes[d].size();
    for (std::size_t group = 0; group * inner < masses.cells.size(); ++group) {
      const double* first = masses.cells.data() + group * inner;
      result[d].density[group % own] += std::accumulate(first, first + inner, 0.0);
    }
    for (std::size_t i = 0; i < own; ++i) {
      result[d].density[i] /= masses.sum * result[d].weights[i];
    }
  }
  return result;
}

double mean_of(const Marginal& marginal) {
  double mean = 0.0;
  for (std::size_t i = 0; i < marginal.values.size(); ++i) {
    mean += marginal.values[i] * marginal.density[i] * marginal.weights[i];
  }
  return mean;
}

CredibleInterval percentiles(const Marginal& marginal, double level) {
  if (marginal.values.size() == 1) {
    return {marginal.values.front(), marginal.values.front()};
  }
  return {quantile_of(marginal, 0.5 - 0.5 * level), quantile_of(marginal, 0.5 + 0.5 * level)};
}

std::array<CredibleInterval, kDimensions> projected(const PsychometricPosterior::Masses& masses,
                                                    const GridAxes& axes, double level) {
  std::vector<std::uint32_t> order(masses.cells.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return masses.cells[a] > masses.cells[b] || (masses.cells[a] == masses.cells[b] && a < b);
  });
  std::array<std::size_t, kDimensions> least, most;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    least[d] = axes[d].size();
    most[d] = 0;
  }
  double held = 0.0;
  for (const std::uint32_t cell : order) {
    std::size_t place = cell;
    for (std::size_t d = kDimensions; d-- > 0;) {
      const std::size_t i = place % axes[d].size();
      place /= axes[d].size();
      least[d] = std::min(least[d], i);
      most[d] = std::max(most[d], i);
    }
    held += masses.cells[cell];
    if (held >= level * masses.sum) {
      break;
    }
  }
  std::array<CredibleInterval, kDimensions> result;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    result[d] = {axes[d][least[d]], axes[d][most[d]]};
  }
  return result;
}

std::vector<std::string> edge_warnings(const std::array<Marginal, kDimensions>& marginals,
                                       const StimulusRange& range) {
  constexpr double kReaches = 0.01;   // of the largest density
  constexpr double kOutside = 0.025;  // of the threshold's posterior
  const char* const names[kDimensions] = {"threshold", "width", "lapse rate", "guess rate",
                                          "overdispersion"};
  std::vector<std::string> result;
  for (std::size_t d = 0; d < kDimensions; ++d) {
    const std::vector<double>& density = marginals[d].density;
    if (density.size() == 1) {
      continue;
    }
    const double reached = kReaches * *std::max_element(density.begin(), density.end());
    // Rates begin at 0 by nature.
    if (d <= kWidth && density.front() > reached) {
      result.push_back(std::string("the posterior of the ") + names[d] +
                       " reaches the lower edge of its grid");
    }
    if (density.back() > reached) {
      result.push_back(std::string("the posterior of the ") + names[d] +
                       " reaches the upper edge of its grid");
    }
  }
  const Marginal& threshold = marginals[kThreshold];
  if (threshold.values.size() > 1) {
    const double outside = 1.0 - mass_where(threshold, range.low, range.high);
    if (outside > kOutside) {
      result.push_back(rounded_percent(outside) +
                       " of the threshold's posterior lies outside of the levels, where the prior "
                       "decides");
    }
  }
  const Marginal& width = marginals[kWidth];
  if (width.values.size() > 1) {
    const double narrow = mass_where(width, 0.0, 2.0 * range.spacing);
    if (narrow > kOutside) {
      result.push_back(rounded_percent(narrow) +
                       " of the width's posterior lies under twice the distance of the levels, "
                       "where the prior decides");
    }
  }
  return result;
}

}  // namespace haptrial::analysis
