#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "experiments/plan/audit/preregistration.h"

namespace haptrial::experiments {
namespace {

constexpr const char* kPeople = "design.participants";

/// "observer.drift 0.01": what was varied beside the number of participants.
std::string varied_words(const nlohmann::json& levels) {
  std::string words;
  for (const auto& [key, value] : levels.items()) {
    if (key != kPeople) {
      words += fmt::format("{}{} {:g}", words.empty() ? "" : ", ", key, value.get<double>());
    }
  }
  return words.empty() ? "the definition as it is" : words;
}

std::string cell_words(const nlohmann::json& cell, const std::string& watch, int participants) {
  const auto& test = cell.at("studies").at("tests").at(watch);
  return fmt::format(
      "{}: found with {} participants in {:.1f} % [{:.1f}, {:.1f}] of {} simulated "
      "studies",
      varied_words(cell.at("levels")), participants, 100.0 * test.at("share").get<double>(),
      100.0 * test.at("low_95").get<double>(), 100.0 * test.at("high_95").get<double>(),
      test.at("made").get<long>());
}

std::vector<std::string> words_of(const nlohmann::json& json, int participants) {
  const std::string watch = json.at("watch");
  std::vector<std::string> lines{fmt::format(
      "watched test: {}, at {:g}, simulated by {}; {}", watch, json.at("alpha").get<double>(),
      json.at("program").get<std::string>(), json.at("verdict").get<std::string>())};
  for (const auto& cell : json.at("cells")) {
    const auto people = cell.at("levels").find(kPeople);
    if (people == cell.at("levels").end() || *people == participants) {
      lines.push_back(cell_words(cell, watch, participants));
    }
  }
  return lines;
}

}  // namespace

std::vector<std::string> simulated_power(const std::filesystem::path& simulation,
                                         const std::string& study, int participants) {
  const std::filesystem::path file = simulation / "power.json";
  try {
    const auto json = nlohmann::json::parse(file_text(file));
    if (const std::string of = json.at("experiment"); of != study) {
      throw InputError(fmt::format("{}: is of the study {}, not of {}", file.string(), of, study));
    }
    std::vector<std::string> lines = words_of(json, participants);
    if (lines.size() < 2) {
      throw InputError(fmt::format(
          "{}: has no cell with the {} participants of the definition; simulate that number",
          file.string(), participants));
    }
    return lines;
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{}: is no result of haptrial power simulate", file.string()));
  }
}

}  // namespace haptrial::experiments
