#pragma once

#include <string>
#include <vector>

#include "analysis/bone_drilling/report/nerve_findings.h"
#include "analysis/document/finding.h"

namespace haptrial::analysis::drilling {

/// Findings of monitors: events by nerve and condition, train time, reactions, and how well the
/// monitor itself did. Without values where nothing was watched.
FindingList nerve_findings(const std::vector<NerveProcedure>& procedures);

/// Lines for the end of the command, without "Simulated".
std::vector<std::string> nerve_lines(const std::vector<NerveProcedure>& procedures);

}  // namespace haptrial::analysis::drilling
