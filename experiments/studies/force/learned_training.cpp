#include "experiments/studies/force/learned_training.h"

#include "analysis/force_training/study/learned_scores.h"
#include "experiments/studies/learning_names.h"
#include "protocols/definition/groups.h"

namespace haptrial::experiments {
namespace {

std::vector<analysis::SessionOfStudy> planned_sessions(const protocols::Definition& definition) {
  std::vector<analysis::SessionOfStudy> sessions;
  for (int session = 1; definition.sessions() > 1 && session <= definition.sessions(); ++session) {
    sessions.push_back({definition.session_name(session), definition.session_plan(session).gives});
  }
  return sessions;
}

/// Changes from session to session, if the definition has several.
void add_learned(const protocols::ForceDefinition& definition, const CurveAnalysis& curves,
                 analysis::StudyResult& study) {
  if (definition.sessions() == 1) {
    return;
  }
  for (const analysis::SessionSummary& session : study.sessions) {
    study.groups[session.info.subject] =
        protocols::group_of(definition.groups, session.info.subject);
  }
  study.learned = analysis::learned_study(analysis::learned_scores(study, curves.learning.outcomes),
                                          curves.learning, learning_names(definition));
}

}  // namespace

analysis::StudyResult analyze_training(const protocols::ForceDefinition& definition,
                                       const CurveAnalysis& curves,
                                       const std::vector<std::filesystem::path>& files,
                                       int threads) {
  analysis::StudyResult study = analysis::analyze_study(files, curves.scoring, threads, curves.plan,
                                                        planned_sessions(definition));
  add_learned(definition, curves, study);
  return study;
}

}  // namespace haptrial::experiments
