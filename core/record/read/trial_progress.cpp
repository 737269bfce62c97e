#include "core/record/read/trial_progress.h"

#include <algorithm>
#include <iterator>
#include <set>

#include "core/record/read/trial_facts_of.h"

namespace haptrial::record {

TrialProgress trial_progress(const SessionReader& reader) {
  TrialProgress progress;
  for (const RunRow& run : reader.runs()) {
    if (run.planned >= 0) {
      progress.planned = run.planned;
    }
  }
  for (const EventRow& event : reader.events()) {
    if (event.kind == kEndedForGood || event.kind == kGivenUp) {
      progress.ended_early = event.text;
    }
  }
  std::set<int> begun, done;
  for (const PassRow& pass : reader.passes()) {
    if (pass.practice || pass.trial < 1) {
      continue;
    }
    begun.insert(pass.trial);
    // A training pass is followed by the test pass of its trial.
    if (pass.phase != Phase::kTraining && pass.status == PassStatus::kCompleted) {
      done.insert(pass.trial);
    }
  }
  const std::vector<SkippedRow> skipped = skipped_trials(reader);
  const auto is_done = [&](int trial) { return done.contains(trial); };
  const auto left = static_cast<int>(begun.size()) -
                    static_cast<int>(std::count_if(begun.begin(), begun.end(), is_done));
  progress.done = static_cast<int>(done.size());
  progress.skipped = static_cast<int>(std::ranges::count(skipped, false, &SkippedRow::practice));
  progress.aborted = std::max(left - progress.skipped, 0);
  return progress;
}

}  // namespace haptrial::record
