// The thresholds that Psi considers if a definition lists none.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/base/definition/table.h"
#include "core/psychometric/definition/read_tracks.h"
#include "core/psychometric/procedure/quest_plus.h"

namespace haptrial::psychometric {
namespace {

std::vector<double> thresholds_of(const std::string& keys) {
  Table root = Table::parse(
      "[procedure]\nkind = \"psi\"\nvariable = \"level\"\nstop = { trials = 5 }\n" + keys,
      "psi.toml");
  const std::vector<Track> tracks = read_tracks(root);
  root.finish();
  const auto begun = tracks.at(0).begin(1, tracks.at(0).name);
  return dynamic_cast<const QuestPlus&>(*begun).tables().definition().parameters.at(0).values;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& right) {
  ASSERT_EQ(found.size(), right.size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    EXPECT_NEAR(found[i], right[i], 1e-12 * std::abs(right.back())) << i;
  }
}

TEST(ReadPsiTest, HalfAsManyThresholdsLieOnEitherSideOfTheLevels) {
  expect_near(thresholds_of("levels = [10.0, 20.0, 30.0, 40.0]\n"),
              {-10.0, 0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0});
}

TEST(ReadPsiTest, AnOddNumberOfLevelsIsRoundedUp) {
  expect_near(thresholds_of("levels = { from = 1.0, to = 3.0, count = 3 }\n"),
              {-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0});
}

TEST(ReadPsiTest, TheyAreAsFarApartOnTheAxis) {
  expect_near(thresholds_of("levels = [1.0, 10.0, 100.0]\nscale = \"log10\"\n"),
              {0.01, 0.1, 1.0, 10.0, 100.0, 1000.0, 10000.0});
}

TEST(ReadPsiTest, OneLevelIsTheOneThreshold) {
  expect_near(thresholds_of("levels = [5.0]\nwidth = [1.0, 2.0]\n"), {5.0});
}

TEST(ReadPsiTest, ThresholdsThatAreListedAreTaken) {
  expect_near(thresholds_of("levels = [1.0, 2.0]\nthreshold = [1.5, 7.0]\n"), {1.5, 7.0});
}

}  // namespace
}  // namespace haptrial::psychometric
