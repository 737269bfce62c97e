// The list of every key is what the readers ask for, each key with its words.

#include "experiments/command/start/key_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "core/base/file_text.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/command.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::experiments::keys_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// All tests of this suite share one list, which takes seconds to make.
const std::vector<KeySection>& every_section() {
  static const auto sections = key_sections("");
  return sections;
}

TEST(KeysTest, EveryKeyIsDescribedByItsReader) {
  for (const KeySection& section : every_section()) {
    for (const KnownKey& key : section.keys) {
      EXPECT_FALSE(key.words.empty()) << section.protocol << ':' << key.path();
      EXPECT_FALSE(key.optional && key.otherwise.empty()) << section.protocol << ':' << key.path();
    }
  }
}

/// With HAPTRIAL_WRITE_PAGES=1 in the environment the page is written anew.
TEST(KeysTest, ThePageIsWhatTheProgramPrints) {
  const fs::path page = HAPTRIAL_SOURCE_DIR "/docs/keys.md";
  const std::string text = key_page(every_section());
  if (std::getenv("HAPTRIAL_WRITE_PAGES") != nullptr) {
    write_text(page, text);
  }
  EXPECT_EQ(file_text(page), text)
      << "write docs/keys.md anew: HAPTRIAL_WRITE_PAGES=1 build/test_experiments "
         "--gtest_filter='KeysTest.*'";
}

TEST(KeysTest, TheCommandPrintsOneProtocolOrAll) {
  const auto trials = test::run_command("haptrial keys trials");
  ASSERT_EQ(trials.status, 0) << trials.errors;
  EXPECT_THAT(trials.output, HasSubstr("| `max_jump` | number | m | "));
  EXPECT_THAT(trials.output, HasSubstr("protocol = \"trials\""));
  EXPECT_THAT(trials.output, Not(HasSubstr("protocol = \"bone_drilling\"")));
  const auto none = test::run_command("haptrial keys xyzzy");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("no key has 'xyzzy' in its name or its words"));
}

TEST(KeysTest, AWordFindsKeysByNameAndByWhatTheyAre) {
  const auto found = test::run_command("haptrial keys Stiffness");
  ASSERT_EQ(found.status, 0) << found.errors;
  EXPECT_THAT(found.output, HasSubstr("fields.NAME.stiffness [N/m]"));
  EXPECT_THAT(found.output, HasSubstr("hand.stiffness"));
  EXPECT_THAT(found.output, Not(HasSubstr("max_jump")));
  EXPECT_LT(std::count(found.output.begin(), found.output.end(), '\n'), 100);
}

/// Defaults that docs/devices.md states, by the path of their keys; empty for none.
std::map<std::string, std::string> defaults_of_devices_page() {
  const std::map<std::string, std::vector<std::string>> tables{
      {"## Force Dimension", {"force_dimension"}},
      {"## OpenHaptics", {"open_haptics"}},
      {"## Haply", {"haply"}},
      {"## Boards on a serial line", {"hapi", "paddle"}},
      {"### hAPI", {"hapi"}},
      {"### Paddles", {"paddle"}},
      {"## Mouse", {"mouse"}},
      {"## Game controller", {"gamepad"}},
      {"## Pedal", {"pedal"}}};
  std::istringstream page(file_text(HAPTRIAL_SOURCE_DIR "/docs/devices.md"));
  std::vector<std::string> current;
  std::map<std::string, std::string> defaults;
  for (std::string line; std::getline(page, line);) {
    if (line.starts_with("#")) {
      current = tables.contains(line) ? tables.at(line) : std::vector<std::string>{};
    }
    const std::size_t end = line.starts_with("| `") ? line.find('|', 1) : std::string::npos;
    if (end == std::string::npos) {
      continue;
    }
    std::string value = line.substr(end + 1, line.find('|', end + 1) - end - 1);
    value.erase(0, value.find_first_not_of(' '));
    for (std::size_t begin = line.find('`'); begin < end; begin = line.find('`', begin + 1)) {
      const std::size_t close = line.find('`', begin + 1);
      for (const std::string& table : current) {
        defaults[table + "." + line.substr(begin + 1, close - begin - 1)] = value;
      }
      begin = close;
    }
  }
  return defaults;
}

TEST(KeysTest, AKeyOfADeviceMayBeLeftOutWhereItsPageStatesADefault) {
  const std::map<std::string, std::string> stated = defaults_of_devices_page();
  std::size_t found = 0;
  for (const KeySection& section : every_section()) {
    for (const KnownKey& key : section.keys) {
      const auto at = stated.find(key.path());
      if (at == stated.end()) {
        continue;
      }
      ++found;
      EXPECT_EQ(key.optional, !at->second.empty()) << key.path();
      const bool one_number = at->second.find(", ") == std::string::npos &&
                              at->second.find_first_of("0123456789-") == 0;
      if (one_number) {
        EXPECT_EQ(std::stod(at->second), std::stod(key.otherwise)) << key.path();
      }
    }
  }
  EXPECT_EQ(found, stated.size());
  EXPECT_GT(found, 50u);
}

std::vector<std::string> parts_of(const std::string& path) {
  std::istringstream in(path);
  std::vector<std::string> parts;
  for (std::string part; std::getline(in, part, '.');) {
    parts.push_back(part);
  }
  return parts;
}

/// A key of the list; one that is a table stands for what it holds.
struct ListedPath {
  explicit ListedPath(const KnownKey& key)
      : parts(parts_of(key.path())),
        holds(key.type.find('{') != std::string::npos || key.type == "table") {}
  bool has(const std::vector<std::string>& path) const {
    return (parts.size() == path.size() || (holds && parts.size() < path.size())) &&
           std::equal(parts.begin(), parts.end(), path.begin(),
                      [](const auto& known, const auto& found) {
                        return known == found || known == "NAME";
                      });
  }

  std::vector<std::string> parts;
  bool holds;
};

void flatten(const toml::table& table, const std::string& path, std::vector<std::string>& into) {
  for (const auto& [key, value] : table) {
    const std::string name = path.empty() ? std::string(key.str()) : path + "." + std::string(key);
    if (const auto* inner = value.as_table()) {
      flatten(*inner, name, into);
    } else if (const auto* array = value.as_array(); array && array->is_array_of_tables()) {
      array->for_each([&](const auto& each) {
        if constexpr (toml::is_table<decltype(each)>) {
          flatten(each, name + "[]", into);
        }
      });
    } else {
      into.push_back(name);
    }
  }
}

std::string replaced(std::string path, const std::string& what, const std::string& instead) {
  return path.starts_with(what) ? instead + path.substr(what.size()) : path;
}

TEST(KeysTest, EveryKeyOfTheShippedDefinitionsIsListed) {
  std::map<std::string, std::vector<ListedPath>> listed;  // of each protocol; "": of all
  for (const KeySection& section : every_section()) {
    for (const KnownKey& each : section.keys) {
      listed[section.protocol].emplace_back(each);
    }
  }
  int checked = 0;
  for (const auto& entry : fs::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    const bool translation = entry.path().stem().string().find(".texts.") != std::string::npos;
    if (entry.path().extension() != ".toml" || translation) {
      continue;
    }
    const toml::table root = toml::parse_file(entry.path().string());
    const std::string protocol =
        root["experiment"]["protocol"].value_or(std::string("force_training"));
    std::vector<std::string> paths;
    flatten(root, "", paths);
    for (std::string path : paths) {
      path = replaced(path, "procedures[].tracks[]", "procedure");
      path = replaced(path, "procedure.tracks[]", "procedure");
      path = replaced(path, "procedures[]", "procedure");
      path = replaced(path, "responses[]", "response");
      const auto has = [parts = parts_of(path)](const ListedPath& key) { return key.has(parts); };
      EXPECT_TRUE(std::ranges::any_of(listed[protocol], has) ||
                  std::ranges::any_of(listed[""], has))
          << entry.path().filename() << ": " << path;
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

/// The command's output, made once for each protocol.
const std::string& schema_of(const std::string& protocol) {
  static std::map<std::string, std::string> schemas;
  const auto [at, is_new] = schemas.try_emplace(protocol);
  if (is_new) {
    const auto printed = test::run_command("haptrial keys " + protocol + " --json-schema");
    EXPECT_EQ(printed.status, 0) << printed.errors;
    at->second = printed.output;
  }
  return at->second;
}

/// Errors that Debian's python3-jsonschema finds in a definition; empty: it keeps the schema.
std::string schema_errors(const test::TemporaryFolder& folder, const std::string& definition) {
  const std::string protocol =
      toml::parse(definition)["experiment"]["protocol"].value_or(std::string("force_training"));
  const fs::path schema = folder / (protocol + ".json");
  write_text(schema, schema_of(protocol));
  write_text(folder / "definition.toml", definition);
  const auto checked = test::run_command(
      "/usr/bin/python3 -B " HAPTRIAL_SOURCE_DIR "/tests/experiments/check_json_schema.py '" +
      schema.string() + "' '" + (folder / "definition.toml").string() + "'");
  EXPECT_EQ(checked.errors, "");
  return checked.output;
}

TEST(KeysTest, ShippedDefinitionsKeepTheJsonSchema) {
  const test::TemporaryFolder folder;
  int checked = 0;
  for (const auto& entry : fs::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    const bool translation = entry.path().stem().string().find(".texts.") != std::string::npos;
    if (entry.path().extension() == ".toml" && !translation) {
      EXPECT_EQ(schema_errors(folder, file_text(entry.path())), "") << entry.path().filename();
      ++checked;
    }
  }
  EXPECT_GT(checked, 15);
}

TEST(KeysTest, TheJsonSchemaFindsMistakes) {
  const test::TemporaryFolder folder;
  const std::string text =
      file_text(HAPTRIAL_SOURCE_DIR "/experiments/stiffness_discrimination.toml");
  const auto errors_with = [&](const std::string& before, const std::string& after) {
    std::string changed = text;
    const std::size_t at = changed.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return schema_errors(folder, changed.replace(at, before.size(), after));
  };
  EXPECT_THAT(errors_with("[design]\n", "[design]\nparticipents = 3\n"), HasSubstr("participents"));
  EXPECT_THAT(errors_with("break_duration = 60.0", "break_duration = \"long\""),
              HasSubstr("design.break_duration"));
  EXPECT_THAT(errors_with("[response]\n", "[response]\ntouch_for = -1\n"),
              HasSubstr("response.touch_for"));
}

TEST(KeysTest, PsychophysicsIsAnotherWordForTrials) {
  std::string text = file_text(HAPTRIAL_SOURCE_DIR "/experiments/wall_detection.toml");
  const std::string word = "protocol = \"trials\"";
  ASSERT_NE(text.find(word), std::string::npos);
  const test::TemporaryFolder folder;
  write_text(folder / "own.toml",
             text.replace(text.find(word), word.size(), "protocol = \"psychophysics\""));
  EXPECT_EQ(schema_errors(folder, text), "");
  const auto run = test::run_command("cd '" + folder.path().string() +
                                     "' && haptrial dry-run own.toml --subjects 1 --out out && "
                                     "haptrial analyze out");
  EXPECT_EQ(run.status, 0) << run.errors;
  EXPECT_TRUE(fs::exists(folder / "out/report.html"));
}

TEST(KeysTest, AJsonSchemaNeedsAProtocol) {
  const auto none = test::run_command("haptrial keys --json-schema");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("--json-schema: no word is not a protocol; allowed: "));
}

}  // namespace
}  // namespace haptrial::experiments::keys_test
