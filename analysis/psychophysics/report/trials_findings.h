#pragma once

#include <string>

#include "analysis/document/finding.h"
#include "analysis/psychophysics/study/trials_result.h"

namespace haptrial::analysis::trials {

/// Findings of each participant or condition: a row each, in the report, results.json and
/// estimates.csv.
FindingTable participant_findings(const TrialsResult& result);
FindingTable function_findings(const TrialsResult& result);
FindingTable serial_findings(const TrialsResult& result);
FindingTable track_findings(const TrialsResult& result);
FindingTable detection_findings(const TrialsResult& result);
FindingTable identification_findings(const TrialsResult& result);
FindingTable law_findings(const TrialsResult& result);
FindingTable exponent_findings(const TrialsResult& result);  // JSON has them with their law
FindingTable contrast_findings(const ReachingResult& reaching);
FindingTable reach_quality_findings(const ReachingResult& reaching);
/// @param result  with cues, among them `level`
FindingTable cue_findings(const TrialsResult& result, const CueLevel& level);

/// A tidy table with a row for each estimate: participant, the plan's factors, track, source
/// (likelihood, posterior of adaptive trials, bayesian, cues, procedure, detection, identification,
/// magnitude, hierarchical), name, estimate, low, high (95 %), unit. What is not known is empty; what is not
/// defined has no row.
std::string estimates_csv(const TrialsResult& result);

}  // namespace haptrial::analysis::trials
