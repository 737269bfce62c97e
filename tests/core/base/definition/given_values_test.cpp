#include "core/base/definition/given_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/definition/table.h"
#include "core/base/error.h"

namespace haptrial {
namespace {

using testing::HasSubstr;

constexpr const char* kText = R"(# a heading: 20 µm
[design]
participants = 12  # µm: people

[observer]
lapse = { median = 0.02, spread = 0.3 }
noise = 0.1
[[blocks]]
name = "easy"
shift = 0.0
[[blocks]]
name = "hard"
)";

std::string given(const std::string& key, const std::string& value) {
  const GivenKey one{key, value};
  return with_values(kText, "a.toml", std::span(&one, 1));
}

TEST(GivenValues, ReplaceAValueAndNothingElse) {
  const std::string before = kText;
  std::string after = given("design.participants", "24");
  EXPECT_THAT(after, HasSubstr("participants = 24  # µm: people\n"));
  EXPECT_EQ(after.replace(after.find("24"), 2, "12"), before);
  EXPECT_THAT(given("observer.lapse.spread", "0.5"),
              HasSubstr("lapse = { median = 0.02, spread = 0.5 }\n"));
  EXPECT_THAT(given("observer.lapse", "0.04"), HasSubstr("[observer]\nlapse = 0.04\n"));
}

TEST(GivenValues, AddKeysAndTablesThatAreNotThere) {
  Table root = Table::parse(given("observer.drift", "0.01"), "a.toml");
  EXPECT_EQ(root.table("observer").number("drift", {}, ""), 0.01);
  EXPECT_EQ(root.table("observer").number("noise", {}, ""), 0.1);
  root = Table::parse(given("observer.lapse.more", "3"), "a.toml");
  EXPECT_EQ(root.table("observer").table("lapse").integer("more", 0, 9), 3);
  root = Table::parse(given("device.delay", "2"), "a.toml");
  EXPECT_EQ(root.table("device").integer("delay", 0, 9), 2);
}

TEST(GivenValues, FindATableOfAnArrayByNameOrNumber) {
  for (const char* key : {"blocks.hard.shift", "blocks.2.shift"}) {
    Table root = Table::parse(given(key, "0.5"), "a.toml");
    EXPECT_EQ(root.tables("blocks")[1].number("shift", {}, ""), 0.5) << key;
    EXPECT_EQ(root.tables("blocks")[0].number("shift", {}, ""), 0.0) << key;
  }
}

TEST(GivenValues, RefuseKeysThatLeadNowhere) {
  EXPECT_THROW(given("blocks.third.shift", "1"), InputError);
  EXPECT_THROW(given("blocks.hard", "1"), InputError);
  EXPECT_THROW(given("observer.noise.spread", "1"), InputError);
  EXPECT_THROW(given("observer", "1"), InputError);
}

}  // namespace
}  // namespace haptrial
