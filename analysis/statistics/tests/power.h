#pragma once

#include "analysis/statistics/base/defined.h"
#include "analysis/statistics/tests/sample_size.h"

namespace haptrial::analysis {

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

}  // namespace haptrial::analysis
