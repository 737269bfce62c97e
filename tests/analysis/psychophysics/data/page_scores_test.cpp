#include "analysis/psychophysics/data/page_scores.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::analysis::trials {
namespace {

TEST(PageScoresTest, MeansAreOverParticipantsForEachTime) {
  const std::vector<PageScore> scores{{"P01", "", "load", "session 1, before", "raw", 20.0},
                                      {"P01", "", "load", "session 2, before", "raw", 50.0},
                                      {"P02", "", "load", "session 1, before", "raw", 40.0},
                                      {"P02", "", "load", "session 1, before", "raw", 60.0}};
  const auto found = summaries_of(scores);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].count, 2u);
  EXPECT_NEAR(found[0].mean, 35.0, 1e-12);  // 20 and the mean of 40 and 60
  EXPECT_NEAR(found[0].deviation, 15.0 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(found[1].count, 1u);
  EXPECT_NEAR(found[1].mean, 50.0, 1e-12);
  EXPECT_TRUE(std::isnan(found[1].deviation));
}

}  // namespace
}  // namespace haptrial::analysis::trials
