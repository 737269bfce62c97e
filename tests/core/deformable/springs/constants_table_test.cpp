#include "core/deformable/springs/constants_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "tests/support/message_of.h"
#include "tests/support/solid_block.h"

namespace haptrial::deformable::constants_table_test {
namespace {

using testing::HasSubstr;

SpringBody small_body() {
  return spring_body(test::solid_block({2, 1, 1}, 0.01), 1000.0, {0.5, 0.25, 2.0});
}

TEST(ConstantsTableTest, WhatIsWrittenIsRead) {
  SpringBody body = small_body();
  body.constants.length[3] = 1.25e-7;
  body.constants.volume.back() = 0.0;
  const SpringConstants again =
      parse_constants(constants_csv(body, body.constants), "constants.csv", body);
  EXPECT_EQ(again.length, body.constants.length);
  EXPECT_EQ(again.area, body.constants.area);
  EXPECT_EQ(again.volume, body.constants.volume);
}

TEST(ConstantsTableTest, ATableOfAnotherBodyIsToldWithItsLine) {
  const SpringBody body = small_body();
  const std::string good = constants_csv(body, body.constants);
  const auto told = [&](const std::string& text) {
    return test::message_of([&] { parse_constants(text, "c.csv", body); });
  };
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return told(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_THAT(told("kind,number\n"), HasSubstr("c.csv: begins with 'kind,number'"));
  EXPECT_THAT(changed("length,4,", "length,5,"),
              HasSubstr("c.csv:7: 'length,5,0.5' stands where 'length,4,'"));
  EXPECT_THAT(changed("length,4,0.5", "length,4,half"), HasSubstr("c.csv:7: 'half' is no number"));
  EXPECT_THAT(changed("length,4,0.5", "length,4,-1"), HasSubstr("at least 0 is allowed"));
  EXPECT_THAT(told(good + "volume,10,1\n"), HasSubstr("goes on after line"));
  EXPECT_THAT(told(good.substr(0, good.size() - 12)), HasSubstr("springs of volume"));
}

/// Twice as large, a body has as many springs, and other constants.
TEST(ConstantsTableTest, ABodyOfAnotherSizeIsTold) {
  const SpringBody body = small_body();
  const SpringBody larger =
      spring_body(test::solid_block({2, 1, 1}, 0.02), 1000.0, {0.5, 0.25, 2.0});
  const std::string table = constants_csv(body, body.constants);
  EXPECT_THAT(test::message_of([&] { parse_constants(table, "c.csv", larger); }),
              HasSubstr("c.csv: has the constants of a body of volume 2e-06 m3, "));
  const std::string older = table.substr(table.find('\n') + 1);
  EXPECT_EQ(parse_constants(older, "c.csv", larger).length, body.constants.length);
}

}  // namespace
}  // namespace haptrial::deformable::constants_table_test
