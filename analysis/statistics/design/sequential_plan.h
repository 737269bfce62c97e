#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/tests/spending_bounds.h"
#include "core/base/definition/schema_forward.h"

namespace haptrial::analysis {

/// Why a study may end before its last participant.
enum class StopRule {
  /// The Bayes factor of the effect reaches 1 / error. Looked at after every participant: without
  /// an effect it gets there at some time with at most this probability, however many come, as it
  /// is a likelihood ratio of what does not depend on the unknown scale (Ville 1939; Hendriksen,
  /// de Heide and Grünwald 2021, Bayesian Analysis 16).
  kBayesFactor,
  /// The test's z reaches a bound of spending_bounds() at one of the stated looks.
  kGroupSequential,
};

/// The experimenter's decision on when a study ends.
struct SequentialPlan {
  std::string test;  // as in AnalysisPlan::tests; empty: the first
  std::string of;    // the quantity that is tested, as in results.json; empty: the first
  StopRule rule{StopRule::kBayesFactor};
  double error{0.05};
  double none{0.0};  // Bayes factor against an effect at which it ends, too; 0: it does not
  int fewest{8};     // participants before the first look at the Bayes factor
  std::vector<double> looks;  // participants, ascending whole numbers
  Spending spending{Spending::kOBrienFleming};
};

/// The keys of [analysis.sequential].
const Schema<SequentialPlan>& sequential_schema();

}  // namespace haptrial::analysis
