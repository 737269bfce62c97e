#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "analysis/quality/channel_quality.h"
#include "analysis/quality/timing.h"
#include "core/base/random.h"
#include "core/channel/channel_row.h"
#include "core/record/hdf5/session_writer.h"
#include "core/record/read/session_reader.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::analysis {
namespace {

std::vector<record::TimingRow> bins(int count, std::int64_t width) {
  std::vector<record::TimingRow> rows;
  for (int i = 0; i < count; ++i) {
    rows.push_back({i * width, (i + 1) * width, 0, 0, 0});
  }
  return rows;
}

TEST(Percentiles, BoundThoseOfTheValuesFromAboveByABin) {
  constexpr std::int64_t kWidth = 1000;
  RandomStream random(4, "latency");
  auto rows = bins(400, kWidth);
  std::vector<double> values;
  for (int i = 0; i < 5000; ++i) {
    values.push_back(std::min(399'000.0, 1e4 * std::exp(random.normal())));
    ++rows[static_cast<std::size_t>(values.back() / kWidth)].lateness_count;
  }
  std::sort(values.begin(), values.end());
  const auto found = percentiles(rows, &record::TimingRow::lateness_count);
  ASSERT_TRUE(found);
  const auto bounds = [&](std::int64_t edge, std::size_t rank) {
    const double value = values[rank - 1];
    return static_cast<double>(edge) > value && static_cast<double>(edge) <= value + kWidth;
  };
  EXPECT_TRUE(bounds(found->median_ns, 2500));
  EXPECT_TRUE(bounds(found->p99_ns, 4950));
  EXPECT_TRUE(bounds(found->p999_ns, 4995));
  EXPECT_TRUE(bounds(found->highest_ns, 5000));
}

TEST(Percentiles, OfOneValueAreItsBin) {
  auto rows = bins(3, 10);
  rows[1].period_count = 1;
  const auto found = percentiles(rows, &record::TimingRow::period_count);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->median_ns, 20);
  EXPECT_EQ(found->highest_ns, 20);
}

TEST(Percentiles, OfNothingAreNotDefined) {
  EXPECT_FALSE(percentiles({}, &record::TimingRow::period_count));
  EXPECT_FALSE(percentiles(bins(3, 10), &record::TimingRow::period_count));
}

using channel::Incident;

TEST(ChannelQualityTest, TheRateIsThatOfTheTimeInWhichTheChannelWasThere) {
  const test::TemporaryFolder folder;
  const channel::ChannelTable grip("grip", {{"force", "N"}}, 64);
  std::vector<channel::ChannelRow> rows(601);  // 100 a second, silent for 4 s after three
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].sample = i;
    rows[i].time_ns = 10'000'000 * static_cast<std::int64_t>(i) + (i > 300 ? 4'000'000'000 : 0);
  }
  // Before the first sample, in the silence, and while samples go on.
  const std::vector<channel::IncidentRow> incidents{
      {-2'000'000'000, "grip", Incident::kLost, 0.0, "no connection"},
      {-500'000'000, "grip", Incident::kBack, 1.5, ""},
      {8'503'000'000, "grip", Incident::kLost, 0.0, "no numbers come any more"},
      {8'703'000'000, "grip", Incident::kBack, 0.2, ""},
      {4'000'000'000, "grip", Incident::kLost, 0.0, "no data come any more"},
      {7'010'000'000, "grip", Incident::kBack, 3.0, ""},
      {7'500'000'000, "grip", Incident::kMessage, 0.0, std::string(256, 'w')},
      {7'500'000'000, "grip", Incident::kMessage, 0.0, std::string(44, 'w')},
      {7'500'000'000, "grip", Incident::kMessage, 0.0, "warm"},
      {7'600'000'000, "grip", Incident::kStatus, 3.0, "hot"},
      {7'700'000'000, "grip", Incident::kStatus, 0.0, "healthy"}};
  record::SessionInfo info;
  info.subject = "P1";
  record::SessionWriter writer(folder / "a.h5", info,
                               {&grip.table(), &record::table_of<channel::IncidentRow>()});
  writer.add(record::Rows(grip.table(), rows.data(), rows.size()));
  writer.add(std::span<const channel::IncidentRow>(incidents));
  writer.set_timing({}, {0, 0, 0});
  writer.close();
  const record::SessionReader reader(folder / "a.h5");
  const std::vector<ChannelQuality> all = channel_quality(reader);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].rate(), 100.0, 1e-9);
  EXPECT_NEAR(all[0].seconds, 10.0, 1e-9);
  EXPECT_NEAR(all[0].silence, 4.01 + 0.01, 1e-9);
  EXPECT_EQ(all[0].losses, 3u);
  EXPECT_EQ(all[0].messages, 2u);
  EXPECT_EQ(all[0].faults, 1u);
  EXPECT_EQ(channel_incidents(reader)[6].text, std::string(300, 'w'));
}

}  // namespace

}  // namespace haptrial::analysis
