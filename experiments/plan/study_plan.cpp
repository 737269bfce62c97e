#include "experiments/plan/study_plan.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numeric>

#include "analysis/files/sha256.h"
#include "core/base/definition/definition_changes.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;
using PlanJson = nlohmann::ordered_json;

constexpr const char* kFormat = "haptrial plan 1";
constexpr const char* kEnding = ".plan.json";

PlanJson to_json(const StudyPlan& plan) {
  PlanJson groups = PlanJson::array();
  for (const PlannedGroup& group : plan.groups) {
    groups.push_back(
        {{"name", group.name}, {"participants", group.participants}, {"sessions", group.sessions}});
  }
  return {{"format", kFormat},
          {"name", plan.name},
          {"made_utc", plan.made_utc},
          {"login", plan.login},
          {"program", plan.program},
          {"groups", groups},
          {"sessions", plan.sessions},
          {"hypotheses", plan.hypotheses},
          {"tests", plan.tests},
          {"exclusions", plan.exclusions},
          {"stopping", plan.stopping},
          {"ends_early", plan.ends_early},
          {"looks", plan.looks},
          {"retain_until", plan.retain_until},
          {"power", plan.power},
          {"definition_name", plan.definition_name},
          {"definition_sha256", plan.definition_sha256},
          {"scripts_sha256", plan.scripts_sha256},
          {"definition", plan.definition}};
}

StudyPlan from_json(const PlanJson& json) {
  StudyPlan plan;
  json.at("name").get_to(plan.name);
  json.at("made_utc").get_to(plan.made_utc);
  json.at("login").get_to(plan.login);
  json.at("program").get_to(plan.program);
  for (const PlanJson& group : json.at("groups")) {
    plan.groups.push_back({group.at("name").get<std::string>(), group.at("participants"),
                           group.value("sessions", json.at("sessions").get<int>())});
  }
  json.at("sessions").get_to(plan.sessions);
  json.at("hypotheses").get_to(plan.hypotheses);
  json.at("tests").get_to(plan.tests);
  json.at("exclusions").get_to(plan.exclusions);
  json.at("stopping").get_to(plan.stopping);
  json.at("ends_early").get_to(plan.ends_early);
  json.at("looks").get_to(plan.looks);
  json.at("retain_until").get_to(plan.retain_until);
  json.at("power").get_to(plan.power);
  json.at("definition_name").get_to(plan.definition_name);
  json.at("definition_sha256").get_to(plan.definition_sha256);
  json.at("scripts_sha256").get_to(plan.scripts_sha256);
  json.at("definition").get_to(plan.definition);
  return plan;
}

/// A value short enough for a sentence.
std::string shown(const PlanJson& value) {
  constexpr std::size_t kLongest = 80;
  const std::string text = value.dump();
  return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
}

}  // namespace

int StudyPlan::participants() const {
  return std::accumulate(groups.begin(), groups.end(), 0, [](int sum, const PlannedGroup& group) {
    return sum + group.participants;
  });
}

std::string plan_json(const StudyPlan& plan) {
  return to_json(plan).dump(1, ' ', false, PlanJson::error_handler_t::replace) + "\n";
}

StudyPlan read_study_plan(const fs::path& file) {
  const std::string text = file_text(file);
  try {
    const PlanJson json = PlanJson::parse(text);
    if (json.at("format") == kFormat) {
      StudyPlan plan = from_json(json);
      plan.sha256 = analysis::sha256_of(text);
      return plan;
    }
  } catch (const nlohmann::json::exception&) {
    // It is no plan: said below.
  }
  throw InputError(
      fmt::format("{}: is no plan of a study; haptrial plan writes one", file.string()));
}

std::vector<std::string> plan_differences(const StudyPlan& before, const StudyPlan& after) {
  std::vector<std::string> sentences;
  const DefinitionChanges changes = definition_changes(before.definition, after.definition, {});
  if (!changes.binding.empty()) {
    sentences.push_back(sentence_of(changes.binding));
  }
  const PlanJson was = to_json(before), is = to_json(after);
  for (const auto& [key, value] : was.items()) {
    const bool follows = !changes.binding.empty() && key != "program" && key != "scripts_sha256";
    const bool of_definition = key.starts_with("definition");
    if (key != "made_utc" && key != "login" && !of_definition && !follows && value != is.at(key)) {
      sentences.push_back(fmt::format("{} was {}, is {}", key, shown(value), shown(is.at(key))));
    }
  }
  return sentences;
}

fs::path plan_beside(const fs::path& definition) {
  return definition.parent_path() / (definition.stem().string() + kEnding);
}

std::optional<fs::path> plan_in(const fs::path& folder) {
  std::vector<fs::path> plans;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().string().ends_with(kEnding)) {
      plans.push_back(entry.path());
    }
  }
  if (plans.size() > 1) {
    std::ranges::sort(plans);
    throw InputError(fmt::format("{}: holds several plans, {} and {}; keep that of its sessions",
                                 folder.string(), plans[0].filename().string(),
                                 plans[1].filename().string()));
  }
  return plans.empty() ? std::nullopt : std::optional(plans.front());
}

void adopt_plan(const fs::path& definition, const fs::path& folder) {
  const fs::path plan = plan_beside(definition);
  if (!fs::exists(plan)) {
    return;
  }
  const std::string text = file_text(plan);
  const auto there = plan_in(folder);
  if (there && file_text(*there) != text) {
    throw InputError(
        fmt::format("{}: is another plan than {}; give sessions of another plan a folder of their "
                    "own",
                    there->string(), plan.string()));
  }
  if (!there) {
    write_whole(folder / plan.filename(), text);
  }
}

std::string retention_sentence(const StudyPlan& plan, const std::string& today) {
  if (plan.retain_until.empty() || today <= plan.retain_until) {
    return "";
  }
  return fmt::format(
      "the data of {} was to be kept until {}, which is over: delete it as the plan says "
      "(docs/guide-data.md)",
      plan.name, plan.retain_until);
}

std::string utc_now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

std::string login_name() {
  const passwd* entry = ::getpwuid(::getuid());
  return entry != nullptr ? entry->pw_name : std::to_string(::getuid());
}

}  // namespace haptrial::experiments
