#include "protocols/interface/replay.h"

#include <algorithm>
#include <utility>

namespace haptrial::protocols {

bool is_of(const record::PassRow& pass, const PlannedTrial& trial) {
  return pass.trial == trial.trial && pass.practice == trial.practice &&
         pass.condition == trial.condition;
}

namespace {

/// Whether a pass that has lost samples since was completed, and other trials followed from it.
bool counted_when_recorded(std::span<const record::PassRow> passes, std::size_t i) {
  const auto later = passes.subspan(i + 1);
  return passes[i].status == record::PassStatus::kDamaged &&
         std::ranges::any_of(later, [&](const record::PassRow& pass) {
           return pass.trial != passes[i].trial || pass.practice != passes[i].practice;
         });
}

}  // namespace

std::optional<Outcome> recorded_outcome(const RecordedTrials& recorded, const PlannedTrial& trial,
                                        const record::Phase& last) {
  std::optional<Outcome> found;
  const bool skipped = std::ranges::any_of(recorded.skipped, [&](const record::SkippedRow& row) {
    return row.trial == trial.trial && row.practice == trial.practice;
  });
  if (skipped) {
    found = {trial, TrialEnd::kSkipped, {}};
  }
  for (std::size_t i = 0; i < recorded.passes.size(); ++i) {
    const record::PassRow& pass = recorded.passes[i];
    const bool taken_back = std::ranges::any_of(
        recorded.taken_back, [i](const auto& row) { return std::cmp_equal(row.pass, i); });
    const bool done = pass.phase == last && (pass.status == record::PassStatus::kCompleted ||
                                             counted_when_recorded(recorded.passes, i));
    const bool counts =
        !found || found->end == TrialEnd::kAborted || (found->end == TrialEnd::kSkipped && done);
    if (taken_back || !is_of(pass, trial) || !counts) {
      continue;
    }
    found = {trial, done ? TrialEnd::kCompleted : TrialEnd::kAborted, {}};
    for (const record::ResponseRow& response : recorded.responses) {
      const record::PassRow& of = recorded.passes[static_cast<std::size_t>(response.pass)];
      if (is_of(of, trial) && of.attempt == pass.attempt) {
        found->responses.push_back(response);
      }
    }
  }
  return found;
}

}  // namespace haptrial::protocols
