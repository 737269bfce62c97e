#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/psychometric/procedure/quest_tables.h"

namespace haptrial::analysis {

/// A trial of a function of several stimulus variables.
struct SurfaceTrial {
  std::vector<double> stimulus;  // (dimensions), as presented
  std::size_t outcome{0};
};

/// Estimate of one parameter from the answers.
struct SurfaceParameter {
  std::string name;
  double mean{0.0};            // of the posterior
  double deviation{0.0};       // likewise
  double low{0.0}, high{0.0};  // its central 95 %
  bool at_edge{false};         // it is cut off by an end of the values that the definition lists
};

/// A function of several stimulus variables, fitted.
struct SurfaceFit {
  std::size_t trials{0};
  std::vector<SurfaceParameter> parameters;  // those with several values
  /// Values of all parameters in the definition's order, each set equally probable: the joint
  /// posterior for what follows from several parameters.
  std::vector<std::vector<double>> draws;
};

/// Most parameters with several values that a fit takes.
inline constexpr std::size_t kMostSurfaceParameters = 4;

/// The posterior over all parameters of a definition, from answers to all its stimulus variables.
/// The values that the definition lists for a parameter are knots: between neighbours the value and
/// the weight of its prior go in straight lines, so the posterior is that of any value between the
/// first and the last. Grids that follow the posterior integrate it.
///
/// Takes some 10⁴ probabilities for each different stimulus.
/// @throws std::invalid_argument without trials; for a trial whose stimulus has other dimensions or
/// whose outcome the definition does not have; without a parameter of several values or with more
/// than kMostSurfaceParameters; if the answers are impossible for all values
SurfaceFit fit_surface(const psychometric::QuestDefinition& definition,
                       const std::vector<SurfaceTrial>& trials);

}  // namespace haptrial::analysis
