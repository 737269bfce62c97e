#include "experiments/runner/earlier_run.h"

#include <algorithm>
#include <set>

#include "protocols/interface/replay.h"

namespace haptrial::experiments {

using protocols::PlannedTrial;

namespace {

bool was_skipped(const record::Resumed& before, const record::PassRow& pass) {
  return std::ranges::any_of(before.skipped, [&](const record::SkippedRow& row) {
    return row.trial == pass.trial && row.practice == pass.practice;
  });
}

}  // namespace

std::optional<protocols::Outcome> outcome_of(const record::Resumed& before,
                                             const PlannedTrial& trial, const record::Phase& last) {
  return protocols::recorded_outcome(
      {before.passes, before.responses, before.skipped, before.taken_back}, trial, last);
}

bool is_damaged(const record::Resumed& before, const PlannedTrial& trial) {
  const auto of = [&](const record::PassRow& pass) { return protocols::is_of(pass, trial); };
  const auto last = std::find_if(before.passes.rbegin(), before.passes.rend(), of);
  return last != before.passes.rend() && last->status == record::PassStatus::kDamaged;
}

bool ended_with(const record::Resumed& before, const PlannedTrial& trial) {
  return !before.passes.empty() && protocols::is_of(before.passes.back(), trial);
}

bool cut_short(const record::Resumed& before, const PlannedTrial& trial) {
  return !before.open_passes.empty() && before.passes.back().trial == trial.trial;
}

int finished_trials(const record::Resumed& before, const record::Phase& last) {
  std::set<std::int32_t> trials;
  for (const record::PassRow& pass : before.passes) {
    const bool done = pass.phase == last && pass.status == record::PassStatus::kCompleted;
    if (!pass.practice && (done || was_skipped(before, pass))) {
      trials.insert(pass.trial);
    }
  }
  return static_cast<int>(trials.size());
}

int attempts_of(const record::Resumed& before, const PlannedTrial& trial) {
  int most = 0;
  for (const record::PassRow& pass : before.passes) {
    most = protocols::is_of(pass, trial) ? std::max(most, static_cast<int>(pass.attempt)) : most;
  }
  return most;
}

std::int64_t last_time(const record::Resumed& before) {
  std::int64_t last = before.last_time_ns;
  for (const record::EventRow& event : before.events) {
    last = std::max(last, event.time_ns);
  }
  return last;
}

}  // namespace haptrial::experiments
