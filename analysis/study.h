#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "analysis/study_statistics.h"
#include "analysis/timing.h"
#include "analysis/tracking.h"
#include "analysis/trial_score.h"
#include "core/record/session_types.h"

namespace haptrial::analysis {

struct ScoreParameters;

/// A test pass that has no score, and why.
struct Exclusion {
  std::string subject;
  std::int32_t trial{0};
  std::string reason;
};

/// What one session file holds besides its scores.
struct SessionSummary {
  std::string file;  // name without its folder
  record::SessionInfo info;
  std::size_t test_passes{0};  // in the file, scored or not
  std::size_t scored{0};
  TrackingSummary tracking;  // over all completed passes, training and test
  LoopTiming timing;
};

/// How one recall was aligned with its target, on the common time base.
/// Source: Morris 2006, §4.3, Figures 26 and 27.
struct RecallPicture {
  std::string which;  // "best", "median" or "worst" of the study
  TrialScore score;
  double duration{0.0};                                      // of the pass [s]
  std::vector<double> target{};                              // (base) [N]
  std::vector<double> applied{};                             // (base) filtered [N]
  std::vector<double> warped{};                              // (base) applied after alignment [N]
  std::vector<std::pair<std::size_t, std::size_t>> pairs{};  // (path) target index, applied index
};

/// Everything that analysing the session files of a study gave.
struct StudyResult {
  std::vector<SessionSummary> sessions;           // by subject
  std::vector<TrialScore> scores;                 // by subject, then trial
  std::vector<std::string> factors{"condition"};  // names; each score has a level of each
  std::vector<Exclusion> exclusions;              // by subject, then trial
  StudyStatistics statistics;
  TrackingSummary tracking;                                     // over all participants
  std::vector<RecallPicture> recalls;                           // best, median, worst
  std::vector<record::StimulusRow> stimulus;                    // first block of the first session
  std::vector<std::pair<std::string, std::string>> parameters;  // of the scores: name, value
  std::vector<std::string> remarks;  // sentences for the report: what is missing from the study
  std::vector<std::string> alarms;   // likewise, which nobody may overlook: flagged trials
  bool over_path{false};  // curves are over the place on the path, at the participants' own pace

  /// The table of a study of curves that something else recorded, of which nothing but the forces
  /// is known: no tracking, timing, device or stimulus. Empty for session files.
  std::string curves_from{};

  /// True when any participant is a virtual subject: then every output says so.
  bool simulated() const;
};

/// Reads session files, scores every completed test pass and analyses the scores.
/// One thread works on one file at a time, up to `jobs`; only the pictured curves stay in memory.
/// The result does not depend on `jobs` nor on the order of the files.
/// @throws InputError when there is no file, a file cannot be read, or two files share a subject.
/// Source: Morris 2006, §4.3 and §4.4.
/// @param plan  the tests that were planned
StudyResult analyze_study(const std::vector<std::filesystem::path>& session_files,
                          const ScoreParameters& parameters, int jobs,
                          const AnalysisPlan& plan = {});

/// The lines that matter, with participants as the unit: the mean recall error of each condition,
/// whether conditions differ, and the planned tests.
std::vector<std::string> summary_lines(const StudyResult& study);

}  // namespace haptrial::analysis
