#include "core/stream/marker_times.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::markers {
namespace {

using record::MarkerOutput;
using record::MarkerRow;

MarkerRow row(MarkerOutput way, double latency) {
  MarkerRow row;
  row.way = way;
  row.latency = latency;
  return row;
}

TEST(MarkerTimesTest, AreNearestRanksOfEachWay) {
  MarkerLatencies first, second;
  std::vector<MarkerRow> rows{row(MarkerOutput::kNone, std::nan("")),
                              row(MarkerOutput::kScreen, std::nan(""))};
  for (int i = 150; i > 0; --i) {
    rows.push_back(row(MarkerOutput::kSerial, 1e-3 * i));
  }
  first.add(rows);
  rows.clear();
  for (int i = 151; i <= 200; ++i) {
    rows.push_back(row(MarkerOutput::kSerial, 1e-3 * i));
  }
  rows.push_back(row(MarkerOutput::kSerial, std::nan("")));
  second.add(rows);
  first.add(second);
  const auto times = first.times();
  ASSERT_EQ(times.size(), 2u) << "what went nowhere has no time";
  EXPECT_EQ(times[0].way, MarkerOutput::kSerial);
  EXPECT_EQ(times[0].sent, 200u);
  EXPECT_EQ(times[0].lost, 1u);
  EXPECT_EQ(times[0].median, 0.100);
  EXPECT_EQ(times[0].p99, 0.198);
  EXPECT_EQ(times[0].largest, 0.200);
  EXPECT_EQ(times[1].sent, 0u);
  EXPECT_TRUE(std::isnan(times[1].median));
  EXPECT_EQ(sentence_of(times[0]),
            "serial: 200 markers, median 100.000 ms, 99 % 198.000 ms, largest 200.000 ms after "
            "their tick; 1 did not go");
  EXPECT_EQ(sentence_of(times[1]), "screen: no marker; 1 did not go");
}

}  // namespace
}  // namespace haptrial::markers
