// The list of every key is what the readers ask for, each key with its words.

#include "experiments/command/keys/key_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>

#include "core/base/files/file_text.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/command.h"

namespace haptrial::experiments::keys_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(KeysTest, EveryKeyHasItsWordsAndNoOthersAreThere) {
  EXPECT_THAT(mistakes_of_key_words(), IsEmpty());
}

/// With HAPTRIAL_WRITE_PAGES=1 in the environment the page is written anew.
TEST(KeysTest, ThePageIsWhatTheProgramPrints) {
  const fs::path page = HAPTRIAL_SOURCE_DIR "/docs/keys.md";
  const std::string text = key_page(key_sections(""));
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
  const auto none = test::run_command("haptrial keys nothing");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("PROTOCOL is 'nothing'; allowed: force_training"));
}

const std::vector<std::string>& parts_of(const std::string& path) {
  static std::map<std::string, std::vector<std::string>> known;  // asked for again and again
  const auto [found, is_new] = known.try_emplace(path);
  if (is_new) {
    std::istringstream in(path);
    for (std::string part; std::getline(in, part, '.');) {
      found->second.push_back(part);
    }
  }
  return found->second;
}

/// Whether a path of a definition is that of a key, or of what a key holds.
bool is_key(const std::string& path, const KnownKey& key) {
  const auto& found = parts_of(path);
  const auto& known = parts_of(key.path());
  if (known.size() > found.size()) {
    return false;
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    if (known[i] != found[i] && known[i] != "NAME") {
      return false;
    }
  }
  const bool holds = key.type.find('{') != std::string::npos || key.type == "table";
  return known.size() == found.size() || holds;
}

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

std::vector<KnownKey> keys_of(const std::string& protocol) {
  std::vector<KnownKey> keys;
  for (const KeySection& section : key_sections(protocol)) {
    for (const ListedKey& listed : section.keys) {
      keys.push_back(listed.key);
    }
  }
  return keys;
}

TEST(KeysTest, EveryKeyOfTheShippedDefinitionsIsListed) {
  int checked = 0;
  std::map<std::string, std::vector<KnownKey>> of_protocols;  // each takes seconds
  for (const auto& entry : fs::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    const bool translation = entry.path().stem().string().find(".texts.") != std::string::npos;
    if (entry.path().extension() != ".toml" || translation) {
      continue;
    }
    const toml::table root = toml::parse_file(entry.path().string());
    const std::string protocol =
        root["experiment"]["protocol"].value_or(std::string("force_training"));
    std::vector<KnownKey>& keys = of_protocols[protocol];
    if (keys.empty()) {
      keys = keys_of(protocol);
    }
    std::vector<std::string> paths;
    flatten(root, "", paths);
    for (std::string path : paths) {
      path = replaced(path, "procedures[].tracks[]", "procedure");
      path = replaced(path, "procedure.tracks[]", "procedure");
      path = replaced(path, "procedures[]", "procedure");
      path = replaced(path, "responses[]", "response");
      EXPECT_TRUE(std::any_of(keys.begin(), keys.end(),
                              [&](const KnownKey& key) { return is_key(path, key); }))
          << entry.path().filename() << ": " << path;
      ++checked;
    }
  }
  EXPECT_GT(checked, 500);
}

}  // namespace
}  // namespace haptrial::experiments::keys_test
