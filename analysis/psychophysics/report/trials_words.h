#pragma once

#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Words with which a report of a study with simulated participants marks each result.
extern const char* const kSimulatedTrials;

inline constexpr double kMillimetres = 1000.0;  // in a metre

/// "338.2 [330.1, 349.0]", "338.2 [330.1, open]" if the answers do not tell how far it goes,
/// "338.2" without an interval, or "–".
std::string estimate_word(const Estimated& e);
/// A procedure's own estimate with its interval.
Estimated estimated(const psychometric::Estimate& e);
/// "75 %".
std::string percent(double share);
/// "P07", or "P07, visual".
std::string series_name(const std::string& participant, const std::string& condition);
/// How a function was fitted: "likelihood", or "posterior" of adaptive trials.
const char* method_of(const FunctionFit& fit);
/// The mean of a condition over participants with its interval. Thresholds, whose values are on the
/// axis, are given as levels.
std::string mean_word(const TrialsResult& result, const Quantity& q, std::size_t cell);
/// The unit in which mean_word() is: " N/m", or empty.
std::string unit_word(const TrialsResult& result, const Quantity& q);

/// "threshold", or "threshold, in log10(N/m)" where its tests are in another unit than its means.
std::string tested_title(const TrialsResult& result, const Quantity& q);

/// The results in a few lines, for the command and the head of the report.
std::vector<std::string> summary_lines(const TrialsResult& result);
/// Sentences on ticks on which bodies that give way were not felt as they should be.
std::vector<std::string> body_lines(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
