#pragma once

#include <string>
#include <vector>

#include "analysis/bone_drilling/report/nerve_findings.h"
#include "analysis/document/document.h"

namespace haptrial::analysis::drilling {

/// Adds the findings of monitors to a report: events by nerve and condition, train time, reactions,
/// and how well the monitor itself did. Nothing where nothing was watched.
/// @param simulated  the participants are programs
void add_nerve_section(Document& document, const std::vector<NerveProcedure>& procedures,
                       bool simulated);

/// Lines for the end of the command, without "Simulated".
std::vector<std::string> nerve_lines(const std::vector<NerveProcedure>& procedures);

}  // namespace haptrial::analysis::drilling
