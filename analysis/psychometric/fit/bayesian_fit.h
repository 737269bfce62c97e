#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/psychometric/fit/credible.h"
#include "analysis/psychometric/fit/fitted_function.h"
#include "analysis/psychometric/fit/prior.h"
#include "analysis/psychometric/fit/trial_blocks.h"

namespace haptrial::analysis {

/// How a credible interval comes from the posterior.
enum class CredibleMethod {
  kPercentiles,  // equal tails of the marginal
  kProject,      // extent of the smallest region of the joint posterior
};

struct BayesianOptions {
  // Sigmoid, axis, share, tail and direction; the guess rate of a forced choice. The rest is
  // sought.
  psychometric::PsychometricParameters function{.guess = 0.5};
  Task task{Task::kForcedChoice};
  std::array<std::optional<double>, kDimensions> fixed;  // parameters with a known value
  std::optional<StimulusRange> range;                    // else that of the levels
  double beta_prior{10.0};                               // b of lapse, guess and eta, >= 1
  bool pool_levels{true};                                // blocks of one level are one block
  std::array<int, kDimensions> first_steps{};            // of the search; 0: by task
  std::array<int, kDimensions> steps{};                  // of the grid; 0: by task
  double border_mass{1e-5};                              // of a step that the grid keeps
  std::vector<double> levels{0.95, 0.9, 0.68};           // of the intervals
  CredibleMethod method{CredibleMethod::kPercentiles};
  int threads{1};
};

struct BayesianFit {
  std::array<Marginal, kDimensions> marginals;
  FittedParameters map;       // largest posterior density
  FittedParameters mean;      // posterior mean
  double log_posterior{0.0};  // at the map: prior and likelihood without binomial coefficients
  std::array<std::vector<CredibleInterval>, kDimensions> intervals;  // as BayesianOptions::levels
  std::vector<TrialBlock> blocks;                                    // as they were fitted
  PsychometricDeviance deviance;                                     // of the map
  std::vector<std::string> warnings;  // sentences: where the prior or the grid decides
};

/// The posterior of the five parameters on a grid. A first grid over all that the prior allows
/// finds the steps that hold at least `border_mass` of a marginal; the grid goes from the step
/// before these to the one after.
/// Thresholds and widths are on the axis of the function; fitted_function(options.function,
/// fit.map) is the function itself.
/// @throws std::invalid_argument naming the option or the part of a block that breaks its bound.
/// Source: Schuett, Harmeling, Macke and Wichmann 2016, Vision Research 122.
BayesianFit bayesian_fit(std::span<const TrialBlock> blocks, const BayesianOptions& options);

}  // namespace haptrial::analysis
