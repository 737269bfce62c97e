#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "analysis/force_training/study/identity.h"
#include "analysis/force_training/study/study_statistics.h"

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

/// Recall error of one condition in two studies; differences are second minus first.
struct ConditionComparison {
  std::string condition;
  Mean first;  // of participants' means
  Mean second;
  std::size_t first_people{0};  // participants with the condition
  std::size_t second_people{0};
  Defined<TTest> welch{Undefined{"there are no participants"}};        // of the means, two-sided
  Defined<double> welch_holm{Undefined{"there are no participants"}};  // adjusted over conditions
  std::size_t shared{0};          // the same participants with the condition in both
  double shared_difference{0.0};  // mean of theirs; 0 without any
  Defined<TTest> paired{Undefined{"there are no participants"}};        // of theirs, two-sided
  Defined<double> paired_holm{Undefined{"there are no participants"}};  // adjusted over conditions
};

/// Participants who are not paired, for one reason.
struct Unpaired {
  std::string reason;
  std::vector<std::string> subjects;
};

/// A parameter of the scores that the two studies do not share.
struct ParameterDifference {
  std::string name;
  std::string first;  // "as published" when the study does not list the parameter
  std::string second;
};

struct StudyComparison {
  ScoredStudy first, second;
  StudyStatistics first_statistics, second_statistics;
  std::vector<ParameterDifference> scoring;  // empty unless allowed to differ
  std::vector<std::string> paired;           // the same participants in both
  std::vector<Unpaired> unpaired;
  std::vector<ConditionComparison> conditions;  // those that both studies have
  std::vector<std::string> remarks;             // sentences on what the studies do not share
};

/// Whether scores that were made with different parameters may be compared.
enum class Scoring { kSame, kMayDiffer };

/// Participants are paired when they are the same ones (identity.h).
/// @throws InputError when the studies have no condition in common, or with Scoring::kSame when
/// their scores were made with different parameters. Curves over time against curves over the path
/// are no such difference: that is what such a comparison is about.
StudyComparison compare_studies(ScoredStudy first, ScoredStudy second,
                                Scoring scoring = Scoring::kSame);

/// The same in words, in JSON and as one HTML page with its figure.
std::vector<std::string> comparison_lines(const StudyComparison& comparison);
std::string comparison_json(const StudyComparison& comparison);

/// Warnings that a reader must know before any number: scoring that differs, simulated
/// participants.
std::vector<std::string> comparison_alarms(const StudyComparison& comparison);

/// Writes comparison.json, comparison.html and the figure into a folder that exists, over what is
/// there. @throws RunError when that fails.
void write_comparison(const StudyComparison& comparison, const std::filesystem::path& folder);

}  // namespace haptrial::analysis
