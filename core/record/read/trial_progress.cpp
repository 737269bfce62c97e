#include "core/record/read/trial_progress.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>

namespace haptrial::record {

TrialProgress trial_progress(const SessionReader& reader) {
  TrialProgress progress;
  for (const RunRow& run : reader.runs()) {
    if (run.planned >= 0) {
      progress.planned = run.planned;
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
  std::set<std::string> skipped;
  for (const EventRow& event : reader.events()) {
    if (event.kind == "skipped" && event.text.find("practice=1") == std::string::npos) {
      skipped.insert(event.text);
    }
  }
  const auto is_done = [&](int trial) { return done.contains(trial); };
  const auto left = static_cast<int>(begun.size()) -
                    static_cast<int>(std::count_if(begun.begin(), begun.end(), is_done));
  progress.done = static_cast<int>(done.size());
  progress.skipped = static_cast<int>(skipped.size());
  progress.aborted = std::max(left - progress.skipped, 0);
  return progress;
}

}  // namespace haptrial::record
