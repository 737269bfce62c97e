#include "protocols/psychophysics/sequence/level_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace haptrial::protocols {
namespace {

LevelScript::Answer level_in(const std::string& line, std::size_t dimensions) {
  using Json = nlohmann::json;
  const Json said = Json::parse(line)["level"];
  if (said.is_null()) {
    return {std::nullopt, "it left the choice to the procedure"};
  }
  psychometric::Level level;
  for (const Json& each : said.is_array() ? said : Json::array({said})) {
    level.push_back(each.is_number() ? each.get<double>() : std::nan(""));
  }
  const bool finite = std::ranges::all_of(level, [](double each) { return std::isfinite(each); });
  if (level.size() != dimensions || !finite) {
    return {std::nullopt,
            fmt::format("its level was {}, not {}", said.dump(),
                        dimensions == 1 ? "a number" : fmt::format("{} numbers", dimensions))};
  }
  return {std::move(level), ""};
}

}  // namespace

LevelScript::LevelScript(std::filesystem::path file, double deadline, double longest_start)
    : process_(std::move(file), deadline, "level", longest_start) {}

LevelScript::Answer LevelScript::ask(const std::string& question, std::size_t dimensions,
                                     const std::function<void()>& pulse) {
  const ScriptProcess::Reply reply = process_.ask(question, pulse);
  return reply.line.empty() ? Answer{std::nullopt, reply.why_not}
                            : level_in(reply.line, dimensions);
}

}  // namespace haptrial::protocols
