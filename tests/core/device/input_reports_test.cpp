// Records of an input device in pieces, with gaps.

#include "core/device/input_file.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/event_records.h"

namespace haptrial::device {
namespace {

TEST(InputReportsTest, ValuesCountFromTheEndOfTheirReportInWhateverPiecesTheyCome) {
  InputReports records;
  std::vector<std::byte> bytes;
  test::add_record(bytes, EV_ABS, ABS_BRAKE, 9);
  test::add_record(bytes, EV_ABS, ABS_GAS, 40);
  test::add_record(bytes, EV_ABS, ABS_GAS, 41);
  const std::size_t open = bytes.size();
  test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
  test::add_record(bytes, EV_ABS, ABS_BRAKE, 10);
  test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    records.take(std::span(bytes).subspan(i, 1));
    EXPECT_EQ(records.axis(ABS_GAS).has_value(), i + 1 >= open + sizeof(input_event)) << i;
  }
  EXPECT_EQ(records.axis(ABS_GAS), 41);
  EXPECT_FALSE(records.take_dropped());
}

TEST(InputReportsTest, WhatStandsAroundDroppedRecordsIsVoid) {
  InputReports records;
  records.take(test::report_of(ABS_GAS, 7));
  std::vector<std::byte> bytes;
  test::add_record(bytes, EV_ABS, ABS_GAS, 100);
  test::add_record(bytes, EV_SYN, SYN_DROPPED, 0);
  test::add_record(bytes, EV_ABS, ABS_GAS, 200);
  test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
  records.take(bytes);
  EXPECT_EQ(records.axis(ABS_GAS), 7);
  EXPECT_TRUE(records.take_dropped());
  EXPECT_FALSE(records.take_dropped());
  records.take(test::report_of(ABS_GAS, 8));
  EXPECT_EQ(records.axis(ABS_GAS), 8);
}

TEST(InputReportsTest, ButtonsAndAxesAreKeptSideBySide) {
  InputReports records;
  std::vector<std::byte> bytes;
  test::add_record(bytes, EV_ABS, ABS_X, -5);
  test::add_record(bytes, EV_KEY, BTN_SOUTH, 1);
  test::add_record(bytes, EV_ABS, ABS_CNT + 3, 1);  // of a kernel to come
  test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
  test::add_record(bytes, EV_KEY, BTN_EAST, 1);
  records.take(bytes);
  EXPECT_TRUE(records.held(BTN_SOUTH));
  EXPECT_FALSE(records.held(BTN_EAST)) << "its report has not ended";
  EXPECT_EQ(records.axis(ABS_X), -5);
  bytes.clear();
  test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
  test::add_record(bytes, EV_KEY, BTN_SOUTH, 0);
  test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
  records.take(bytes);
  EXPECT_TRUE(records.held(BTN_EAST));
  EXPECT_FALSE(records.held(BTN_SOUTH));
  records.set_button(BTN_SOUTH, true);
  records.take(test::report_of(ABS_Y, 3));
  EXPECT_TRUE(records.held(BTN_SOUTH)) << "the device's own word stays";
}

}  // namespace
}  // namespace haptrial::device
