#include "analysis/force_training/score/scores_csv.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <vector>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

// Columns of the quality, and a row in which nothing of it is known.
const std::string kQuality =
    ",duration,lag,peak_force,saturation,training_saturation,oscillation,oscillation_frequency,"
    "training_oscillation,reduced_damping,missing_ticks,late_ticks,top_speed,dropped_frames,"
    "training_dropped_frames,flags\n";
const std::string kUnknown = ",,,,,,,,,,,,,,,\n";

TEST(ScoresCsv, HasAHeadingAndARowForEachTrial) {
  TrialScore s{"P01", "visual", 4, 2, 1, 0.1, 2.5, 0.0, 1e-7, 3.0};
  EXPECT_EQ(scores_csv(std::vector{s}),
            std::string("subject,trial,block,repetition,condition,score,alignment_cost,rms_force,"
                        "rms_slope,rms_unaligned") +
                kQuality + "P01,4,2,1,visual,0.1,2.5,0,1e-07,3" + kUnknown);
}

TEST(ScoresCsv, QuotesWhatWouldBreakARow) {
  TrialScore s;
  s.subject = "a,\"b\"\nc";
  const auto text = scores_csv(std::vector{s});
  EXPECT_NE(text.find("\n\"a,\"\"b\"\"\nc\",0,"), std::string::npos);
}

TEST(ScoresCsv, SeveralFactorsHaveAColumnEachAndReadBack) {
  TrialScore s{"P01", "visual, young", 1, 1, 1};
  s.levels = {"visual", "young"};
  const std::vector<std::string> factors{"training", "age,band"};
  const auto text = scores_csv(std::vector{s}, factors);
  EXPECT_EQ(text,
            "subject,trial,block,repetition,condition,training,\"age,band\",score,alignment_cost,"
            "rms_force,rms_slope,rms_unaligned" +
                kQuality + "P01,1,1,1,\"visual, young\",visual,young,0,0,0,0,0" + kUnknown);
  const ScoresTable read = read_scores_csv(text, "scores.csv");
  EXPECT_EQ(read.factors, factors);
  ASSERT_EQ(read.scores.size(), 1u);
  EXPECT_EQ(read.scores[0].condition, s.condition);
  EXPECT_EQ(read.scores[0].levels, s.levels);
}

TEST(ScoresCsv, OneFactorIsTheColumnOfConditions) {
  TrialScore s{"P01", "visual"};
  s.levels = {"visual"};
  const std::vector<std::string> factors{"condition"};
  const auto text = scores_csv(std::vector{s}, factors);
  EXPECT_EQ(text, scores_csv(std::vector{s}));
  const ScoresTable read = read_scores_csv(text, "scores.csv");
  EXPECT_EQ(read.factors, factors);
  EXPECT_EQ(read.scores.at(0).levels, s.levels);
}

TEST(ScoresCsv, QualityReadsBackAndItsFlagsAreOneField) {
  TrialScore s{"P01", "visual"};
  s.quality.test.duration = 12.5;
  s.quality.test.saturation = 0.97;
  s.quality.training.saturation = 0.3;
  s.quality.lag = -0.01;
  const auto text = scores_csv(std::vector{s, TrialScore{"P02", "visual"}});
  EXPECT_NE(text.find(",saturated;training_saturated\n"), std::string::npos) << text;
  const ScoresTable read = read_scores_csv(text, "scores.csv");
  ASSERT_EQ(read.scores.size(), 2u);
  EXPECT_EQ(read.scores[0].quality.test.duration, 12.5);
  EXPECT_EQ(read.scores[0].quality.test.saturation, 0.97);
  EXPECT_EQ(read.scores[0].quality.training.saturation, 0.3);
  EXPECT_EQ(read.scores[0].quality.lag, -0.01);
  EXPECT_FALSE(read.scores[0].quality.test.peak_force);
  EXPECT_FALSE(read.scores[1].quality.test.duration);
  EXPECT_EQ(scores_csv(read.scores), text);
}

TEST(ScoresCsv, RecallsOfAPathHaveTwoColumnsMoreAndReadBack) {
  TrialScore watched{"P01", "watching", 1, 1, 1};
  watched.path_error = 0.0075;
  TrialScore led = watched;
  led.kept = 0.0047;
  const std::string text = scores_csv(std::vector{watched, led});
  EXPECT_NE(text.find(",flags,path_error,kept\n"), std::string::npos);
  const ScoresTable read = read_scores_csv(text, "scores.csv");
  ASSERT_EQ(read.scores.size(), 2u);
  EXPECT_EQ(read.scores[0].path_error, 0.0075);
  EXPECT_FALSE(read.scores[0].kept);
  EXPECT_EQ(read.scores[1].kept, 0.0047);
}

TEST(ScoresCsv, TablesOfOlderVersionsWithoutQualityAreRead) {
  const ScoresTable read = read_scores_csv(
      "subject,trial,block,repetition,condition,score,alignment_cost,rms_force,rms_slope,"
      "rms_unaligned\nP01,4,2,1,visual,0.1,2.5,0,1e-07,3\n",
      "scores.csv");
  ASSERT_EQ(read.scores.size(), 1u);
  EXPECT_EQ(read.scores[0].rms_unaligned, 3.0);
  EXPECT_FALSE(read.scores[0].quality.test.saturation);
}

TEST(ScoresCsv, RefusesOtherColumnsAndWhatIsNotANumber) {
  const std::string heading =
      "subject,trial,block,repetition,condition,score,alignment_cost,rms_force,rms_slope,"
      "rms_unaligned";
  EXPECT_THROW(read_scores_csv(heading + ",saturation\n", "scores.csv"), InputError);
  EXPECT_THROW(
      read_scores_csv(heading + kQuality + "P01,4,2,1,visual,0.1,2.5,0,1,3,x" + kUnknown.substr(1),
                      "scores.csv"),
      InputError);
}

TEST(ScoresCsv, NumbersReadBackToTheSameBits) {
  RandomStream random(8, "csv");
  std::vector<TrialScore> scores(200, TrialScore{"x", "y"});
  for (auto& s : scores) {
    s.score = random.normal() * 1e3;
  }
  std::istringstream lines(scores_csv(scores));
  std::string line;
  std::getline(lines, line);
  for (const auto& s : scores) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(std::strtod(line.c_str() + std::string("x,0,0,0,y,").size(), nullptr), s.score);
  }
}

}  // namespace
}  // namespace haptrial::analysis
