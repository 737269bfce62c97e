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

/// Whether the run ended with this trial.
bool ended_with(const record::Resumed& before, const PlannedTrial& trial) {
  return !before.passes.empty() && protocols::is_of(before.passes.back(), trial);
}

}  // namespace

std::optional<protocols::Outcome> outcome_of(const record::Resumed& before,
                                             const PlannedTrial& trial, const record::Phase& last) {
  return protocols::recorded_outcome(
      {before.passes, before.responses, before.skipped, before.taken_back}, trial, last);
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

using protocols::Outcome;
using protocols::TrialEnd;

std::optional<PlannedTrial> NextTrial::after(const Outcome* last) {
  const record::Resumed& earlier = p_.record.earlier();
  std::optional<PlannedTrial> trial = p_.trials.next(last);
  while (trial) {
    const int most = p_.request.max_trials;
    if (most > 0 && !trial->practice && trial->trial > most) {
      return std::nullopt;
    }
    const auto before = outcome_of(earlier, *trial, p_.trials.phases().back());
    const bool again = before && before->end == TrialEnd::kAborted &&
                       (p_.trials.presents_aborted_again() || ended_with(earlier, *trial));
    if (!before || again) {
      return trial;
    }
    trial = p_.trials.next(&*before);
    const PlannedTrial& over = before->trial;
    const bool block_over = !trial || trial->block != over.block;
    if (block_over && !p_.pages.after_block(over.block, over.block_name, true)) {
      ended_at_page_ = true;
      return std::nullopt;
    }
  }
  return trial;
}

}  // namespace haptrial::experiments
