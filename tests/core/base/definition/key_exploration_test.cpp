#include "core/base/definition/key_exploration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial::key_exploration_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A reader as readers are: keys that may be left out, ways that part, a mistake of its own.
void read(Table& root) {
  Table loop = root.table("loop");
  loop.number("rate", {100.0, 8000.0}, "Hz");
  if (loop.has("name")) {
    loop.text("name");
  } else {
    loop.integer("number", 1, 9);
  }
  for (Table& field : root.tables("fields")) {
    const std::string type = field.choice("type", {"wall", "ball", "none"});
    if (type == "wall") {
      field.numbers("point", {}, "m");
    } else if (type == "ball") {
      if (field.boolean("soft")) {
        field.number("depth", kPositive, "m");
      }
      throw InputError("what comes later is not read");
    }
    field.otherwise("damping", 0.5);
    if (field.has("damping")) {
      field.number("damping", kNonNegative, "N·s/m");
    }
  }
  if (root.has("names")) {
    Table names = root.table("names");
    for (const std::string& name : names.keys()) {
      names.number(name, {}, "");
    }
  }
}

std::vector<std::string> paths(const std::vector<KnownKey>& keys) {
  std::vector<std::string> all;
  for (const KnownKey& key : keys) {
    all.push_back(key.path());
  }
  std::sort(all.begin(), all.end());
  return all;
}

KnownKey found(const std::vector<KnownKey>& keys, const std::string& path) {
  const auto at = std::find_if(keys.begin(), keys.end(),
                               [&](const KnownKey& key) { return key.path() == path; });
  return at != keys.end() ? *at : KnownKey{};
}

TEST(KeyExplorationTest, FindsEveryKeyOnEveryWay) {
  EXPECT_THAT(paths(known_keys("[loop]\nrate = 1000.0\n", read)),
              ElementsAre("fields[].damping", "fields[].depth", "fields[].point", "fields[].soft",
                          "fields[].type", "loop.name", "loop.number", "loop.rate", "names.NAME"));
}

/// Each choice is varied alone: that a key was never seen with another scale does not make it one
/// of that scale.
TEST(KeyExplorationTest, AChoiceThatNobodyVariedBindsNothing) {
  const auto reader = [](Table& root) {
    Table track = root.table("track");
    const std::string scale = track.choice("scale", {"linear", "log"});
    const std::string kind = track.choice("kind", {"steps", "pest"});
    if (kind == "pest") {
      track.number("target", kPositive, "");
    }
    if (scale == "log") {
      track.number("origin", {}, "");
    }
  };
  const auto keys = known_keys("[other]\n", reader);
  EXPECT_THAT(found(keys, "track.target").when, ElementsAre("kind: pest"));
  EXPECT_THAT(found(keys, "track.origin").when, ElementsAre("scale: log"));
}

TEST(KeyExplorationTest, SaysWhatTheReaderSays) {
  const auto keys = known_keys("[loop]\nrate = 1000.0\n", read);
  const KnownKey rate = found(keys, "loop.rate");
  EXPECT_EQ(rate.type, "number");
  EXPECT_EQ(rate.unit, "Hz");
  EXPECT_EQ(rate.otherwise, "1000.0");  // as the text has it
  EXPECT_EQ(rate.allowed, "a number of at least 100 and at most 8000 [Hz]");
  const KnownKey damping = found(keys, "fields[].damping");
  EXPECT_TRUE(damping.optional);
  EXPECT_EQ(damping.otherwise, "0.5");
  EXPECT_EQ(found(keys, "fields[].type").type, "choice");
  EXPECT_FALSE(found(keys, "fields[].type").optional);
  EXPECT_THAT(found(keys, "fields[].point").when, ElementsAre("type: wall"));
  EXPECT_THAT(found(keys, "fields[].type").when, IsEmpty());
}

TEST(KeyExplorationTest, ADefinitionThatIsReadIsNotExplored) {
  Table root = Table::parse("[loop]\nname = \"x\"\n", "small.toml");
  Table loop = root.table("loop");
  loop.otherwise("rate", 1.0);
  EXPECT_FALSE(loop.has("rate"));
  EXPECT_TRUE(loop.has("name"));
}

}  // namespace
}  // namespace haptrial::key_exploration_test
