#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/power/depth_check.h"
#include "analysis/power/power_report.h"
#include "analysis/power/power_words.h"

namespace haptrial::analysis {
namespace {

using testing::HasSubstr;

// R: binom.test(10, 20), binom.test(0, 10), binom.test(47, 1000).
TEST(Binomial, SharesHaveTheIntervalsOfR) {
  EXPECT_NEAR(share_of(10, 20).low, 0.2719578, 1e-7);
  EXPECT_NEAR(share_of(10, 20).high, 0.7280422, 1e-7);
  EXPECT_EQ(share_of(0, 10).low, 0.0);
  EXPECT_NEAR(share_of(0, 10).high, 0.3084971, 1e-7);
  EXPECT_NEAR(share_of(47, 1000).low, 0.03473506, 1e-8);
  EXPECT_EQ(share_of(7, 7).high, 1.0);
  for (std::size_t found = 0; found <= 2000; ++found) {
    const Share share = share_of(found, 2000);
    ASSERT_TRUE(share.low <= share.value && share.value <= share.high) << found;
  }
}

// R: qbinom(c(.005, .995), 2000, .05).
TEST(Binomial, TheBandIsThatOfR) {
  const CountBand band = binomial_band(2000, 0.05, 0.99);
  EXPECT_EQ(band.low, 76u);
  EXPECT_EQ(band.high, 126u);
  EXPECT_TRUE(band.holds(76) && band.holds(126) && !band.holds(75) && !band.holds(127));
}

TEST(SmallestN, InterpolatesTheShareAndItsBand) {
  const SmallestN size =
      smallest_n({{10.0, {500, 1000}}, {20.0, {700, 1000}}, {30.0, {900, 1000}}}, 0.8);
  EXPECT_NEAR(*size.n, 25.0, 1e-12);
  EXPECT_GT(*size.low, 20.0);
  EXPECT_LT(*size.low, 25.0);
  EXPECT_GT(*size.high, 25.0);
  EXPECT_LT(*size.high, 30.0);
}

TEST(SmallestN, SaysWhereTheTargetIsNotMetAndTakesDipsTogether) {
  EXPECT_FALSE(smallest_n({{10.0, {500, 1000}}, {20.0, {700, 1000}}}, 0.8).n);
  EXPECT_EQ(*smallest_n({{10.0, {950, 1000}}, {20.0, {990, 1000}}}, 0.8).n, 10.0);
  // 0.9 and 0.7 are 0.8 together, which both then have.
  const auto dip = smallest_n({{10.0, {500, 1000}}, {20.0, {900, 1000}}, {30.0, {700, 1000}}}, 0.8);
  EXPECT_NEAR(*dip.n, 20.0, 1e-9);
}

PowerResult result_with(std::size_t null_rejected) {
  PowerResult result;
  result.title = "study";
  result.watch = "t";
  result.keys = {{"design.participants", std::nullopt}, {"observer.effect", 0.0}};
  for (const double n : {10.0, 20.0}) {
    PowerCell null{{n, 0.0}, {}, std::nullopt};
    null.counts.replications = 2000;
    null.counts.tests["t"] = {null_rejected, 2000};
    result.nulls.push_back(null);
    PowerCell cell{{n, 1.0}, {}, std::nullopt};
    cell.counts.replications = 1000;
    cell.counts.tests["t"] = {static_cast<std::size_t>(40.0 * n), 990};
    cell.counts.reasons["not fitted"] = 10;
    result.cells.push_back(cell);
  }
  return result;
}

TEST(PowerWords, TheSizeHasItsHoursInTheLab) {
  PowerResult result = result_with(100);
  for (PowerCell& cell : result.cells) {
    cell.counts.hours.add(0.75 * cell.levels[0]);
  }
  // 800 of 990 tests of 20 participants, 400 of those of 10: by a straight line 0.8 takes 19.8.
  EXPECT_THAT(size_lines(result).front(), testing::EndsWith(", 15.0 hours of sessions"));
}

TEST(PowerResult, RejectionsArePowerOnlyIfTheTestDoesNotExceedItsLevel) {
  EXPECT_TRUE(is_power(result_with(100)));
  EXPECT_EQ(level_of(result_with(127), "t"), Level::kAbove);
  EXPECT_FALSE(is_power(result_with(127)));
  EXPECT_EQ(level_of(result_with(75), "t"), Level::kBelow);
  EXPECT_TRUE(is_power(result_with(75))) << "rejections of a cautious test are its power";
  EXPECT_THAT(verdict(result_with(50)), HasSubstr("rejects in 2.5 % of studies where 5 % are "
                                                  "allowed: it is cautious"));
  EXPECT_EQ(level_of(result_with(100), "another"), Level::kUnknown);
  EXPECT_THAT(verdict(result_with(100)),
              HasSubstr("rejects in 100 of 2000 and 100 of 2000 studies, compatible with 0.05"));
  PowerResult none = result_with(100);
  none.nulls.clear();
  EXPECT_FALSE(is_power(none));
}

TEST(PowerReport, SaysTheTrueErrorRateInPlaceOfAPower) {
  const PowerResult result = result_with(400);
  EXPECT_THAT(verdict(result), HasSubstr("rejects in 20.0 % of studies where 5 % are allowed"));
  const Drawing drawing{power_figure(result), "<svg></svg>"};
  const std::string report = to_markdown(power_report(result, drawing));
  EXPECT_THAT(report, HasSubstr("SIMULATED"));
  EXPECT_THAT(report, testing::Not(HasSubstr("a power of")));
  EXPECT_THAT(report, HasSubstr("Share of rejections (no power)"));
  EXPECT_THAT(report, HasSubstr("rejects too often"));
}

TEST(PowerReport, HasFailuresInARowOfTheirOwn) {
  const PowerResult result = result_with(100);
  const std::string report = to_markdown(power_report(result, {power_figure(result), "<svg/>"}));
  EXPECT_THAT(report, HasSubstr("| design.participants 10, observer.effect 1 | responses | not "
                                "fitted | 10 |"));
  EXPECT_THAT(report, HasSubstr("0.404 ("));  // 400 of the 990 that were made
  EXPECT_THAT(power_csv(result), HasSubstr("study,10,1,1000,990,400,0.404"));
  EXPECT_THAT(power_json(result), HasSubstr("\"simulated\": true"));
}

TEST(DepthCheck, FindsWhatResponsesGetWrong) {
  PowerResult result = result_with(100);
  PowerCell& cell = result.cells.front();
  for (int i = 0; i < 100; ++i) {
    cell.counts.values["good"].add(i % 10);
    cell.counts.values["bad"].add(i % 10);
  }
  cell.sessions.emplace();
  for (int i = 0; i < 10; ++i) {
    cell.sessions->values["good"].add(i);
    cell.sessions->values["bad"].add(20 + i);
  }
  const auto rows = depth_check(result);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_FALSE(rows[0].agrees) << rows[0].value;
  EXPECT_TRUE(rows[1].agrees) << rows[1].value;
}

}  // namespace
}  // namespace haptrial::analysis
