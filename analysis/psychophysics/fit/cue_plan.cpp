#include "analysis/psychophysics/fit/cue_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/table.h"

namespace haptrial::analysis::trials {
namespace {

constexpr const char* kTable = "cue_combination";

bool lists(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string one_of(Table& table, const char* key, const std::vector<std::string>& known) {
  std::string name = table.text(key);
  name = name.starts_with('$') ? name.substr(1) : name;
  if (!known.empty() && !lists(known, name)) {
    table.reject(key, fmt::format("\"{}\"", name), fmt::format("{}", fmt::join(known, ", ")));
  }
  return name;
}

std::string factor(Table& table, const char* key, const std::vector<std::string>& by) {
  const std::string name = table.text(key);
  if (!lists(by, name)) {
    table.reject(key, fmt::format("\"{}\"", name),
                 fmt::format("a factor of analysis.by: {}", fmt::join(by, ", ")));
  }
  return name;
}

/// A level as a table of trials shows it.
std::string level_word(Table& table, const std::string& key) {
  return table.has_text(key) ? table.text(key) : fmt::format("{}", table.number(key, {}, ""));
}

FactorLevels levels(Table& cues, const char* key, const CueNames& names,
                    const std::vector<std::string>& by) {
  FactorLevels read;
  Table table = cues.table(key);
  for (const std::string& name : table.keys_as_written()) {
    const std::string level = level_word(table, name);
    read[name] = level;
    const auto known = names.levels.find(name);
    if (!lists(by, name)) {
      table.reject(name, fmt::format("names \"{}\"; state a factor of analysis.by: {}", name,
                                     fmt::join(by, ", ")));
    } else if (known != names.levels.end() && !lists(known->second, level)) {
      table.reject(name, fmt::format("\"{}\"", level),
                   fmt::format("a level of {}: {}", name, fmt::join(known->second, ", ")));
    }
  }
  if (read.empty() && cues.is_table(key)) {
    cues.reject(key, "names no factor; state one with its level");
  }
  return read;
}

/// Whether no condition belongs to both sides.
bool apart(const FactorLevels& a, const FactorLevels& b) {
  return std::any_of(a.begin(), a.end(), [&](const auto& level) {
    const auto other = b.find(level.first);
    return other != b.end() && other->second != level.second;
  });
}

void check_together(Table& analysis, Table& cues, const CuePlan& plan,
                    const std::vector<std::string>& by) {
  if (!plan.first.empty() && !plan.second.empty() && !apart(plan.first, plan.second)) {
    cues.reject("second",
                "does not differ from `first`; state another level of one of its factors");
  }
  for (const auto& [key, alone] : {std::pair("first", &plan.first), {"second", &plan.second}}) {
    if (!alone->empty() && !plan.both.empty() && !apart(*alone, plan.both)) {
      cues.reject("both", fmt::format("does not differ from `{}`; state another level of one of "
                                      "its factors",
                                      key));
    }
  }
  if (plan.at == plan.conflict && !plan.at.empty()) {
    cues.reject("at", fmt::format("\"{}\"", plan.at), "another factor than that of `conflict`");
  }
  for (const std::string& name : by) {
    if (name != plan.at && name != plan.conflict && !plan.both.contains(name)) {
      analysis.reject("by", fmt::format("names \"{}\", of which {} says nothing; leave it out or "
                                        "state its level in `first`, `second` and `both`",
                                        name, kTable));
    }
  }
}

}  // namespace

std::optional<CuePlan> read_cue_plan(Table& analysis, const CueNames& names,
                                     const std::vector<std::string>& by, double guess) {
  if (!analysis.has(kTable)) {
    return std::nullopt;
  }
  Table cues = analysis.table(kTable);
  CuePlan plan;
  plan.first = levels(cues, "first", names, by);
  plan.second = levels(cues, "second", names, by);
  plan.both = levels(cues, "both", names, by);
  plan.at = cues.has("at") ? factor(cues, "at", by) : "";
  plan.conflict = factor(cues, "conflict", by);
  plan.standard = one_of(cues, "standard", names.intervals);
  plan.first_shows = one_of(cues, "first_shows", names.variables);
  plan.second_shows = one_of(cues, "second_shows", names.variables);
  check_together(analysis, cues, plan, by);
  if (guess > 0.0) {
    analysis.reject(kTable,
                    fmt::format("needs functions that begin at 0, as those of \"larger\" or "
                                "\"smaller\" do, not at the guess rate of {}; set guess = 0.0 or "
                                "\"free\" and let the procedure count such an answer",
                                guess));
  }
  return plan;
}

std::string name_of_cue(const FactorLevels& levels) {
  std::vector<std::string> words;
  for (const auto& [name, level] : levels) {
    words.push_back(level);
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace haptrial::analysis::trials
