#pragma once

#include <string>
#include <vector>

#include "analysis/force_training/score/score_parameters.h"
#include "analysis/learning/learning_plan.h"
#include "analysis/statistics/design/analysis_plan.h"
#include "core/base/definition/schema_forward.h"

namespace haptrial::protocols {
struct Definition;
}

namespace haptrial::protocols {
struct Definition;
}

namespace haptrial::experiments {

/// Analysis of curves of force in a definition: its table [analysis].
struct CurveAnalysis {
  analysis::ScoreParameters scoring;
  analysis::AnalysisPlan plan;        // between conditions, right after training
  analysis::LearningPlan learning{};  // from session to session; its tests are the planned ones
};

/// @param definition  whose table it is; null if it cannot be read
/// @param fresh       about to be used: a score that cannot depend on the forces is a problem
CurveAnalysis read_curve_analysis(Table& root, const protocols::Definition* definition, bool fresh);
/// Reads the table of a definition that has been read before. @throws InputError with problems in
/// it
CurveAnalysis curve_analysis_of(const protocols::Definition& definition);

/// The definition's plan, unless an analysis was given another; then `remarks` say so.
/// @throws InputError for a test that cannot be read
analysis::AnalysisPlan plan_for(const std::vector<std::string>& planned,
                                const std::string& reference, analysis::AnalysisPlan plan,
                                std::vector<std::string>& remarks);
/// The plan that the options --planned and --reference state. @throws InputError as above
analysis::AnalysisPlan plan_of(const std::vector<std::string>& planned,
                               const std::string& reference);

/// Sentences on scores that do not mean what they seem to.
std::vector<std::string> warnings_of(const analysis::ScoreParameters& scoring);

/// Groups and sessions of a study, as its learning plan may name them.
analysis::LearningNames learning_names(const protocols::Definition& definition);

/// Reads the keys of [analysis] that every protocol has, if the table is there; problems are noted.
void read_mark_rule(Table& root);

}  // namespace haptrial::experiments
