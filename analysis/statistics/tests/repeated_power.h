#pragma once

#include "analysis/statistics/tests/power.h"

namespace haptrial::analysis {

/// Question of a repeated-measures or mixed analysis of variance.
enum class RepeatedTerm { kWithin, kInteraction, kBetween };

/// Such an analysis that is planned: `n` is the size of each group, everybody is measured under
/// each condition, and all pairs of conditions have the same correlation over participants within
/// groups. f is the standard deviation of the means that the term makes (of conditions, of what
/// conditions and groups make together, of groups) by the standard deviation of participants within
/// a cell, as in G*Power 3 (Faul, Erdfelder, Lang and Buchner 2007, Behavior Research Methods 39).
struct RepeatedPlan {
  RepeatedTerm term{RepeatedTerm::kWithin};
  int groups{1};            // 1 to 1000; of the other terms at least 2
  int measurements{2};      // of each participant, 2 to 1000
  double correlation{0.5};  // at least 0, below 1
  double epsilon{1.0};  // of Greenhouse and Geisser, 1 / (measurements - 1) to 1; not of kBetween
  double alpha{0.05};
};

/// The chance of a significant result, from the noncentral F with N = groups n:
///
///     term         lambda                 df of the effect       df of the error
///     within       ε N m f² / (1 - ρ)     ε (m - 1)              ε (N - k) (m - 1)
///     interaction  ε N m f² / (1 - ρ)     ε (k - 1) (m - 1)      ε (N - k) (m - 1)
///     between      N m f² / (1 + (m - 1) ρ)   k - 1              N - k
///
/// Exact with ε = 1, an approximation below it. Undefined as anova_power(), and when the plan is
/// outside its ranges.
Defined<double> repeated_power(const RepeatedPlan& plan, double n, double f);
/// Undefined as anova_sample_size().
Defined<SampleSize> repeated_sample_size(const RepeatedPlan& plan, double f, double power);
/// The smallest effect that is found with this power.
Defined<double> repeated_detectable(const RepeatedPlan& plan, double n, double power);

}  // namespace haptrial::analysis
