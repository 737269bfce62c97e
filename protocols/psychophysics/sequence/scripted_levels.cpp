#include "protocols/psychophysics/sequence/scripted_levels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/record/read/session_reader.h"
#include "core/record/rows/trial_rows.h"
#include "protocols/interface/recorded_definition.h"
#include "protocols/psychophysics/sequence/trial_sequence.h"

namespace haptrial::protocols {
namespace {

using Line = nlohmann::ordered_json;  // keys in their order

/// A level of one dimension is a number.
Line json_of(const psychometric::Level& level) {
  return level.size() == 1 ? Line(level.front()) : Line(level);
}

int key_of(int trial, bool practice) { return trial + (practice ? kPracticeNumbers : 0); }

}  // namespace

ScriptedLevels::ScriptedLevels(const ScriptPlan& plan, std::string subject, bool real,
                               std::function<void()> pulse)
    : plan_(plan),
      subject_(std::move(subject)),
      pulse_(std::move(pulse)),
      script_(plan.file, real ? plan.deadline : kPatient) {}

void ScriptedLevels::recall(const record::SessionReader& earlier) {
  recalled_ = kept_before(plan_, kLevelScriptEvent, earlier);
  const std::vector<record::PassRow> passes = earlier.passes();
  std::map<int, std::int32_t> last;  // pass of each trial
  for (const record::LevelRow& row : earlier.rows<record::LevelRow>()) {
    const record::PassRow& pass = passes.at(static_cast<std::size_t>(row.pass));
    const int key = key_of(pass.trial, pass.practice);
    psychometric::Level& level = earlier_[key];
    if (const auto [at, first] = last.try_emplace(key, row.pass); at->second != row.pass) {
      at->second = row.pass;
      level.clear();
    }
    level.push_back(row.asked);
  }
}

std::string ScriptedLevels::line_of(const LevelQuestion& question) const {
  const Track& track = question.track;
  Line history = Line::array();
  if (const auto known = history_.find(question.name); known != history_.end()) {
    for (const psychometric::Outcome& outcome : known->second) {
      history.push_back({{"level", json_of(outcome.applied)}, {"answer", outcome.answer}});
    }
  }
  return Line{{"subject", subject_},
              {"trial", question.trial},
              {"practice", question.practice},
              {"track", question.name},
              {"variables", track.variables()},
              {"low", json_of(track.corner(false))},
              {"high", json_of(track.corner(true))},
              {"proposed", json_of(question.proposed)},
              {"history", history}}
      .dump();
}

psychometric::Level ScriptedLevels::choose(const LevelQuestion& question) {
  const auto before = earlier_.find(key_of(question.trial, question.practice));
  if (before != earlier_.end() && before->second.size() == question.proposed.size()) {
    return before->second;
  }
  ++asked_;
  LevelScript::Answer answer = script_.ask(line_of(question), question.proposed.size(), pulse_);
  if (answer.level) {
    return *answer.level;
  }
  ++left_;
  troubles_.push_back(fmt::format("{} {}: {}: {}; the level is the procedure's own",
                                  question.practice ? "practice trial" : "trial", question.trial,
                                  plan_.file.filename().string(), answer.why_not));
  return question.proposed;
}

void ScriptedLevels::told(const std::string& name, const psychometric::Outcome& outcome) {
  history_[name].push_back(outcome);
}

std::vector<std::string> ScriptedLevels::take_troubles() { return std::exchange(troubles_, {}); }

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
