#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "analysis/force_training/study/recall_frequency.h"
#include "analysis/force_training/study/study_statistics.h"
#include "analysis/learning/learned_study.h"
#include "analysis/quality/timing.h"
#include "analysis/quality/tracking.h"
#include "core/record/rows/session_types.h"

namespace haptrial::analysis {

struct StudyResult;

/// The lines that matter, with participants as the unit: the mean recall error of each condition,
/// whether conditions differ, and the planned tests.
std::vector<std::string> summary_lines(const StudyResult& study);

/// A test pass that has no score, and why.
struct Exclusion {
  std::string subject;
  std::int32_t trial{0};
  std::string reason;
};

/// Facts of one session file besides its scores.
struct SessionSummary {
  std::string file;  // name without its folder
  record::SessionInfo info;
  std::size_t test_passes{0};  // in the file, scored or not
  std::size_t scored{0};
  TrackingSummary tracking;  // over all completed passes, training and test
  LoopTiming timing;
};

/// A session of each participant, as the definition plans it.
struct SessionOfStudy {
  std::string name;
  bool trains{true};  // else it tests alone
};

/// Everything that analysing the session files of a study gave.
struct StudyResult {
  std::vector<SessionSummary> sessions;            // by subject
  std::vector<TrialScore> scores;                  // by subject, then session and trial
  std::vector<TrialScore> tests{};                 // likewise, of sessions without training
  std::vector<SessionOfStudy> planned_sessions{};  // none: each participant has one
  std::map<std::string, std::string> groups{};     // by subject, if there are several sessions
  LearnedStudy learned{};                          // without outcomes: nobody asks for changes
  std::vector<std::string> factors{"condition"};   // names; each score has a level of each
  std::vector<Exclusion> exclusions;               // by subject, then trial
  StudyStatistics statistics;
  /// The same tests of path_error [mm], where the path was recalled, too.
  std::optional<StudyStatistics> path{};
  Defined<std::vector<RecallBand>> frequencies{std::vector<RecallBand>{}};  // rising
  TrackingSummary tracking;                                                 // over all participants
  std::vector<RecallPicture> recalls;                                       // best, median, worst
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

}  // namespace haptrial::analysis
