// Trials in which something is given, and the names of their conditions.

#include "core/base/definition/given_in.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/table.h"
#include "tests/support/message_of.h"

namespace haptrial {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

GivenIn read(const std::string& line) {
  Table root = Table::parse("[hints]\n" + line, "study.toml");
  Table table = root.table("hints");
  const GivenIn in = read_given_in(table, "shown_in");
  root.finish();
  return in;
}

TEST(GivenInTest, IsReadFromAWord) {
  EXPECT_EQ(read(""), GivenIn{GivenIn::kAll});
  EXPECT_EQ(read("shown_in = \"none\"\n"), GivenIn{GivenIn::kNone});
  EXPECT_EQ(read("shown_in = \"every other\"\n"), GivenIn{GivenIn::kEveryOther});
  EXPECT_EQ(read("shown_in = [\"a\", \"b\"]\n"), (GivenIn{GivenIn::kAll, {"a", "b"}}));
  EXPECT_THAT(test::message_of([] { read("shown_in = []\n"); }), HasSubstr("is an empty array"));
  EXPECT_THAT(test::message_of([] { read("shown_in = \"some\"\n"); }), HasSubstr("every other"));
}

TEST(GivenInTest, EveryOtherTrialBeginsWithTheFirstParticipantsFirst) {
  for (int participant = 0; participant < 4; ++participant) {
    int given = 0;
    for (int trial = 1; trial <= 4; ++trial) {
      given += is_given({GivenIn::kEveryOther}, {trial, participant}) ? 1 : 0;
      EXPECT_TRUE(is_given({GivenIn::kAll}, {trial, participant}));
      EXPECT_FALSE(is_given({GivenIn::kNone}, {trial, participant}));
    }
    EXPECT_EQ(given, 2);
    EXPECT_EQ(is_given({GivenIn::kEveryOther}, {1, participant}), participant % 2 == 0);
  }
}

TEST(GivenInTest, GroupsHaveItInEveryTrial) {
  const GivenIn in{GivenIn::kAll, {"hints", "both"}};
  EXPECT_TRUE(is_given(in, {1, 3, "hints"}));
  EXPECT_TRUE(is_given(in, {2, 3, "both"}));
  EXPECT_FALSE(is_given(in, {2, 3, "alone"}));
  EXPECT_FALSE(is_given(in, {2, 3}));
  EXPECT_THAT(given_words("hints", in), ElementsAre("hints on", "hints off"));
  EXPECT_THAT(given_words("hints", {}, true), ElementsAre("hints on", "hints off"));
  EXPECT_EQ(given_text(in, "procedure"), "in every procedure of the groups hints, both");
}

TEST(GivenInTest, ConditionsOfTwoThingsAreNamedTogetherAndToldApart) {
  EXPECT_THAT(given_words("hints", {GivenIn::kAll}), ElementsAre("hints on"));
  const auto monitor = given_words("monitor", {GivenIn::kNone});
  const auto hints = given_words("hints", {GivenIn::kEveryOther});
  EXPECT_THAT(joined_words(monitor, hints),
              ElementsAre("monitor off, hints on", "monitor off, hints off"));
  EXPECT_EQ(joined_words({}, hints), hints);
  EXPECT_TRUE(says_off("monitor off, hints on", "monitor"));
  EXPECT_FALSE(says_off("monitor off, hints on", "hints"));
  EXPECT_TRUE(says_off("monitor on, hints off", "hints"));
  EXPECT_FALSE(says_off("drilling", "hints"));
  EXPECT_FALSE(says_off("more hints off", "hints")) << "a word of its own";
}

}  // namespace
}  // namespace haptrial
