#include "experiments/runner/next_trial.h"

#include "experiments/runner/earlier_run.h"

namespace haptrial::experiments {

using protocols::Outcome;
using protocols::PlannedTrial;
using protocols::TrialEnd;

std::optional<PlannedTrial> NextTrial::after(const Outcome* last) {
  const record::Resumed& earlier = p_.record.earlier();
  std::optional<PlannedTrial> trial = p_.trials.next(last);
  std::optional<PlannedTrial> done;  // by an earlier run, last of what is passed over here
  const auto pages_after = [&](const PlannedTrial& over) {
    ended_at_page_ = !p_.pages.after_block(over.block, over.block_name, true);
    return !ended_at_page_;
  };
  while (trial) {
    const int most = p_.request.max_trials;
    if (most > 0 && !trial->practice && trial->trial > most) {
      if (done && done->block == trial->block) {
        pages_after(*done);  // nothing further of its block comes
      }
      return std::nullopt;
    }
    const auto before = outcome_of(earlier, *trial, p_.trials.phases().back());
    const bool aborted = before && before->end == TrialEnd::kAborted;
    // Where later trials follow from its answer, only the last one comes again.
    const bool again = p_.trials.presents_aborted_again() ? aborted || is_damaged(earlier, *trial)
                                                          : aborted && ended_with(earlier, *trial);
    if (!before || again) {
      return trial;
    }
    trial = p_.trials.next(&*before);
    done = before->trial;
    const bool block_over = !trial || trial->block != done->block;
    if (block_over && !pages_after(*done)) {
      return std::nullopt;
    }
  }
  return trial;
}

}  // namespace haptrial::experiments
