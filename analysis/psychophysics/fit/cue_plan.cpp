#include "analysis/psychophysics/fit/cue_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/base/definition/schema.h"

namespace haptrial::analysis::trials {
namespace {

constexpr const char* kTable = "cue_combination";

bool lists(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string one_of(Table& table, const std::string& key, const std::vector<std::string>& known) {
  std::string name = table.text(key);
  name = name.starts_with('$') ? name.substr(1) : name;
  if (!known.empty() && !lists(known, name)) {
    table.reject(key, fmt::format("\"{}\"", name), fmt::format("{}", fmt::join(known, ", ")));
  }
  return name;
}

std::string factor(Table& table, const std::string& key, const std::vector<std::string>& by) {
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

/// @param description  of each level
FactorLevels levels(Table& cues, const std::string& key, const char* description,
                    const CueNames& names, const std::vector<std::string>& by) {
  FactorLevels read;
  Table table = cues.table(key);
  for (const std::string& name : table.keys_as_written()) {
    table.describe({name, description, "", true});
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

/// Adds a table of levels by their factors.
void add_levels(Schema<CuePlan>& schema, const char* name, FactorLevels CuePlan::*member,
                const char* description, const CueNames& names,
                const std::vector<std::string>& by) {
  schema
      .custom(name, description,
              [=, &names, &by](Table& table, const std::string& key, CuePlan& plan) {
                plan.*member = levels(table, key, description, names, by);
              })
      .required();
}

Schema<CuePlan> make_cue_schema(const CueNames& names, const std::vector<std::string>& by) {
  using P = CuePlan;
  const auto factor_key = [&by](std::string P::*member) {
    return [&by, member](Table& table, const std::string& key, P& plan) {
      plan.*member = factor(table, key, by);
    };
  };
  const auto name_key = [](std::string P::*member, const std::vector<std::string>& known) {
    return [&known, member](Table& table, const std::string& key, P& plan) {
      plan.*member = one_of(table, key, known);
    };
  };
  Schema<P> schema;
  add_levels(schema, "first", &P::first,
             "Level of the factor NAME in conditions with the first cue alone", names, by);
  add_levels(schema, "second", &P::second,
             "Level of the factor NAME in conditions with the second cue alone", names, by);
  add_levels(schema, "both", &P::both, "Level of the factor NAME in conditions with both cues",
             names, by);
  schema.custom("at", "Factor that changes how reliable the first cue is", factor_key(&P::at))
      .otherwise("none")
      .custom("conflict", "Factor by which the cues of the standard disagree",
              factor_key(&P::conflict))
      .required()
      .custom("standard", "Interval whose cues disagree", name_key(&P::standard, names.intervals))
      .required()
      .custom("first_shows", "Variable that the first cue shows in the interval of the standard",
              name_key(&P::first_shows, names.variables))
      .required()
      .custom("second_shows", "Variable that the second cue shows in the interval of the standard",
              name_key(&P::second_shows, names.variables))
      .required();
  return schema;
}

}  // namespace

std::optional<CuePlan> read_cue_plan(Table& analysis, const CueNames& names,
                                     const std::vector<std::string>& by, double guess) {
  if (!analysis.has(kTable)) {
    return std::nullopt;
  }
  Table cues = analysis.table(kTable);
  const CuePlan plan = make_cue_schema(names, by).read(cues);
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
