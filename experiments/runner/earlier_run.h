#pragma once

#include <cstdint>
#include <optional>

#include "core/record/recovery/session_resume.h"
#include "experiments/runner/session.h"
#include "experiments/runner/session_pages.h"
#include "experiments/runner/session_record.h"
#include "protocols/interface/trials.h"

namespace haptrial::experiments {

/// Records of an earlier run of a session, asked trial by trial; a new session has none.

/// Outcome of a trial: its last pass was completed, it was skipped, or every attempt was aborted;
/// nothing if it has none. @param last  phase of a trial
std::optional<protocols::Outcome> outcome_of(const record::Resumed& before,
                                             const protocols::PlannedTrial& trial,
                                             const record::Phase& last);

/// Whether the run ended during the trial without time to write what it held.
bool cut_short(const record::Resumed& before, const protocols::PlannedTrial& trial);

/// Trials of the study that the run has come to the end of. @param last  phase of a trial
int finished_trials(const record::Resumed& before, const record::Phase& last);

/// 0 where the trial has none.
int attempts_of(const record::Resumed& before, const protocols::PlannedTrial& trial);

/// The time of the youngest record [ns]: events may be younger than the last ticks that reached
/// the file.
std::int64_t last_time(const record::Resumed& before);

/// Which trial a session is to present next: the procedure's, without those that an earlier run
/// recorded. Session's thread.
class NextTrial {
 public:
  /// All of them outlive it.
  struct Parts {
    const SessionRequest& request;
    protocols::Trials& trials;
    const SessionRecord& record;
    SessionPages& pages;
  };
  explicit NextTrial(const Parts& parts) : p_(parts) {}

  /// The next trial that is not recorded. The outcome of a recorded one goes into the same
  /// procedure, which leads to the same trials. Pages that the earlier run left unanswered are
  /// asked on the way.
  /// @param last  what came of the trial before; null at first
  /// @returns nothing at the end of the session, and where it was ended at a page
  std::optional<protocols::PlannedTrial> after(const protocols::Outcome* last);
  bool ended_at_page() const { return ended_at_page_; }

 private:
  Parts p_;
  bool ended_at_page_{false};
};

}  // namespace haptrial::experiments
