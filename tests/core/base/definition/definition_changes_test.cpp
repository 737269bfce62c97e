#include "core/base/definition/definition_changes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace haptrial {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> keys(const std::vector<DefinitionChange>& changes) {
  std::vector<std::string> all;
  for (const DefinitionChange& change : changes) {
    all.push_back(change.key);
  }
  return all;
}

const DefinitionRules kRules{{"texts", "screen", "design.participants", "machine"},
                             {{"machine.window", "8"}, {"machine.delay"}},
                             {"groups"}};

DefinitionChanges between(std::string_view before, std::string_view after) {
  return definition_changes(before, after, kRules);
}

TEST(DefinitionChangesTest, CommentsLayoutOrderAndTheFormOfANumberAreNoChanges) {
  const auto changes =
      between("[design]\ntrials = 6  # many\nx = 1\n[gains]\nplane = { b = 2, k = [1, 2.50] }\n",
              "[gains.plane]\nk = [1.0,\n 2.5]\nb = 2.0\n[design]\nx = 1.0\ntrials = 6");
  EXPECT_THAT(changes.binding, IsEmpty());
  EXPECT_THAT(changes.free, IsEmpty());
  EXPECT_FALSE(changes.same_text);
  EXPECT_TRUE(changes.same_study());
  EXPECT_TRUE(between("a = 1", "a = 1").same_text);
}

TEST(DefinitionChangesTest, KeysAreNamedWithBothValues) {
  const auto changes = between("[guidance]\nwait = 0.5\nplane = { damping = 300.0 }\nold = true\n",
                               "[guidance]\nwait = 1\nplane = { damping = 100.0 }\nnew = \"n\"\n");
  EXPECT_EQ(sentence_of(changes.binding),
            "guidance.new was absent, is \"n\"; guidance.old was true, is absent; "
            "guidance.plane.damping was 300, is 100; guidance.wait was 0.5, is 1");
  EXPECT_FALSE(changes.same_study());
}

TEST(DefinitionChangesTest, TablesAndKeysThatTheCallerNamesMayChange) {
  const auto changes = between(
      "[texts]\nrest = \"Time for a rest\"\n[screen]\nmonitor = 0\n[design]\nparticipants = 12\n",
      "[texts]\nrest = \"Time, for a rest\"\n[screen]\nmonitor = 1\n[design]\nparticipants = 18\n"
      "[machine]\nindex = 1\nof = { limit = 2 }\n");
  EXPECT_THAT(changes.binding, IsEmpty());
  EXPECT_THAT(keys(changes.free), ElementsAre("design.participants", "machine.index",
                                              "machine.of.limit", "screen.monitor", "texts.rest"));
  const auto strict = definition_changes("[screen]\nmonitor = 0", "[screen]\nmonitor = 1", {});
  EXPECT_THAT(keys(strict.binding), ElementsAre("screen.monitor"));
}

TEST(DefinitionChangesTest, AKeptKeyMayComeAndGoButNotHaveAnotherValue) {
  const DefinitionRules rules{.free = {"channels"}, .kept = {"channels.*.units"}};
  const auto changes = definition_changes(
      "[channels.a]\nport = 1\nunits.x = \"N\"\nunits.y = \"V\"\n[channels.b]\nunits.x = \"m\"\n",
      "[channels.a]\nport = 2\nunits.x = \"g\"\n[channels.c]\nunits.x = \"m\"\n", rules);
  EXPECT_THAT(keys(changes.binding), ElementsAre("channels.a.units.x"));
  EXPECT_THAT(keys(changes.free), ElementsAre("channels.a.port", "channels.a.units.y",
                                              "channels.b.units.x", "channels.c.units.x"));
}

TEST(DefinitionChangesTest, TheBindingTextIsThatOfTheStudy) {
  const std::string study = "[design]\ntrials = 6\n[machine]\nwindow = 8\n";
  const auto text = [](const std::string& definition) { return binding_text(definition, kRules); };
  EXPECT_EQ(text(study), "design.trials = 6\nmachine.window = 8\n");
  EXPECT_EQ(text("[texts]\nrest = \"a\"\n[machine]\nindex = 2\n[design]\r\ntrials = 6.0\r\n"),
            text(study));
  EXPECT_NE(text("[design]\ntrials = 7\n"), text(study));
}

TEST(DefinitionChangesTest, AKeyOfAFreeTableMayBeBound) {
  const auto changes = between("[machine]\nindex = 0\nwindow = 8\ndelay = 1\n",
                               "[machine]\nindex = 1\nwindow = 9\ndelay = 2\n");
  EXPECT_THAT(keys(changes.free), ElementsAre("machine.index"));
  EXPECT_EQ(sentence_of(changes.binding), "machine.delay was 1, is 2; machine.window was 8, is 9");
}

TEST(DefinitionChangesTest, AKnownDefaultMayBeWrittenOrLeftOut) {
  EXPECT_TRUE(between("[a]\nx = 1", "[a]\nx = 1\n[machine]\nwindow = 8.0").same_study());
  EXPECT_EQ(sentence_of(between("[a]\nx = 1", "[a]\nx = 1\n[machine]\nwindow = 9").binding),
            "machine.window was 8, is 9");
  EXPECT_EQ(sentence_of(between("[a]\nx = 1", "[a]\nx = 1\n[machine]\ndelay = 1").binding),
            "machine.delay was absent, is 1");
}

TEST(DefinitionChangesTest, RulesAddUp) {
  DefinitionRules all{{"a"}};
  all.add({{"b"}, {{"a.x"}}});
  EXPECT_TRUE(all.may_change("a.y"));
  EXPECT_TRUE(all.may_change("b.x"));
  EXPECT_FALSE(all.may_change("a.x"));
  EXPECT_FALSE(all.may_change("ab.y"));
  EXPECT_FALSE(all.may_change("c"));
}

TEST(DefinitionChangesTest, WhatNobodyThoughtOfCounts) {
  EXPECT_FALSE(between("[texts_of_another]\na = 1", "[texts_of_another]\na = 2").same_study());
  EXPECT_FALSE(between("[display]\nfull_scale = 12", "[display]\nfull_scale = 10").same_study());
}

TEST(DefinitionChangesTest, TheOrderOfGroupsCountsForItSaysWhoBelongsWhere) {
  const auto changes =
      between("[groups]\nsurgeons = 4\nnovices = 4", "[groups]\nnovices = 4\nsurgeons = 4");
  EXPECT_EQ(sentence_of(changes.binding), "groups was surgeons, novices, is novices, surgeons");
  EXPECT_TRUE(between("[people]\na = 4\nb = 4", "[people]\nb = 4\na = 4").same_study());
}

TEST(DefinitionChangesTest, LongTextsAreShownWhereTheyPart) {
  const std::string start = "a long beginning that both texts of this test share, and then ";
  const auto changes =
      between("[texts]\nrest = \"" + start + "this\"", "[texts]\nrest = \"" + start + "that\"");
  ASSERT_EQ(changes.free.size(), 1u);
  EXPECT_NE(changes.free[0].before, changes.free[0].after);
  EXPECT_THAT(changes.free[0].before, testing::EndsWith("this\""));
}

TEST(DefinitionChangesTest, LongListsAreCut) {
  std::string before = "[a]\n";
  std::string after = "[a]\n";
  for (int i = 0; i < 12; ++i) {
    const std::string key(1, static_cast<char>('a' + i));
    before += key + " = 0\n";
    after += key + " = 1\n";
  }
  EXPECT_THAT(sentence_of(between(before, after).binding), testing::EndsWith("; and 4 more"));
}

TEST(DefinitionChangesTest, WhatIsNoTomlIsComparedAsItStands) {
  EXPECT_TRUE(between("= not toml", "= not toml").same_study());
  EXPECT_THAT(keys(between("= not toml", "= nor this").binding), ElementsAre("the text"));
  const std::string deep = "a" + std::string(5000, '.') + "b = 1";
  EXPECT_THAT(keys(between(deep, "a = 1").binding), ElementsAre("the text"));
}

TEST(DefinitionChangesTest, ATableHasAFingerprintOfItsValues) {
  const char* text = "[a]\nx = 1\ny = { z = \"w\" }\n[b]\nx = 1\n";
  const auto one = table_fingerprint(text, "a");
  ASSERT_TRUE(one);
  EXPECT_EQ(one, table_fingerprint("[a]  # words\ny = { z = \"w\" }\nx = 1.0\n", "a"));
  EXPECT_NE(one, table_fingerprint("[a]\nx = 1\ny = { z = \"v\" }\n", "a"));
  EXPECT_NE(one, table_fingerprint(text, "b"));
  EXPECT_FALSE(table_fingerprint(text, "c"));
  EXPECT_FALSE(table_fingerprint("[a\nx = ", "a"));
}

TEST(DefinitionValuesTest, AreThoseOfTheNamedTablesAndKeys) {
  const std::vector<std::string> names{"tools", "drilling.scale"};
  const auto values = definition_values(
      "[tools]\nin_hand = [\"a\"]\n[tools.a]\nfalloff = 25.0\n[toolset]\nx = 1\n[drilling]\nscale "
      "= 2\n"
      "other = 1\n",
      names);
  EXPECT_EQ(values,
            (std::map<std::string, std::string>{
                {"tools.in_hand", "[\"a\"]"}, {"tools.a.falloff", "25"}, {"drilling.scale", "2"}}));
}

}  // namespace
}  // namespace haptrial
