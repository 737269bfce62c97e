#pragma once

#include <cstdint>
#include <optional>

#include "core/record/recovery/session_resume.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {

/// Records of an earlier run of a session, asked trial by trial; a new session has none.

/// Outcome of a trial: its last pass was completed, it was skipped, or every attempt was aborted;
/// nothing if it has none. @param last  phase of a trial
std::optional<protocols::Outcome> outcome_of(const record::Resumed& before,
                                             const protocols::PlannedTrial& trial,
                                             const record::Phase& last);

/// Whether the trial's last pass lost samples.
bool is_damaged(const record::Resumed& before, const protocols::PlannedTrial& trial);

/// Whether the run ended with this trial.
bool ended_with(const record::Resumed& before, const protocols::PlannedTrial& trial);

/// Whether the run ended during the trial without time to write what it held.
bool cut_short(const record::Resumed& before, const protocols::PlannedTrial& trial);

/// Trials of the study that the run has come to the end of. @param last  phase of a trial
int finished_trials(const record::Resumed& before, const record::Phase& last);

/// 0 where the trial has none.
int attempts_of(const record::Resumed& before, const protocols::PlannedTrial& trial);

/// The time of the youngest record [ns]: events may be younger than the last ticks that reached
/// the file.
std::int64_t last_time(const record::Resumed& before);

}  // namespace haptrial::experiments
