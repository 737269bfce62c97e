#include "experiments/power/power_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "core/base/random.h"
#include "core/base/scratch_folder.h"
#include "experiments/control/signals.h"
#include "experiments/studies/experiment.h"
#include "experiments/study/study_run.h"

namespace haptrial::experiments {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kChecksum = "checksum ";

/// Names once, then a row of values for each replication; null: it has none.
Json table_of(const std::vector<SimulatedStudy>& all,
              std::vector<NamedNumber> SimulatedStudy::*numbers) {
  std::vector<std::string> names;
  std::map<std::string, std::size_t> places;
  for (const SimulatedStudy& each : all) {
    for (const NamedNumber& number : each.*numbers) {
      if (places.try_emplace(number.name, names.size()).second) {
        names.push_back(number.name);
      }
    }
  }
  Json rows = Json::array();
  for (const SimulatedStudy& each : all) {
    std::vector<Json> row(names.size());
    for (const NamedNumber& number : each.*numbers) {
      row[places.at(number.name)] = std::isfinite(number.value) ? Json(number.value) : Json();
    }
    rows.push_back(row);
  }
  return {{"names", names}, {"rows", rows}};
}

void fill(const Json& table, std::vector<SimulatedStudy>& all,
          std::vector<NamedNumber> SimulatedStudy::*numbers) {
  const auto names = table.at("names").get<std::vector<std::string>>();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Json& row = table.at("rows").at(i);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (row.at(k).is_number()) {
        (all[i].*numbers).push_back({names[k], row.at(k).get<double>()});
      }
    }
  }
}

Json header_of(const PowerQuestion& question, const PowerUnit& unit) {
  return {{"simulated", true},
          {"program", program_words()},
          {"question", question.fingerprint},
          {"cell", question.cells[unit.cell].name},
          {"depth", unit.sessions ? "sessions" : "responses"},
          {"first", unit.first},
          {"count", unit.count}};
}

std::string with_checksum(std::string body) {
  body += '\n';
  return body + fmt::format("{}{:016x}\n", kChecksum, fnv1a(body));
}

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError(fmt::format("{}: {}", file.string(), why));
}

std::string body_of(const std::filesystem::path& file, const std::string& text) {
  const std::size_t at = text.rfind(kChecksum);
  if (at == std::string::npos || with_checksum(text.substr(0, at > 0 ? at - 1 : 0)) != text) {
    refuse(file, "is damaged: its checksum is another; delete it and simulate again");
  }
  return text.substr(0, at);
}

}  // namespace

std::string part_text(const PowerQuestion& question, const PowerUnit& unit,
                      const std::vector<SimulatedStudy>& replications) {
  Json json = header_of(question, unit);
  json["tests"] = table_of(replications, &SimulatedStudy::tests);
  json["values"] = table_of(replications, &SimulatedStudy::values);
  Json failures = Json::array(), trials = Json::array(), hours = Json::array();
  for (const SimulatedStudy& each : replications) {
    failures.push_back(each.failures);
    trials.push_back(each.trials);
    hours.push_back(each.hours);
  }
  json["failures"] = failures;
  json["trials"] = trials;
  json["hours"] = hours;
  return with_checksum(json.dump());
}

std::vector<SimulatedStudy> read_part(const std::filesystem::path& file,
                                      const PowerQuestion& question, const PowerUnit& unit) {
  const std::string body = body_of(file, file_text(file));
  std::vector<SimulatedStudy> all(static_cast<std::size_t>(unit.count));
  try {
    const Json json = Json::parse(body);
    const Json header = header_of(question, unit);
    for (const auto& [key, value] : header.items()) {
      if (json.at(key) != value) {
        refuse(file, fmt::format("has {} {}, but this question has {}; simulate into a new folder",
                                 key, json.at(key).dump(), value.dump()));
      }
    }
    fill(json.at("tests"), all, &SimulatedStudy::tests);
    fill(json.at("values"), all, &SimulatedStudy::values);
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].failures = json.at("failures").at(i).get<std::vector<std::string>>();
      all[i].trials = json.at("trials").at(i).get<std::uint64_t>();
      all[i].hours = json.at("hours").at(i).get<double>();
    }
  } catch (const nlohmann::json::exception& error) {
    refuse(file, "is no part of a simulation of power; delete it and simulate again");
  }
  return all;
}

namespace fs = std::filesystem;
namespace {

/// A cell's definition, and what simulates it.
struct ReadyCell {
  std::unique_ptr<protocols::Definition> definition;
  std::unique_ptr<StudySimulation> study_simulation;
};

ReadyCell ready(const PowerQuestion& question, const PowerUnit& unit) {
  const std::vector<NamedText> parts = question.parts_of(question.cells[unit.cell]);
  ReadyCell cell;
  const protocols::Protocol& protocol = question.study->protocol();
  Table root = Table::parse(parts);
  cell.definition = protocol.read(root, parts.front().file_name, nullptr);
  root.check();
  cell.study_simulation = question.study->study_simulation(*cell.definition, parts.back().file_name,
                                                           question.plan.watch);
  if (unit.sessions) {
    protocol.load(*cell.definition, question.folder);
  }
  return cell;
}

SimulatedStudy in_full(const PowerQuestion& question, const ReadyCell& cell, std::uint64_t seed) {
  const ScratchFolder folder("power");
  DryRun dry;
  dry.participants = cell.definition->design.participants;
  dry.seed = seed;
  dry.folder = folder.path() / "sessions";
  run_dry(question.study->protocol(), *cell.definition, dry);
  return cell.study_simulation->sessions(session_files(dry.folder));
}

}  // namespace

std::string PowerUnit::file() const {
  return fmt::format("{}-{:05}-{:07}.part", sessions ? 's' : 'r', cell, first);
}

std::vector<PowerUnit> units_of(const PowerQuestion& question) {
  const PowerPlan& plan = question.plan;
  const bool sessions = plan.depth == PowerDepth::kSessions;
  std::vector<PowerUnit> units;
  for (std::size_t i = 0; i < question.cells.size(); ++i) {
    const QuestionCell& cell = question.cells[i];
    const int all = cell.null ? plan.null_replications : plan.replications;
    for (int first = 0; first < all; first += plan.block) {
      units.push_back({i, sessions, first, std::min(plan.block, all - first)});
    }
    for (int first = 0; cell.checked && first < plan.checked_replications; ++first) {
      units.push_back({i, true, first, 1});
    }
  }
  return units;
}

std::vector<SimulatedStudy> simulated(const PowerQuestion& question, const PowerUnit& unit) {
  const ReadyCell cell = ready(question, unit);
  const std::uint64_t seed =
      derived_seed(question.plan.seed, "power cell " + question.cells[unit.cell].name);
  std::vector<SimulatedStudy> all;
  for (int i = unit.first; i < unit.first + unit.count; ++i) {
    if (interrupted()) {
      throw RunError("interrupted");
    }
    const std::uint64_t own = derived_seed(seed, fmt::format("replication {}", i));
    try {
      all.push_back(unit.sessions ? in_full(question, cell, own)
                                  : cell.study_simulation->responses(own));
    } catch (const InputError& error) {
      all.emplace_back().failures.push_back(error.what());
    } catch (const RunError& error) {
      if (interrupted()) {
        throw;
      }
      all.emplace_back().failures.push_back(error.what());
    }
  }
  return all;
}

}  // namespace haptrial::experiments
