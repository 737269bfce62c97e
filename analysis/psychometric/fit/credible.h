#pragma once

#include <array>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/posterior.h"

namespace haptrial::analysis {

/// Posterior of one parameter.
struct Marginal {
  std::vector<double> values;   // (n) rising
  std::vector<double> density;  // (n) sums with the weights to 1
  std::vector<double> weights;  // (n) of the trapezoid rule; 1 for a fixed parameter
};

struct CredibleInterval {
  double low{0.0};
  double high{0.0};
};

/// Marginals of the masses on a grid, and the integral of the density over the largest density.
std::array<Marginal, kDimensions> marginals_of(const PsychometricPosterior::Masses& masses,
                                               const GridAxes& axes);

double mean_of(const Marginal& marginal);

/// Places at which the marginal's distribution function, linear within each step, is (1 - level) /
/// 2 and (1 + level) / 2. @param level  inside (0, 1)
CredibleInterval percentiles(const Marginal& marginal, double level);

/// The smallest set of cells of the joint posterior that holds at least `level`, and its extent
/// along each parameter.
std::array<CredibleInterval, kDimensions> projected(const PsychometricPosterior::Masses& masses,
                                                    const GridAxes& axes, double level);

/// Sentences about an edge of the grid that the posterior reaches, and about a threshold that lies
/// outside of the levels.
std::vector<std::string> edge_warnings(const std::array<Marginal, kDimensions>& marginals,
                                       const StimulusRange& range);

}  // namespace haptrial::analysis
