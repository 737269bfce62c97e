#include <nlohmann/json.hpp>

#include "analysis/learning/learned_study.h"
#include "analysis/learning/learning_json_internal.h"
#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis {

using Json = nlohmann::ordered_json;

nlohmann::ordered_json learning_json(const LearnedStudy& study) {
  Json outcomes = Json::array();
  for (const LearnedOutcome& outcome : study.outcomes) {
    Json means = Json::array();
    for (std::size_t g = 0; g < outcome.groups.size(); ++g) {
      for (std::size_t s = 0; s < outcome.sessions.size(); ++s) {
        means.push_back({{"group", outcome.groups[g]},
                         {"session", outcome.sessions[s]},
                         {"mean", to_json(outcome.means[g][s])}});
      }
    }
    outcomes.push_back({{"outcome", outcome.name},
                        {"unit", outcome.unit},
                        {"means", means},
                        {"changes", to_json(outcome.tests)}});
  }
  return {{"baseline", study.plan.baseline}, {"tests", study.plan.tests}, {"outcomes", outcomes}};
}

}  // namespace haptrial::analysis
