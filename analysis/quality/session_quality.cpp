#include "analysis/quality/session_quality.h"

#include <algorithm>
#include <limits>

#include "analysis/quality/run_quality.h"
#include "core/record/read/session_facts.h"
#include "core/record/read/session_reader.h"

namespace haptrial::analysis {

SessionQuality::SessionQuality(const record::SessionReader& reader)
    : rate_(reader.info().rate),
      frames_(reader.frames()),
      damping_(record::reduced_damping(reader)) {
  std::stable_sort(frames_.begin(), frames_.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
}

void SessionQuality::add(const record::PassRow& pass, const std::vector<record::Sample>& run) {
  const std::int64_t begin = run.front().time_ns;
  if (last_ != nullptr) {
    last_->next = begin;
  }
  Run& kept = runs_[{pass.trial, pass.phase}];
  kept = {begin, std::numeric_limits<std::int64_t>::max(), run_quality(run, rate_)};
  kept.quality.dropped_frames = dropped_frames(frames_, begin, run.back().time_ns);
  last_ = &kept;
}

/// The row of a pass comes after its run and before the next pass.
RunQuality SessionQuality::with_damping(int trial, const Run& run) const {
  RunQuality quality = run.quality;
  if (!quality.duration) {
    return quality;
  }
  quality.reduced_damping = 0.0;
  for (const record::DampingRow& damping : damping_) {
    if (damping.trial == trial && damping.time_ns >= run.begin && damping.time_ns < run.next) {
      quality.reduced_damping = std::min(1.0, damping.seconds / *quality.duration);
    }
  }
  return quality;
}

TrialQuality SessionQuality::of(const record::PassRow& test) const {
  TrialQuality quality;
  quality.attempt = test.attempt;
  const auto find = [&](record::Phase phase, RunQuality& into) {
    if (const auto run = runs_.find({test.trial, phase}); run != runs_.end()) {
      into = with_damping(test.trial, run->second);
    }
  };
  find(record::Phase::kTest, quality.test);
  find(record::Phase::kTraining, quality.training);
  return quality;
}

}  // namespace haptrial::analysis
