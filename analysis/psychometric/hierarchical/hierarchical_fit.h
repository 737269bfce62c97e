#pragma once

#include <cstddef>
#include <vector>

#include "analysis/psychometric/hierarchical/chain_diagnostics.h"
#include "analysis/psychometric/hierarchical/hierarchical_model.h"
#include "analysis/psychometric/hierarchical/sampler.h"

namespace haptrial::analysis::hierarchical {

/// The most that R-hat and the fewest that effective draws may be for a result to stand.
inline constexpr double kMostRHat = 1.01;
inline constexpr double kFewestEffective = 400.0;

/// Posterior of one number: median and central 95 %.
struct Posterior {
  double median{0.0}, low{0.0}, high{0.0};
  ChainDiagnostics chains;

  bool converged() const {
    return chains.r_hat < kMostRHat && chains.effective >= kFewestEffective;
  }
};

/// Means of the group under a condition, or one person's function. Thresholds and widths are on the
/// axis; a group's width is that of its mean logarithm, its rates those of their mean on the scale
/// on which people are normal.
struct FunctionPosterior {
  Posterior threshold, width;
};

/// The second condition less the first, of the group's means.
struct ConditionDifference {
  std::size_t first{0}, second{1};
  Posterior threshold;      // [axis]
  Posterior width_ratio;    // second / first
  double share_above{0.5};  // of the draws in which the second threshold is the higher one
};

/// Standard deviations over people.
struct Spread {
  Posterior between;  // of people, under one condition
  Posterior within;   // of a person's difference between two conditions; if `has_within` of the fit
};

struct PersonPosterior {
  std::vector<std::size_t> series;  // of HierarchicalFit::functions
  Posterior lapse, guess;
  double predictive_p{1.0};  // share of replicated answers whose deviance is at least the observed
};

struct HierarchicalFit {
  bool converged{false};
  double r_hat{0.0};      // the largest of all numbers below; NaN: some draws do not vary
  double effective{0.0};  // the fewest
  std::size_t chains{0}, warm_up{0}, draws{0};   // of each chain
  std::vector<FunctionPosterior> conditions;     // of the group
  std::vector<ConditionDifference> differences;  // every pair
  Spread thresholds;                             // [axis]
  Spread log_widths;
  bool has_within{false};
  bool lapse_sought{false}, guess_sought{false};  // else the rates below are not set
  Posterior lapse, guess;                         // of the group
  std::vector<FunctionPosterior> functions;       // (answers of the model)
  std::vector<PersonPosterior> people;
};

/// The posterior of group and people, its convergence, and for each person whether replicated
/// answers deviate as much as those that were given. Results are the same on any number of threads.
/// @throws std::invalid_argument naming what of `sampling` breaks its bound
HierarchicalFit hierarchical_fit(const Model& model, const Sampling& sampling);

}  // namespace haptrial::analysis::hierarchical
