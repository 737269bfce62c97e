#include "analysis/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/p_adjust.h"
#include "analysis/scores_csv.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string text_of(const fs::path& file) {
  if (!fs::is_regular_file(file)) {
    throw InputError(
        fmt::format("{}: cannot be read; allowed: the folder of a study that haptrial "
                    "analyze has analysed",
                    file.string()));
  }
  return file_text(file);
}

/// Means of each participant's trials of a condition.
std::map<std::string, double> means_of(const std::vector<TrialScore>& scores,
                                       const std::string& condition) {
  std::map<std::string, std::vector<double>> values;
  for (const TrialScore& s : scores) {
    if (s.condition == condition) {
      values[s.subject].push_back(s.score);
    }
  }
  std::map<std::string, double> means;
  for (const auto& [subject, of_subject] : values) {
    means[subject] = moments(of_subject)->mean();
  }
  return means;
}

std::vector<double> values_of(const std::map<std::string, double>& means) {
  std::vector<double> values;
  for (const auto& [subject, mean] : means) {
    values.push_back(mean);
  }
  return values;
}

ConditionComparison compare(const ScoredStudy& first, const ScoredStudy& second,
                            const std::string& condition) {
  ConditionComparison c;
  c.condition = condition;
  const auto before = means_of(first.scores, condition);
  const auto after = means_of(second.scores, condition);
  c.first = mean_interval(values_of(before));
  c.second = mean_interval(values_of(after));
  c.welch = welch_t_test(values_of(after), values_of(before), Tail::kTwoSided);
  std::vector<double> a;
  std::vector<double> b;
  for (const auto& [subject, mean] : before) {
    if (const auto same = after.find(subject); same != after.end()) {
      a.push_back(mean);
      b.push_back(same->second);
    }
  }
  c.shared = a.size();
  c.paired = paired_t_test(b, a, Tail::kTwoSided);
  return c;
}

Json to_json(const Defined<MeanInterval>& m) {
  return m ? Json{{"count", m->count},
                  {"mean", m->mean},
                  {"standard_deviation", m->deviation},
                  {"low_95", m->low},
                  {"high_95", m->high}}
           : Json{{"not_defined", m.because()}};
}

Json to_json(const Defined<TTest>& t) {
  return t ? Json{{"t", t->t},
                  {"df", t->df},
                  {"p", t->p},
                  {"difference", t->difference},
                  {"difference_low_95", t->low},
                  {"difference_high_95", t->high}}
           : Json{{"not_defined", t.because()}};
}

Json about(const ScoredStudy& study, const StudyStatistics& statistics) {
  Json json{{"study", study.name},
            {"simulated", study.simulated},
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

ScoredStudy read_scored_study(const fs::path& folder) {
  ScoredStudy study;
  const fs::path table = folder / "scores.csv";
  study.scores = read_scores_csv(text_of(table), table.string()).scores;
  const fs::path statistics = folder / "statistics.json";
  try {
    const Json json = Json::parse(text_of(statistics));
    study.name = fs::path(json.at("sessions").at(0).at("definition").get<std::string>()).stem();
    study.simulated = json.at("simulated").get<bool>();
    study.own_pace = json.at("parameters").contains("forces are compared over");
  } catch (const Json::exception&) {
    throw InputError(
        fmt::format("{}: is not the statistics of a study; allowed: what haptrial analyze writes",
                    statistics.string()));
  }
  return study;
}

StudyComparison compare_studies(ScoredStudy first, ScoredStudy second) {
  if (first.name == second.name) {
    first.name += " (first)";
    second.name += " (second)";
  }
  StudyComparison comparison;
  comparison.first_statistics = study_statistics(first.scores);
  comparison.second_statistics = study_statistics(second.scores);
  const auto& others = comparison.second_statistics.conditions;
  for (const std::string& condition : comparison.first_statistics.conditions) {
    if (std::find(others.begin(), others.end(), condition) != others.end()) {
      comparison.conditions.push_back(compare(first, second, condition));
    }
  }
  if (comparison.conditions.empty()) {
    throw InputError(
        fmt::format("{} and {} have no training condition in common", first.name, second.name));
  }
  std::vector<Defined<TTest>> paired;
  for (const auto& c : comparison.conditions) {
    paired.push_back(c.paired);
  }
  const auto adjusted = holm_over(paired);
  for (std::size_t i = 0; i < adjusted.size(); ++i) {
    comparison.conditions[i].paired_holm = adjusted[i];
  }
  comparison.first = std::move(first);
  comparison.second = std::move(second);
  return comparison;
}

std::string comparison_json(const StudyComparison& comparison) {
  Json root;
  root["first"] = about(comparison.first, comparison.first_statistics);
  root["second"] = about(comparison.second, comparison.second_statistics);
  root["conditions"] = Json::array();
  for (const auto& c : comparison.conditions) {
    root["conditions"].push_back(
        {{"condition", c.condition},
         {"first_participant_means", to_json(c.first)},
         {"second_participant_means", to_json(c.second)},
         {"welch_two_sided", to_json(c.welch)},
         {"shared_participants", c.shared},
         {"paired_two_sided", to_json(c.paired)},
         {"paired_p_holm",
          c.paired_holm ? Json(*c.paired_holm) : Json{{"not_defined", c.paired_holm.because()}}}});
  }
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace haptrial::analysis
