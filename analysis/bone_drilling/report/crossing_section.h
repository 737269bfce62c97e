#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/bone_drilling/report/with_without.h"
#include "analysis/document/finding.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::analysis::drilling {

/// Ways through the forbidden region of one structure in a procedure.
struct Crossings {
  std::string structure;
  int count{0};
  double time{0.0};     // in the region [s]
  double deepest{0.0};  // of the burr's surface in the margin [m]
};

/// One procedure of a session with forbidden regions; crossings are recorded in all of them.
struct CrossingProcedure : GivenProcedure {
  std::vector<Crossings> structures;  // by label; those that were crossed

  int count() const;
};

/// The procedures of a session in the order of trials; none where no region is forbidden.
/// @param summaries  of the session's procedures @throws InputError where the file is damaged
std::vector<CrossingProcedure> load_crossings(const record::SessionReader& file,
                                              std::span<const ProcedureSummary> summaries);

/// A row for each procedure and structure that was crossed, and one for a procedure without any.
std::string crossings_csv(std::span<const CrossingProcedure> procedures);

/// Crossings by condition, and what the regions changed, participants being their own controls.
/// Without values where no region is forbidden.
FindingList crossing_findings(std::span<const CrossingProcedure> procedures);

/// Lines for the end of the command, without "Simulated".
std::vector<std::string> crossing_lines(std::span<const CrossingProcedure> procedures);

}  // namespace haptrial::analysis::drilling
