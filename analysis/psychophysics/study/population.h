#pragma once

#include <string>
#include <vector>

#include "analysis/psychometric/hierarchical/hierarchical_fit.h"
#include "analysis/psychometric/models/binomial_mixed.h"
#include "analysis/psychophysics/fit/series.h"
#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis::trials {

/// Point at which the population's function crosses 1/2 under a condition.
struct PopulationPoint {
  std::string condition;
  Defined<EqualityPoint> point{Undefined{"nothing was fitted"}};  // on the axis
};

/// Probit mixed model over participants: P(answer 1) = Phi(a + b z + conditions + z conditions), z
/// the standardised axis; intercept, slope and the condition's effect on each vary between
/// participants, with all covariances. Intervals and p values are of Student's t with participants
/// - 1 degrees of freedom, as participants are what varies.
struct PopulationModel {
  std::vector<std::string> names;  // of the coefficients
  BinomialMixedModel model;
  double centre{0.0}, scale{1.0};       // z = (x - centre) / scale
  std::vector<PopulationPoint> points;  // a condition each
  /// Whether the second condition differs from the first: Wald's test of its coefficient.
  /// Undefined unless there are two conditions.
  Defined<double> condition_p{Undefined{"there is one condition"}};
  double condition_t{0.0};
  int condition_df{0};
};

/// Undefined with a guess rate above 0, which a probit line cannot have, with more than two
/// conditions, with fewer than five participants, and as binomial_mixed_model().
Defined<PopulationModel> population_model(const std::vector<AnsweredSeries>& series,
                                          const TrialsPlan& plan);

/// Hierarchical Bayesian functions of all participants under all conditions.
struct HierarchicalFunctions {
  std::vector<std::string> participants;         // (people of the fit)
  std::vector<std::string> conditions;           // (conditions of the fit) levels joined by ", "
  std::vector<std::vector<std::string>> levels;  // (conditions) of TrialsPlan::by
  std::vector<std::size_t> condition_of;         // (functions of the fit)
  hierarchical::HierarchicalFit fit;
};

/// Undefined with fewer than three participants, or as a model's options and answers are refused.
/// @param series  ordered by participant
Defined<HierarchicalFunctions> hierarchical_functions(const std::vector<AnsweredSeries>& series,
                                                      const TrialsPlan& plan, int threads);

}  // namespace haptrial::analysis::trials
