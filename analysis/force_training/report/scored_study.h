#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "analysis/force_training/study/identity.h"

namespace haptrial::analysis {

/// Results of a study that haptrial analyze has written: scores.csv and statistics.json of its
/// folder.
struct ScoredStudy {
  std::string name;      // of its definition, or of the table of imported curves
  bool own_pace{false};  // the participants set the pace, and forces were compared over the path
  std::map<std::string, std::string> parameters;  // of the scores, without that of the pace
  std::vector<Identity> people;
  std::vector<TrialScore> scores;

  /// True when any participant is a virtual subject.
  bool simulated() const;
};

/// @throws InputError when the folder lacks one of the two files, or one is not what analyze
/// writes.
ScoredStudy read_scored_study(const std::filesystem::path& folder);

}  // namespace haptrial::analysis
