#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "experiments/command/start/key_list.h"
#include "protocols/definition/lab_file.h"

namespace haptrial::experiments {
namespace {

/// A bar would begin another cell, and a line break another row.
std::string cell(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) {
    text.replace(at, 1, "\\|");
  }
  return text;
}

bool of_machine(const std::string& table) {
  const std::vector<std::string>& machines = protocols::machine_tables();
  return std::find(machines.begin(), machines.end(), table.substr(0, table.find('.'))) !=
         machines.end();
}

/// "[design]", "[[stages]]", "[fields.NAME]", "[[stages]].until"
std::string heading_of(const std::string& table) {
  const std::size_t array = table.find("[]");
  std::string name = array == std::string::npos
                         ? fmt::format("[{}]", table)
                         : fmt::format("[[{}]]{}", table.substr(0, array), table.substr(array + 2));
  for (std::size_t at = name.find("[]"); at != std::string::npos; at = name.find("[]")) {
    name.erase(at, 2);
  }
  return of_machine(table) ? name + " (may stand in a lab file)" : name;
}

/// The unit has a column of its own.
std::string bounds_of(const KnownKey& key) {
  std::string words = key.allowed;
  const std::string unit = fmt::format(" [{}]", key.unit);
  if (!key.unit.empty() && words.ends_with(unit)) {
    words.resize(words.size() - unit.size());
  }
  return words;
}

/// The description of a key; it says if a pilot may change the key.
std::string words_of(const KnownKey& key) {
  return key.words + (key.tunable ? "; tunable in a pilot" : "");
}

std::string row_of(const KnownKey& key) {
  const std::string otherwise = !key.otherwise.empty() ? key.otherwise
                                : key.optional         ? "may be left out"
                                                       : "needed";
  std::string words = words_of(key);
  if (!key.when.empty()) {
    words += fmt::format("{}({})", words.empty() ? "" : " ", fmt::join(key.when, "; "));
  }
  return fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.key, cell(key.type), cell(key.unit),
                     cell(otherwise), cell(bounds_of(key)), cell(words));
}

std::string section_of(const KeySection& section) {
  std::vector<std::string> tables;
  for (const KnownKey& key : section.keys) {
    if (std::find(tables.begin(), tables.end(), key.table) == tables.end()) {
      tables.push_back(key.table);
    }
  }
  std::sort(tables.begin(), tables.end());
  std::string text = fmt::format(
      "## {}\n", section.protocol.empty() ? std::string("Every protocol")
                                          : fmt::format("protocol = \"{}\"", section.protocol));
  for (const std::string& table : tables) {
    text += fmt::format(
        "\n### {}\n\n| key | type | unit | if left out | allowed | what it is |\n"
        "| --- | --- | --- | --- | --- | --- |\n",
        table.empty() ? "outside of tables" : heading_of(table));
    for (const KnownKey& key : section.keys) {
      text += key.table == table ? row_of(key) : "";
    }
  }
  return text;
}

}  // namespace

std::string found_keys(const std::vector<KeySection>& sections) {
  std::string text;
  for (const KeySection& section : sections) {
    for (const KnownKey& key : section.keys) {
      text += fmt::format(
          "{}{}{}: {}; {}\n", section.protocol.empty() ? "" : section.protocol + ": ", key.path(),
          key.unit.empty() ? "" : fmt::format(" [{}]", key.unit), words_of(key), bounds_of(key));
    }
  }
  return text;
}

std::string key_page(const std::vector<KeySection>& sections) {
  std::string text =
      "# Every key of a definition\n\n"
      "This page is generated: `haptrial keys` prints what the program's own readers ask for, with "
      "the type, unit and bounds that they check. NAME stands for a name of your choice. Tables of "
      "machines may stand in a [lab file](guide-experimenter.md#a-lab-file), which the definition "
      "names with `use` in `[lab]`. Where a table of trials takes a number, a text with a "
      "[formula](guide-own-experiment.md#numbers-names-and-formulas) may stand if the type says "
      "\"or text\". `[procedure]` has the keys of `[[procedures]]` and of their `tracks`, too, and "
      "`[response]` those of `[[responses]]`.\n";
  for (const KeySection& section : sections) {
    text += "\n" + section_of(section);
  }
  return text;
}

}  // namespace haptrial::experiments
