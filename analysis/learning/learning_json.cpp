#include <nlohmann/json.hpp>

#include "analysis/learning/learned_study.h"
#include "analysis/learning/learning_json_internal.h"
#include "analysis/statistics/design/result_json_internal.h"

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json mean_json(const Defined<MeanInterval>& mean) {
  return mean ? to_json(*mean) : Json{{"not_defined", mean.because()}};
}

}  // namespace

nlohmann::ordered_json learning_json(const LearnedStudy& study) {
  Json outcomes = Json::array();
  for (const LearnedOutcome& outcome : study.outcomes) {
    Json means = Json::array();
    for (std::size_t g = 0; g < outcome.groups.size(); ++g) {
      for (std::size_t s = 0; s < outcome.sessions.size(); ++s) {
        means.push_back({{"group", outcome.groups[g]},
                         {"session", outcome.sessions[s]},
                         {"mean", mean_json(outcome.means[g][s])}});
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
