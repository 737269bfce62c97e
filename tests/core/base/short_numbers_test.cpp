#include "core/base/short_numbers.h"

#include <gtest/gtest.h>

namespace haptrial::short_numbers_test {
namespace {

TEST(ShortNumbersTest, NumbersHaveFourDigitsAndWordsStayAsTheyAre) {
  EXPECT_EQ(short_numbers("3.1415926536000001"), "3.142");
  EXPECT_EQ(short_numbers("left, 0.30000000000000004, 2b"), "left, 0.3, 2b");
  EXPECT_EQ(short_numbers("plain"), "plain");
  EXPECT_EQ(short_numbers(""), "");
}

}  // namespace
}  // namespace haptrial::short_numbers_test
