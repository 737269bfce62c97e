#pragma once

#include <optional>
#include <span>

#include "core/record/rows/response.h"
#include "core/record/rows/session_types.h"
#include "core/record/rows/taken_back_row.h"
#include "core/record/rows/trial_facts.h"
#include "protocols/interface/trials.h"

namespace haptrial::protocols {

/// A session file's records of its trials.
struct RecordedTrials {
  std::span<const record::PassRow> passes;
  std::span<const record::ResponseRow> responses;
  std::span<const record::SkippedRow> skipped;
  std::span<const record::TakenBackRow> taken_back;  // passes that are as if they had not been
};

/// Whether a pass is one of the trial.
bool is_of(const record::PassRow& pass, const PlannedTrial& trial);

/// Outcome of a trial that an earlier run, or the session that is replayed, presented; nothing if
/// it did not. The responses are those of the attempt that counts.
/// @param last  the phase with which a trial is done
std::optional<Outcome> recorded_outcome(const RecordedTrials& recorded, const PlannedTrial& trial,
                                        const record::Phase& last);

}  // namespace haptrial::protocols
