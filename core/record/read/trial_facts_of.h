#pragma once

#include <vector>

#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::record {

/// The trials that were skipped for good, each once; in files of versions before 5 the events said
/// so.
std::vector<SkippedRow> skipped_trials(const SessionReader& reader);
/// The passes with reduced damping; in files of versions before 5 the events said so.
std::vector<DampingRow> reduced_damping(const SessionReader& reader);

}  // namespace haptrial::record
