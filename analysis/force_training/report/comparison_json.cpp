#include <nlohmann/json.hpp>

#include "analysis/force_training/report/comparison.h"

namespace haptrial::analysis {
namespace {

using Json = nlohmann::ordered_json;

Json compared_json(const Defined<MeanInterval>& m) {
  return m ? Json{{"count", m->count},
                  {"mean", m->mean},
                  {"standard_deviation", m->deviation},
                  {"low_95", m->low},
                  {"high_95", m->high}}
           : Json{{"not_defined", m.because()}};
}

Json compared_json(const Defined<TTest>& t) {
  return t ? Json{{"t", t->t},
                  {"df", t->df},
                  {"p", t->p},
                  {"difference", t->difference},
                  {"difference_low_95", t->low},
                  {"difference_high_95", t->high}}
           : Json{{"not_defined", t.because()}};
}

Json compared_json(const Defined<double>& p) {
  return p ? Json(*p) : Json{{"not_defined", p.because()}};
}

Json about(const ScoredStudy& study, const StudyStatistics& statistics) {
  Json json{{"study", study.name},
            {"simulated", study.simulated()},
            {"own_pace", study.own_pace},
            {"participants", statistics.subjects.size()},
            {"trials", study.scores.size()}};
  const auto& anova = statistics.repeated;
  json["repeated_measures_anova"] = anova
                                        ? Json{{"f", anova->f},
                                               {"df_condition", anova->df_condition},
                                               {"df_error", anova->df_error},
                                               {"p", anova->p},
                                               {"p_corrected", anova->p_corrected},
                                               {"partial_eta_squared", anova->partial_eta_squared}}
                                        : Json{{"not_defined", anova.because()}};
  return json;
}

}  // namespace

std::string comparison_json(const StudyComparison& comparison) {
  Json root;
  root["simulated"] = comparison.first.simulated() || comparison.second.simulated();
  root["different_scoring"] = Json::array();
  for (const auto& [name, first, second] : comparison.scoring) {
    root["different_scoring"].push_back(
        {{"parameter", name}, {"first", first}, {"second", second}});
  }
  root["first"] = about(comparison.first, comparison.first_statistics);
  root["second"] = about(comparison.second, comparison.second_statistics);
  root["paired_participants"] = comparison.paired;
  root["not_paired"] = Json::array();
  for (const auto& [reason, subjects] : comparison.unpaired) {
    root["not_paired"].push_back({{"because", reason}, {"subjects", subjects}});
  }
  root["conditions"] = Json::array();
  for (const auto& c : comparison.conditions) {
    root["conditions"].push_back(
        {{"condition", c.condition},
         {"first_participant_means", compared_json(c.first)},
         {"second_participant_means", compared_json(c.second)},
         {"welch_two_sided", compared_json(c.welch)},
         {"welch_p_holm", compared_json(c.welch_holm)},
         {"shared_participants", c.shared},
         {"shared_difference", c.shared > 0 ? Json(c.shared_difference) : Json()},
         {"paired_two_sided", compared_json(c.paired)},
         {"paired_p_holm", compared_json(c.paired_holm)}});
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace haptrial::analysis
