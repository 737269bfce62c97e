#include "experiments/studies/psychophysics/file_quantities.h"

#include "analysis/psychophysics/study/paired_quantities.h"
#include "analysis/psychophysics/study/produced_quantities.h"
#include "analysis/psychophysics/study/pursuit_quantities.h"
#include "analysis/psychophysics/study/reach_quantities.h"
#include "experiments/studies/psychophysics/reach_routes.h"
#include "protocols/psychophysics/definition/trials_definition.h"

namespace haptrial::experiments {

namespace trials = analysis::trials;
using trials::AnalysisKind;

void add_file_quantities(const protocols::TrialsDefinition& definition,
                         const std::vector<std::filesystem::path>& files, int threads,
                         trials::TrialsResult& result) {
  const trials::TrialsPlan& plan = result.plan;
  if (plan.kind == AnalysisKind::kReaching) {
    const auto routes = reach_routes(definition, result.data, plan.reaching);
    result.reaching = trials::reaching_study(
        result.data,
        trials::study_reaches(result.data, files, routes, plan.reaching.stage, plan.reaching.clamp,
                              threads),
        plan.reaching, threads);
    result.quantities = trials::reach_quantities(result.data, *result.reaching, plan);
  }
  if (plan.kind == AnalysisKind::kPursuit) {
    result.quantities = trials::pursuit_quantities(result.data, files, plan, threads);
  }
  if (plan.kind == AnalysisKind::kPaired) {
    result.quantities = trials::paired_quantities(result.data, plan);
  }
  if (plan.kind == AnalysisKind::kProduced) {
    result.quantities = trials::produced_quantities(result.data, plan);
  }
}

}  // namespace haptrial::experiments
