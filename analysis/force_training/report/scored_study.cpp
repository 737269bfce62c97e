#include "analysis/force_training/report/scored_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "analysis/force_training/score/scores_csv.h"
#include "analysis/force_training/study/identity_json_internal.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis {
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
