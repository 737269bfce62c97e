#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "core/base/definition/table.h"
#include "core/base/definition/table_vector.h"
#include "tests/support/message_of.h"

namespace haptrial {
namespace {

using testing::HasSubstr;

TEST(TableRowsTest, NumbersAndTextsStandSideBySide) {
  Table table = Table::parse("a = [1, \"$x\", 2.5]\nm = [[1, 2], [\"y\", 3]]\n", "x.toml");
  const auto row = table.rows("a", "");
  ASSERT_EQ(row.size(), 1u);
  ASSERT_EQ(row[0].size(), 3u);
  EXPECT_EQ(row[0][0].number, 1.0);
  EXPECT_EQ(row[0][1].number, std::nullopt);
  EXPECT_EQ(row[0][1].text, "$x");
  EXPECT_EQ(row[0][2].number, 2.5);
  const auto rows = table.rows("m", "");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1][0].text, "y");
  EXPECT_EQ(rows[1][1].number, 3.0);
  EXPECT_NO_THROW(table.finish());
}

TEST(TableRowsTest, OtherEntriesAreNoted) {
  Table table = Table::parse("a = [1, true]\nb = []\nc = 3\nd = [[1], 2]\n", "x.toml");
  for (const char* key : {"a", "b", "c", "d", "e"}) {
    table.rows(key, "rows");
  }
  const std::string told = test::message_of([&] { table.finish(); });
  EXPECT_THAT(told, HasSubstr("x.toml:1: a is an array with true; allowed: rows"));
  EXPECT_THAT(told, HasSubstr("x.toml:2: b is an empty array; allowed: rows"));
  EXPECT_THAT(told, HasSubstr("x.toml:3: c is 3; allowed: rows"));
  EXPECT_THAT(told, HasSubstr("x.toml:4: d is an array with 2; allowed: rows"));
  EXPECT_THAT(told, HasSubstr("e is missing; allowed: rows"));
}

TEST(TableRowsTest, TextsAreFoundAtAnyDepth) {
  Table table = Table::parse(
      "a = 1\nb = \"$x\"\nc = [1, \"$x\"]\nd = [[1], [2, \"$x\"]]\ne = [[1]]\n", "x.toml");
  EXPECT_FALSE(table.has_text("a"));
  EXPECT_TRUE(table.has_text("b"));
  EXPECT_TRUE(table.has_text("c"));
  EXPECT_TRUE(table.has_text("d"));
  EXPECT_FALSE(table.has_text("e"));
  EXPECT_FALSE(table.has_text("absent"));
  EXPECT_EQ(table.whole_text("a"), std::nullopt);
  EXPECT_EQ(table.whole_text("b"), "$x");
  EXPECT_EQ(table.whole_text("c"), std::nullopt);
}

TEST(TableVectorTest, ReadsThreeNumbers) {
  Table table = Table::parse("a = [1, -2.5, 0]\nd = [0, 0, -0.5]\n", "x.toml");
  EXPECT_EQ(read_vector(table, "a", {-3.0, 3.0}, "m"), Eigen::Vector3d(1.0, -2.5, 0.0));
  EXPECT_EQ(read_direction(table, "d"), Eigen::Vector3d(0.0, 0.0, -1.0));
  EXPECT_NO_THROW(table.finish());
}

TEST(TableVectorTest, NotesWhatIsNoVector) {
  Table table = Table::parse("a = [1, 2]\nz = [0, 0, 0]\n", "x.toml");
  EXPECT_EQ(read_vector(table, "a", {}, "m", {7.0, 8.0, 9.0}), Eigen::Vector3d(7.0, 8.0, 9.0));
  EXPECT_EQ(read_direction(table, "z"), Eigen::Vector3d::UnitY());
  const std::string told = test::message_of([&] { table.finish(); });
  EXPECT_THAT(told,
              HasSubstr("x.toml:1: a is a list of 2 numbers; allowed: three numbers: x, y, z"));
  EXPECT_THAT(told, HasSubstr("x.toml:2: z is zero; write a direction"));
}

TEST(TableVectorTest, NotesNumbersOutOfBounds) {
  Table table = Table::parse("a = [1, 2, 3]\n", "x.toml");
  read_vector(table, "a", {-2.0, 2.0}, "m");
  EXPECT_THAT(test::message_of([&] { table.finish(); }), HasSubstr("at most 2 [m]"));
}

}  // namespace

}  // namespace haptrial
