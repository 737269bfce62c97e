#pragma once

#include <span>
#include <string>
#include <vector>

#include "analysis/document/document.h"
#include "analysis/learning/learning_plan.h"
#include "analysis/statistics/base/descriptive.h"
#include "analysis/statistics/design/design_table.h"
#include "analysis/statistics/design/design_tests.h"

namespace haptrial::analysis {

/// An outcome of a learning plan with its values in all sessions.
struct LearningQuantity {
  std::string name;                 // as the plan has it
  std::string title;                // "planned cavity removed"
  std::string unit;                 // "1": a pure number
  std::vector<Observation> values;  // of trials; levels: group, session
};

/// A quantity over the sessions of a study, participants as the unit.
struct LearnedOutcome {
  std::string name;
  std::string title;
  std::string unit;
  std::vector<std::string> groups;    // that have values, in the definition's order
  std::vector<std::string> sessions;  // likewise, tests and trainings
  /// (groups x sessions) over participants' means; undefined where nobody came.
  std::vector<std::vector<Mean>> means;
  DesignTable changes;  // from the baseline, by "group" and "change" up to a test
  DesignTests tests;    // of them
};

/// The changes that a study found; without outcomes, the definition asks for none.
struct LearnedStudy {
  LearningPlan plan;
  std::vector<LearnedOutcome> outcomes;  // (plan.outcomes)
};

/// @param quantities  (plan.outcomes)  @param names  of the study, in their order
/// @throws InputError for planned tests that name several things at once
LearnedStudy learned_study(std::span<const LearningQuantity> quantities, const LearningPlan& plan,
                           const LearningNames& names);

/// The mean change of a group from the baseline to a test.
Mean mean_change(const LearnedOutcome& outcome, const std::string& group, const std::string& test);

/// A figure of each outcome over the sessions, by group.
std::vector<Figure> learning_figures(const LearnedStudy& study, bool simulated);

/// Learning in a report; nothing without outcomes. @param drawings  with those of
/// learning_figures()
void add_learning_section(Document& document, const LearnedStudy& study,
                          const std::vector<Drawing>& drawings, bool simulated);

/// Lines for the end of the command, without "Simulated": effects and planned tests of the outcome
/// that decides.
std::vector<std::string> learning_lines(const LearnedStudy& study);

}  // namespace haptrial::analysis
