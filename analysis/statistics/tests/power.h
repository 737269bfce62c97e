#pragma once

#include "analysis/statistics/base/defined.h"

namespace haptrial::analysis {

/// A number of participants.
struct SampleSize {
  double exact{0.0};  // where the power is met, between whole numbers
  long n{0};          // the next whole number; at least the smallest that can be tested
  double power{0.0};  // with n
};

/// A t-test that is planned. Of two samples `n` is the size of the first; of pairs their number,
/// and `delta` is the mean difference by the standard deviation of the differences.
enum class TDesign { kOneSample, kTwoSample, kPaired };

struct TPlan {
  TDesign design{TDesign::kTwoSample};
  double alpha{0.05};
  bool one_tailed{false};  // else both tails count, also the one against the effect
  double ratio{1.0};       // size of the second of two samples by that of the first; > 0
};

/// A one-way analysis of variance that is planned: `n` is the size of each group, f the standard
/// deviation of the groups' means by that within groups (Cohen 1988).
struct AnovaPlan {
  int groups{3};
  double alpha{0.05};
};

/// The chance of a significant result, from the noncentral t and F.
/// Undefined when n leaves no degrees of freedom, or a number is outside its range.
Defined<double> t_power(const TPlan& plan, double n, double delta);
Defined<double> anova_power(const AnovaPlan& plan, double n, double f);

/// Undefined when there is no effect, the power is not between alpha and 1, or more than ten
/// million participants would not do.
Defined<SampleSize> t_sample_size(const TPlan& plan, double delta, double power);
Defined<SampleSize> anova_sample_size(const AnovaPlan& plan, double f, double power);

/// The smallest effect that is found with this power.
Defined<double> t_detectable(const TPlan& plan, double n, double power);
Defined<double> anova_detectable(const AnovaPlan& plan, double n, double power);

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
