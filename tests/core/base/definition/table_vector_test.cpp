#include "core/base/definition/table_vector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/support/message_of.h"

namespace haptrial {
namespace {

using testing::HasSubstr;

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
