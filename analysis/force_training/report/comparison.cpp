#include "analysis/force_training/report/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "analysis/force_training/score/scores_csv.h"
#include "analysis/force_training/study/identity_json_internal.h"
#include "analysis/statistics/base/p_adjust.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
namespace {

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

/// People who have scores, by identifier.
std::map<std::string, Identity> people_of(const ScoredStudy& study) {
  std::set<std::string> scored;
  for (const TrialScore& s : study.scores) {
    scored.insert(s.subject);
  }
  std::map<std::string, Identity> people;
  for (const Identity& who : study.people) {
    if (scored.contains(who.subject)) {
      people.emplace(who.subject, who);
    }
  }
  return people;
}

void add(std::vector<Unpaired>& unpaired, const std::string& reason, const std::string& subject) {
  auto at = std::find_if(unpaired.begin(), unpaired.end(),
                         [&](const Unpaired& u) { return u.reason == reason; });
  if (at == unpaired.end()) {
    at = unpaired.insert(at, {reason, {}});
  }
  at->subjects.push_back(subject);
}

void pair_participants(StudyComparison& comparison) {
  const auto first = people_of(comparison.first);
  const auto second = people_of(comparison.second);
  for (const auto& [subject, who] : first) {
    const auto other = second.find(subject);
    if (other == second.end()) {
      add(comparison.unpaired, "only in " + comparison.first.name, subject);
    } else if (const std::string why = why_another(who, other->second); !why.empty()) {
      add(comparison.unpaired, why, subject);
    } else {
      comparison.paired.push_back(subject);
    }
  }
  for (const auto& [subject, who] : second) {
    if (!first.contains(subject)) {
      add(comparison.unpaired, "only in " + comparison.second.name, subject);
    }
  }
}

ConditionComparison compare(const StudyComparison& studies, const std::string& condition) {
  ConditionComparison c;
  c.condition = condition;
  const auto before = means_of(studies.first.scores, condition);
  const auto after = means_of(studies.second.scores, condition);
  c.first = mean_and_interval(values_of(before));
  c.second = mean_and_interval(values_of(after));
  c.first_people = before.size();
  c.second_people = after.size();
  c.welch = welch_t_test(values_of(after), values_of(before), Tail::kTwoSided);
  std::vector<double> a;
  std::vector<double> b;
  for (const std::string& subject : studies.paired) {
    if (before.contains(subject) && after.contains(subject)) {
      a.push_back(before.at(subject));
      b.push_back(after.at(subject));
    }
  }
  c.shared = a.size();
  if (!a.empty()) {
    c.shared_difference =
        (std::accumulate(b.begin(), b.end(), 0.0) - std::accumulate(a.begin(), a.end(), 0.0)) /
        static_cast<double>(a.size());
  }
  c.paired = paired_t_test(b, a, Tail::kTwoSided);
  return c;
}

std::vector<ParameterDifference> differences(const ScoredStudy& first, const ScoredStudy& second) {
  std::set<std::string> names;
  for (const auto* study : {&first, &second}) {
    for (const auto& [name, value] : study->parameters) {
      names.insert(name);
    }
  }
  const auto value_in = [](const ScoredStudy& study, const std::string& name) {
    const auto at = study.parameters.find(name);
    return at == study.parameters.end() ? std::string("as published") : at->second;
  };
  std::vector<ParameterDifference> result;
  for (const std::string& name : names) {
    if (value_in(first, name) != value_in(second, name)) {
      result.push_back({name, value_in(first, name), value_in(second, name)});
    }
  }
  return result;
}

void refuse(const ScoredStudy& first, const ScoredStudy& second,
            const std::vector<ParameterDifference>& scoring) {
  std::string list;
  for (const auto& [name, was, is] : scoring) {
    list += fmt::format("{}{}: {} and {}", list.empty() ? "" : "; ", name, was, is);
  }
  throw InputError(fmt::format(
      "{} and {} were scored with different parameters ({}); analyse both with the same "
      "parameters, or add --different-scoring",
      first.name, second.name, list));
}

void adjust(std::vector<ConditionComparison>& conditions) {
  std::vector<Defined<TTest>> paired;
  std::vector<Defined<TTest>> welch;
  for (const auto& c : conditions) {
    paired.push_back(c.paired);
    welch.push_back(c.welch);
  }
  const auto paired_holm = holm_over(paired);
  const auto welch_holm = holm_over(welch);
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    conditions[i].paired_holm = paired_holm[i];
    conditions[i].welch_holm = welch_holm[i];
  }
}

/// Says which conditions one study alone has.
void note_own_conditions(const ScoredStudy& study, const StudyStatistics& own,
                         const StudyStatistics& other, std::vector<std::string>& remarks) {
  std::vector<std::string> alone;
  std::ranges::copy_if(own.conditions, std::back_inserter(alone), [&](const std::string& name) {
    return std::ranges::find(other.conditions, name) == other.conditions.end();
  });
  if (!alone.empty()) {
    remarks.push_back(
        fmt::format("Only in {}, so not compared: {}.", study.name, fmt::join(alone, ", ")));
  }
}

}  // namespace

StudyComparison compare_studies(ScoredStudy first, ScoredStudy second, Scoring scoring) {
  if (first.name == second.name) {
    first.name += " (first)";
    second.name += " (second)";
  }
  StudyComparison comparison;
  comparison.scoring = differences(first, second);
  if (scoring == Scoring::kSame && !comparison.scoring.empty()) {
    refuse(first, second, comparison.scoring);
  }
  comparison.first_statistics = study_statistics(first.scores);
  comparison.second_statistics = study_statistics(second.scores);
  comparison.first = std::move(first);
  comparison.second = std::move(second);
  pair_participants(comparison);
  note_own_conditions(comparison.first, comparison.first_statistics, comparison.second_statistics,
                      comparison.remarks);
  note_own_conditions(comparison.second, comparison.second_statistics, comparison.first_statistics,
                      comparison.remarks);
  const auto& others = comparison.second_statistics.conditions;
  for (const std::string& condition : comparison.first_statistics.conditions) {
    if (std::find(others.begin(), others.end(), condition) != others.end()) {
      comparison.conditions.push_back(compare(comparison, condition));
    }
  }
  if (comparison.conditions.empty()) {
    throw InputError(fmt::format("{} and {} have no training condition in common",
                                 comparison.first.name, comparison.second.name));
  }
  adjust(comparison.conditions);
  return comparison;
}

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kOwnPace = "forces are compared over";

std::string text_of(const fs::path& file) {
  if (!fs::is_regular_file(file)) {
    throw InputError(fmt::format(
        "{}: cannot be read; analyse the study with haptrial analyze first", file.string()));
  }
  return file_text(file);
}

std::string name_of(const Json& json) {
  const std::string file = json.contains("curves_from")
                               ? json["curves_from"].get<std::string>()
                               : json.at("sessions").at(0).at("definition").get<std::string>();
  return fs::path(file).stem().string();
}

void read_statistics(const Json& json, ScoredStudy& study) {
  study.name = name_of(json);
  study.parameters = json.at("parameters").get<std::map<std::string, std::string>>();
  study.own_pace = study.parameters.erase(kOwnPace) > 0;
  study.people = identities_from(json.at("identities"));
}

/// Both files must be of one analysis.
void require_people(const ScoredStudy& study, const fs::path& statistics) {
  for (const TrialScore& score : study.scores) {
    const bool known = std::any_of(study.people.begin(), study.people.end(),
                                   [&](const auto& who) { return who.subject == score.subject; });
    if (!known) {
      throw InputError(
          fmt::format("{}: does not list participant {} of scores.csv; analyse the study again",
                      statistics.string(), score.subject));
    }
  }
}

}  // namespace

bool ScoredStudy::simulated() const {
  return std::any_of(people.begin(), people.end(), [](const auto& who) { return who.simulated; });
}

ScoredStudy read_scored_study(const fs::path& folder) {
  ScoredStudy study;
  const fs::path table = folder / "scores.csv";
  study.scores = read_scores_csv(text_of(table), table.string()).scores;
  const fs::path statistics = folder / "statistics.json";
  try {
    const Json json = Json::parse(text_of(statistics));
    if (json.contains("simulated") && !json.contains("identities")) {
      throw InputError(
          fmt::format("{}: does not say who the participants were, because an older haptrial wrote "
                      "the file; analyse the study again",
                      statistics.string()));
    }
    read_statistics(json, study);
  } catch (const Json::exception&) {
    throw InputError(fmt::format(
        "{}: is not the statistics of a study; analyse the study again with haptrial analyze",
        statistics.string()));
  }
  require_people(study, statistics);
  return study;
}

}  // namespace haptrial::analysis
