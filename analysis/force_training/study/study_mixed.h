#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/force_training/score/trial_score.h"
#include "analysis/statistics/relation/mixed_contrast.h"
#include "analysis/statistics/relation/mixed_model.h"

namespace haptrial::analysis {

/// One random intercept of a study's mixed model.
struct StudyTerm {
  std::string words;  // "participant", "condition within participant", "block within participant"
  std::string notation;  // lme4's: "(1 | subject:condition)"
  std::size_t groups{0};
};

/// Two conditions, other trials and participants as they are.
struct MixedPair {
  std::string a;
  std::string b;
  Defined<Coefficient> difference{Undefined{"nothing was compared"}};  // a - b
  Defined<double> holm{Undefined{"nothing was compared"}};  // its p, adjusted over all pairs
};

/// Recall error by condition, from single trials, with the random intercepts that the design has.
struct StudyMixed {
  std::vector<std::string> conditions;  // the reference first
  std::vector<StudyTerm> terms;         // as in model->variances
  std::vector<std::string> left_out;    // sentences: which terms the design does not have, and why
  std::string formula;                  // lme4's: "score ~ condition + (1 | subject)"
  /// The intercept is the mean of the reference; the other coefficients are differences from it.
  Defined<MixedModel> model{Undefined{"there are no trials"}};
  Defined<JointTest> omnibus{Undefined{"there are no trials"}};  // all conditions are equal
  std::vector<MixedPair> pairs;  // every two conditions, in the order of `conditions`
};

/// Random terms: participant, if a participant has several trials; condition within participant, if
/// participants had several conditions with several blocks or trials each; block within
/// participant, if blocks hold several trials. A block is known by subject and block together. Of
/// terms that group the trials alike the first is kept.
/// @param conditions  in the order of the report. @param reference  one of them, or the first.
/// Undefined with fewer than two conditions, one without trials, no random term (each participant
/// has one trial), or if mixed_model() is undefined.
/// @throws std::invalid_argument when a trial or the reference has a condition that is not listed.
StudyMixed study_mixed(std::span<const TrialScore> scores,
                       const std::vector<std::string>& conditions,
                       const std::string& reference = "");

}  // namespace haptrial::analysis
