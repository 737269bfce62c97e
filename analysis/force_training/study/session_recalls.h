#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "analysis/force_training/score/path_places.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/study/recall_frequency.h"
#include "analysis/force_training/study/study_result.h"
#include "analysis/statistics/base/defined.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::analysis {

/// One scored test pass and where it stands in its file.
struct ScoredPass {
  TrialScore score;
  std::size_t pass{0};  // row of /trials
  RecallSpectrum spectrum{};
};

/// Recalls of one session file for a study.
struct SessionRecalls {
  SessionSummary summary;
  std::vector<ScoredPass> scored;             // by trial
  std::vector<Exclusion> exclusions;          // by trial
  std::vector<PassTracking> tracking;         // completed passes of blocks with a stimulus
  std::vector<record::StimulusRow> stimulus;  // of the first block
};

/// Reads one session file pass by pass and scores its completed test passes.
/// Of several completed test passes of one trial the last counts; a test after a training pass that
/// was only ever aborted does not.
/// @throws InputError when the file cannot be read or its parts contradict each other.
SessionRecalls session_recalls(const record::SessionReader& reader,
                               const ScoreParameters& parameters, int jobs);

/// The two curves of a test pass.
struct RecallCurves {
  ForceCurve target;
  ForceCurve applied;
};

/// The curves while the trajectory runs, or why the pass cannot be scored.
/// @param places  of the pass's block: then the curves are over the place on the path; else null,
///   and they are over time.
Defined<RecallCurves> recall_curves(const std::vector<record::Sample>& run, double rate,
                                    const PathPlaces* places);

/// Places on the block's ideal path; nothing if the parameters ask for curves over time.
/// @throws InputError when the file lacks the path.
std::unique_ptr<PathPlaces> path_places(const record::SessionReader& reader, std::int32_t block,
                                        const ScoreParameters& parameters);

/// Samples of the pass during Stage::kRun, or why there are none to use.
Defined<std::vector<record::Sample>> run_samples(const record::SessionReader& reader,
                                                 const record::PassRow& pass);

}  // namespace haptrial::analysis
