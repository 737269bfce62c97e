#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "analysis/quality/trial_quality.h"
#include "analysis/statistics/base/defined.h"
#include "core/record/read/session_reader_forward.h"
#include "core/record/rows/session_types.h"
#include "core/record/rows/trial_facts.h"

namespace haptrial::analysis {

/// Gathers the quality of a session's trials while its passes are read one by one. One thread.
class SessionQuality {
 public:
  /// @param reader  outlives it. @throws InputError where events or frames are damaged.
  explicit SessionQuality(const record::SessionReader& reader);

  /// A completed pass; of a trial's passes of one phase the last counts.
  /// @param run  its samples of Stage::kRun, in order
  void add(const record::PassRow& pass, const std::vector<record::Sample>& run);

  /// @param test  the pass that is scored; was added, unless its run could not be read
  TrialQuality of(const record::PassRow& test) const;

 private:
  struct Run {
    std::int64_t begin{0};  // [ns]
    std::int64_t next{0};   // begin of the run after it
    RunQuality quality;
  };
  RunQuality with_damping(int trial, const Run& run) const;

  double rate_;
  std::vector<record::FrameRow> frames_;
  std::vector<record::DampingRow> damping_;
  std::map<std::pair<std::int32_t, record::Phase>, Run> runs_;  // by trial
  Run* last_{nullptr};
};

}  // namespace haptrial::analysis
