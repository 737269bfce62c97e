#include "experiments/command/start/key_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <exception>
#include <set>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/studies/curve_analysis.h"
#include "experiments/studies/power_plan.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {

const std::map<std::string, std::string>& shared_tables() {
  static const std::map<std::string, std::string> tables{
      {"procedures[]", "procedure"},
      {"procedure.tracks[]", "procedure"},
      {"procedures[].tracks[]", "procedure"},
      {"responses[]", "response"},
      {"design.session.1", "design.session.NAME"}};
  return tables;
}

namespace {

std::string shared(const std::string& table) {
  std::string found = table;
  std::size_t longest = 0;
  for (const auto& [other, own] : shared_tables()) {
    const bool within = table == other || table.starts_with(other + ".");
    if (within && other.size() > longest) {
      found = own + table.substr(other.size());
      longest = other.size();
    }
  }
  return found;
}

/// Beginnings that no reading with one change after another comes to: a question that has one way
/// of being answered alone, a channel without a second place. Choices beyond the last are the last.
std::vector<KeyExploration::Plan> beginnings() {
  constexpr std::size_t kMostChoices = 40;
  constexpr std::size_t kNotThere = 1;
  const auto there = [](const std::string& key) { return key + " is there"; };
  const std::vector<std::string> questions{"response.", "pages.NAME.items[]."};
  const std::vector<std::string> ways{"choices", "scale", "number"};
  std::vector<KeyExploration::Plan> plans{{}};
  for (const std::string& question : questions) {
    for (const std::string& way : ways) {
      KeyExploration::Plan plan{{"pages.NAME.kind", kMostChoices},  // questions
                                {there(question + "words"), kNotThere}};
      for (const std::string& other : ways) {
        if (other != way) {
          plan[there(question + other)] = kNotThere;
        }
      }
      plans.push_back(std::move(plan));
    }
  }
  for (std::size_t type = 0; type < kMostChoices; ++type) {
    plans.push_back({{"fields.NAME.type", type},
                     {there("fields.NAME.from"), kNotThere},
                     {there("fields.NAME.to"), kNotThere}});
  }
  return plans;
}

/// The facts of a key, to compare those of two protocols.
bool same(const KnownKey& a, const KnownKey& b) {
  return a.path() == b.path() && a.type == b.type && a.allowed == b.allowed && a.unit == b.unit &&
         a.otherwise == b.otherwise && a.optional == b.optional && a.when == b.when;
}

void add(std::vector<KnownKey>& keys, KnownKey key) {
  key.table = shared(key.table);
  if (key.path() == "experiment.protocol") {
    key.otherwise = "force_training";  // stated for the reader here; a definition may leave it out
    key.optional = true;
  } else if (key.path() == "virtual_surgeons.skill.participants") {
    key.key = "NAME";  // of a group; this is the one of definitions without groups
  }
  const auto at = std::find_if(keys.begin(), keys.end(),
                               [&](const KnownKey& each) { return each.path() == key.path(); });
  if (at == keys.end()) {
    keys.push_back(std::move(key));
    return;
  }
  at->optional = at->optional || key.optional;
  at->otherwise = at->otherwise.empty() ? key.otherwise : at->otherwise;
}

/// A number that varies over people has a table of its own: one key says both.
std::vector<KnownKey> without_spreads(const std::vector<KnownKey>& keys) {
  std::map<std::string, std::set<std::string>> within;
  std::set<std::string> paths;
  for (const KnownKey& key : keys) {
    within[key.table].insert(key.key);
    paths.insert(key.path());
  }
  const auto varies = [&](const std::string& table) {
    const auto at = within.find(table);
    return at != within.end() && at->second == std::set<std::string>{"median", "spread"};
  };
  std::vector<KnownKey> rest;
  for (KnownKey key : keys) {
    if (varies(key.path())) {
      key.type = "number or { median, spread }";
      key.forms.push_back({"table", {}, {}});
    } else if (varies(key.table)) {
      if (key.key == "spread" || paths.contains(key.table)) {
        continue;
      }
      const std::size_t dot = key.table.rfind('.');
      key.key = key.table.substr(dot + 1);
      key.table = key.table.substr(0, dot);
      key.type = "{ median, spread }";
      key.forms = {{"table", {}, {}}};
    }
    rest.push_back(std::move(key));
  }
  return rest;
}

/// Tables whose keys are listed are no keys themselves; others are left to other readers, so that
/// this one does not need them.
std::vector<KnownKey> without_tables(const std::vector<KnownKey>& keys) {
  std::vector<KnownKey> rest;
  std::copy_if(keys.begin(), keys.end(), std::back_inserter(rest), [&](const KnownKey& key) {
    return key.type != "table" || std::none_of(keys.begin(), keys.end(), [&](const KnownKey& each) {
             return each.table == key.path() || each.table.starts_with(key.path() + ".");
           });
  });
  for (KnownKey& key : rest) {
    key.optional = key.optional || key.type == "table";
  }
  return rest;
}

/// The keys of each protocol, and first those that all of them have alike.
std::vector<KeySection> sections_of_all() {
  std::vector<KeySection> sections(1);
  std::vector<std::vector<KnownKey>> keys;
  for (const Study* study : studies()) {
    keys.push_back(keys_of(*study));
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    sections.push_back({std::string(studies()[i]->protocol().name()), {}});
    for (const KnownKey& key : keys[i]) {
      const bool common = std::all_of(keys.begin(), keys.end(), [&](const auto& others) {
        return std::any_of(others.begin(), others.end(),
                           [&](const KnownKey& other) { return same(key, other); });
      });
      if (!common) {
        sections.back().keys.push_back(key);
      } else if (i == 0) {
        sections.front().keys.push_back(key);
      }
    }
  }
  return sections;
}

}  // namespace

std::vector<KnownKey> keys_of(const Study& study) {
  const std::string text =
      fmt::format("[experiment]\nprotocol = \"{}\"\n", study.protocol().name());
  const auto read = [&](Table& root) {
    try {
      study.protocol().read(root, "definition", nullptr);
    } catch (const std::exception&) {
      // What the analysis asks for is asked for all the same.
    }
    // A definition of made-up values would say wrong things of an analysis.
    study.read_analysis(root, nullptr, true);
    read_mark_rule(root);
    read_plan_table(root);
    if (root.has("power")) {
      read_power_plan(root);
    }
  };
  const auto found = known_keys(text, read, beginnings());
  std::vector<KnownKey> keys;
  for (const KnownKey& key : found) {
    add(keys, key);
  }
  return without_tables(without_spreads(keys));
}

std::vector<KeySection> key_sections(const std::string& protocol) {
  std::vector<KeySection> sections = sections_of_all();
  std::erase_if(sections, [&](const KeySection& section) {
    return !protocol.empty() && !section.protocol.empty() && section.protocol != protocol;
  });
  return sections;
}

static std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::vector<KeySection> sections_with(const std::string& word) {
  const std::string wanted = lower_case(word);
  std::vector<KeySection> sections = key_sections("");
  for (KeySection& section : sections) {
    std::erase_if(section.keys, [&](const KnownKey& key) {
      const std::string all = key.path() + " " + key.words;
      return lower_case(all).find(wanted) == std::string::npos;
    });
  }
  std::erase_if(sections, [](const KeySection& section) { return section.keys.empty(); });
  if (sections.empty()) {
    throw InputError(
        fmt::format("no key has '{}' in its name or its words; haptrial keys lists all keys, and "
                    "haptrial keys PROTOCOL those of {}",
                    word, fmt::join(protocol_words(), ", ")));
  }
  return sections;
}

}  // namespace haptrial::experiments
