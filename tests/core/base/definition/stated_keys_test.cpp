#include "core/base/definition/stated_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/base/definition/given_values.h"
#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (const StatedKey& each : stated_keys(text, "keys.toml")) {
    lines.push_back(std::to_string(each.line) + " " + each.key +
                    (each.table ? "" : " = " + each.value));
  }
  return lines;
}

TEST(StatedKeysTest, KeysStandInTheOrderOfTheText) {
  EXPECT_THAT(
      lines_of("seed = 7\n"
               "[experiment]  # a remark\n"
               "rate = 1e3\n"
               "name = 'a # b'\n"
               "[[stages]]\n"
               "until = { time = 2.5, inside = \"start\" }\n"
               "name = \"feel\"\n"
               "[[stages]]\n"
               "show = [\n  \"hand\", # seen\n]\n"
               "[fields.floor]\n"
               "at.x = 1.0\n"),
      testing::ElementsAre(
          "1 seed = 7", "2 experiment", "3 experiment.rate = 1e3", "4 experiment.name = 'a # b'",
          "5 stages.feel", "6 stages.feel.until", "6 stages.feel.until.time = 2.5",
          "6 stages.feel.until.inside = \"start\"", "7 stages.feel.name = \"feel\"", "8 stages.2",
          "9 stages.2.show = [\n  \"hand\", # seen\n]", "12 fields", "12 fields.floor",
          "13 fields.floor.at", "13 fields.floor.at.x = 1.0"));
}

TEST(StatedKeysTest, EntriesOfOneNameHaveNumbers) {
  EXPECT_THAT(lines_of("[[a]]\nname = \"x\"\n[[a]]\nname = \"x\"\n[[a]]\nname = \"y.z\"\n"),
              testing::ElementsAre("1 a.1", "2 a.1.name = \"x\"", "3 a.2", "4 a.2.name = \"x\"",
                                   "5 a.3", "6 a.3.name = \"y.z\""));
}

TEST(StatedKeysTest, ATextThatIsNoTomlIsASentence) {
  EXPECT_THROW(stated_keys("a = \n", "keys.toml"), InputError);
}

/// Each key of every shipped definition can be given, and its own value changes nothing.
TEST(StatedKeysTest, AKeyThatIsGivenItsOwnValueLeavesEveryByte) {
  std::size_t keys = 0;
  for (const auto& file : std::filesystem::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    if (file.path().extension() != ".toml") {
      continue;
    }
    const std::string text = file_text(file.path());
    for (const StatedKey& each : stated_keys(text, "shipped")) {
      if (!each.table && each.value.find('\n') == std::string::npos) {
        const GivenKey same{each.key, each.value};
        EXPECT_EQ(with_values(text, "shipped", std::span(&same, 1)), text) << each.key;
        ++keys;
      }
    }
  }
  EXPECT_GT(keys, 800u);
}

}  // namespace
}  // namespace haptrial
