#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "analysis/statistics/design/analysis_plan.h"
#include "analysis/statistics/design/design_table.h"

namespace haptrial::analysis {

/// The decisive test after a number of participants.
struct SequentialLook {
  std::size_t participants{0};
  Defined<double> value{Undefined{"nothing was compared"}};  // Bayes factor, or z
  double bound{0.0};                                         // at which the study ends
};

enum class SequentialVerdict {
  kGoOn,       // the next participant may come
  kEffect,     // the test decided for its alternative
  kNoEffect,   // its Bayes factor decided against its alternative
  kUndecided,  // as many as may come have come
};

/// A sequential study as it stands. Who came after the decision does not change it.
struct SequentialResult {
  PlannedTest test;
  SequentialPlan plan;
  std::size_t most{0};                // participants
  std::vector<SequentialLook> looks;  // up to the decision
  SequentialVerdict verdict{SequentialVerdict::kGoOn};
};

/// Looks at a study as it was after each of its first participants.
/// @param test   of the plan's
/// @param order  participants as they came; those without a value count, and change nothing
/// @param most   participants who may come; of a group-sequential study its last look holds
SequentialResult sequential_result(const DesignTable& table, const PlannedTest& test,
                                   const SequentialPlan& plan, std::span<const std::string> order,
                                   std::size_t most);

/// Sentences on looks that the planned participants do not reach, or that leave some of them out,
/// and on a Bayes factor that ends studies without an effect although there is one.
std::vector<std::string> sequential_warnings(const AnalysisPlan& plan, int participants);

/// "after 14 of at most 40 participants … : go on."
std::string words_of(const SequentialResult& result);

}  // namespace haptrial::analysis
