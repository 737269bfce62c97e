#include "experiments/studies/curve_analysis.h"

#include <algorithm>
#include <set>

#include "analysis/force_training/study/learned_scores.h"
#include "core/base/definition/schema.h"
#include "core/base/definition/table.h"
#include "core/record/read/marked_trials.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/groups.h"
#include "protocols/force_training/training_pass.h"

namespace haptrial::experiments {
namespace {

/// The conditions that planned tests may name. If the list of conditions is itself wrong, that
/// alone is a problem, so that every known one may be named.
std::vector<std::string> nameable(std::vector<std::string> conditions) {
  const auto& known = protocols::training_conditions();
  const bool good =
      std::set<std::string>(conditions.begin(), conditions.end()).size() == conditions.size() &&
      std::all_of(conditions.begin(), conditions.end(), [&known](const std::string& condition) {
        return std::find(known.begin(), known.end(), condition) != known.end();
      });
  if (!good) {
    conditions.insert(conditions.end(), known.begin(), known.end());
  }
  return conditions;
}

/// Rejects a score of neither force nor slope: nothing but the alignment would make it.
void reject_empty_score(Table& analysis, const analysis::ScoreParameters& p) {
  const auto& a = p.alignment;
  if (p.force_share == 0.0 && p.slope_share == 0.0 && a.force_weight == 0.0 &&
      a.slope_weight == 0.0) {
    analysis.reject("force_weight", "0 as are slope_weight, force_share and slope_share",
                    "one of these four above 0: else the score does not depend on the forces");
  }
}

std::vector<std::string> conditions_of(Table& root) {
  Table design = root.table("design");
  return design.has("conditions") ? design.texts("conditions") : std::vector<std::string>{};
}

}  // namespace

CurveAnalysis read_curve_analysis(Table& root, const protocols::Definition* definition,
                                  bool fresh) {
  Table analysis = root.table("analysis");
  CurveAnalysis found{analysis::read_scoring(root, analysis), {}};
  if (analysis.has("outcomes")) {
    const auto names =
        definition == nullptr ? analysis::LearningNames{} : learning_names(*definition);
    found.learning = analysis::read_learning_plan(root, names, analysis::score_outcomes());
  } else {
    found.plan = analysis::read_analysis_plan(analysis, nameable(conditions_of(root)));
  }
  if (fresh) {
    reject_empty_score(analysis, found.scoring);
  }
  return found;
}

CurveAnalysis curve_analysis_of(const protocols::Definition& definition) {
  Table root = definition.root();
  CurveAnalysis found = read_curve_analysis(root, &definition, false);
  root.check();
  return found;
}

analysis::AnalysisPlan plan_of(const std::vector<std::string>& planned,
                               const std::string& reference) {
  return analysis::parse_analysis_plan(planned, reference, "--planned");
}

analysis::AnalysisPlan plan_for(const std::vector<std::string>& planned,
                                const std::string& reference, analysis::AnalysisPlan plan,
                                std::vector<std::string>& remarks) {
  const analysis::AnalysisPlan given = plan_of(planned, reference);
  if (!given.tests.empty()) {
    plan = analysis::with_tests(std::move(plan), given.tests);
    remarks.emplace_back("The planned tests were given to analyze, not stated in the definition.");
  }
  if (!given.reference.empty()) {
    plan.reference = given.reference;
    remarks.emplace_back(
        "The reference condition was given to analyze, not stated in the definition.");
  }
  return plan;
}

std::vector<std::string> warnings_of(const analysis::ScoreParameters& p) {
  std::vector<std::string> warnings;
  const auto& a = p.alignment;
  if (a.force_weight == 0.0 && a.slope_weight == 0.0) {
    warnings.emplace_back(
        "analysis.force_weight and analysis.slope_weight are 0; curves are then aligned without "
        "looking at them, and analysis.cost_share adds the same number to every score");
  } else if (a.penalty == 0.0 && p.window != 0.0) {
    warnings.emplace_back(
        "analysis.penalty is 0; the alignment then stretches time without cost, so a recall that "
        "comes late or too slowly is scored as a good one");
  }
  return warnings;
}

analysis::LearningNames learning_names(const protocols::Definition& d) {
  analysis::LearningNames names;
  for (const protocols::StudyGroup& group : d.groups) {
    names.groups.push_back(group.name);
  }
  for (int session = 1; session <= d.sessions(); ++session) {
    names.sessions.push_back(d.session_name(session));
    if (!d.session_plan(session).gives) {
      names.tests.push_back(d.session_name(session));
    }
  }
  return names;
}

void read_mark_rule(Table& root) {
  if (root.has("analysis")) {
    Table analysis = root.table("analysis");
    record::MarkRule rule;
    record::mark_rule_schema().read(analysis, rule);
  }
}

}  // namespace haptrial::experiments
