#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "analysis/force_training/score/curve_csv.h"
#include "analysis/force_training/score/score.h"
#include "analysis/force_training/score/scores_csv.h"
#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::analysis::curve_csv_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TableCurve read(const std::string& text, const CurveColumns& columns = {}) {
  return read_curve(CsvTable::parse(text, "a.csv"), columns);
}

std::string problem_of(const std::string& text, const CurveColumns& columns = {}) {
  try {
    read(text, columns);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CurveCsvTest, ColumnsThatAreClearNeedNoName) {
  for (const char* text :
       {"time,force\n0,1\n0.5,2\n", "force,time\n1,0\n2,0.5\n", "0,1\n0.5,2\n"}) {
    const TableCurve curve = read(text);
    EXPECT_THAT(curve.times, ElementsAre(0.0, 0.5)) << text;
    EXPECT_THAT(curve.values, ElementsAre(1.0, 2.0)) << text;
  }
  EXPECT_THAT(read("force\n1\n2\n", {.rate = 10.0}).values, ElementsAre(1.0, 2.0));
  const TableCurve rated = read("time,force\n0,1\n0.5,2\n", {.rate = 10.0});
  EXPECT_THAT(rated.times, IsEmpty());
  EXPECT_EQ(rated.view().rate, 10.0);
  EXPECT_THAT(rated.values, ElementsAre(1.0, 2.0));
}

TEST(CurveCsvTest, WhatIsNotClearIsAskedFor) {
  EXPECT_EQ(problem_of("t,force\n0,1\n1,2\n"),
            "a.csv: no column is named 'time'; name the column of times (t, force) or give a rate");
  EXPECT_EQ(problem_of("time,x,y\n0,1,1\n1,2,2\n"),
            "a.csv: 2 columns could hold the values; name one of them (time, x, y)");
  EXPECT_THAT(problem_of("time\n0\n1\n"), HasSubstr("no column is left for the values; add one"));
  EXPECT_THAT(problem_of("0,1,2\n1,2,3\n"), HasSubstr("no column is named 'time'"));
  EXPECT_EQ(read("0,1,2\n1,2,3\n", {.time = "1", .value = "3"}).values.back(), 3.0);
}

TEST(CurveCsvTest, TimesMustIncrease) {
  EXPECT_EQ(problem_of("time,force\n0,1\n0.5,1\n0.4,2\n"),
            "a.csv:4: time is '0.4'; allowed: above 0.5, the time of the row before");
  EXPECT_THAT(problem_of("time,force\n0,1\n0,1\n"), HasSubstr("a.csv:3: time is '0'"));
}

TEST(CurveCsvTest, TooFewRowsAndBadRates) {
  EXPECT_EQ(problem_of("time,force\n0,1\n"), "a.csv:2: is the only row; allowed: at least two");
  for (double rate : {0.0, -1.0, std::nan("")}) {
    EXPECT_THAT(problem_of("force\n0\n1\n", {.rate = rate}), HasSubstr("the rate of a.csv is"));
  }
  EXPECT_THAT(problem_of("time,force\n0,1\n1,2\n", {.time = "time", .rate = 5.0}),
              HasSubstr("has a rate and a column 'time'"));
}

/// A curve whose samples are missing here and there, at its own times, is the curve.
TEST(AlignCurvesTest, TimesOfTheirOwnGiveTheScoreOfTheWholeCurve) {
  RandomStream random(1, "times");
  // Straight lines between corners at whole tenths of a second, so that no sample between matters.
  ForceCurve target{100.0, {}}, applied{100.0, {}};
  for (ForceCurve* curve : {&target, &applied}) {
    std::vector<double> corners;
    for (int k = 0; k <= 40; ++k) {
      corners.push_back(random.uniform(0.0, 8.0));
    }
    for (int k = 0; k <= 400; ++k) {
      const auto corner = static_cast<std::size_t>(k / 10);
      const double part = (k % 10) / 10.0;
      curve->force.push_back(k == 400 ? corners.back()
                                      : corners[corner] +
                                            part * (corners[corner + 1] - corners[corner]));
    }
  }
  TableCurve sparse;
  for (std::size_t k = 0; k <= 400; ++k) {
    if (k % 10 != 0 && random.below(2) == 0) {
      continue;
    }
    sparse.times.push_back(7.0 + static_cast<double>(k) / 100.0);  // from its first sample on
    sparse.values.push_back(applied.force[k]);
  }
  const ScoreParameters parameters;
  const RecallScore whole = score_recall(target, applied, parameters);
  const RecallDetail timed = align_curves(view(target), sparse.view(), parameters);
  EXPECT_NEAR(timed.score.score, whole.score, 1e-9 * whole.score);
  EXPECT_NEAR(timed.score.rms_slope, whole.rms_slope, 1e-9 * whole.rms_slope);
  EXPECT_EQ(align_curves(view(target), view(applied), parameters).score, whole);
}

TEST(AlignCurvesTest, BadCurvesAreRefused) {
  const std::vector<double> values{1.0, 2.0, 3.0}, times{0.0, 1.0, 2.0}, backwards{0.0, 2.0, 1.0};
  const std::vector<double> few{0.0, 1.0}, bad{0.0, std::nan(""), 2.0};
  const SampledCurve good{values, times};
  const auto refused = [&](const SampledCurve& curve, const char* sentence) {
    for (bool first : {true, false}) {
      try {
        align_curves(first ? curve : good, first ? good : curve, ScoreParameters{});
        ADD_FAILURE() << sentence;
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(sentence));
        EXPECT_THAT(error.what(), HasSubstr(first ? "the target force" : "the applied force"));
      }
    }
  };
  refused({values, backwards}, "time at sample 2 that is not above the one before");
  refused({values, bad}, "time at sample 1");
  refused({values, few}, "2 times for 3 samples");
  refused({values, {}, 0.0}, "rate of 0");
  refused({{}, {}, 10.0}, "0 samples");
  refused({bad, times}, "nan");
}

/// Seconds become samples of the common base, whatever the duration of the pair.
TEST(AlignCurvesTest, AWindowInSecondsKeepsPairsThatClose) {
  std::vector<ForceCurve> curves(12);
  std::vector<RecallPair> pairs;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    curves[k].rate = 50.0;
    const double peak = 2.0 + static_cast<double>(k % 2);  // the applied one a second late
    for (std::size_t i = 0; i < 250 + 30 * k; ++i) {
      curves[k].force.push_back(std::exp(-std::pow(static_cast<double>(i) / 50.0 - peak, 2)));
    }
    if (k % 2 == 1) {
      pairs.push_back({&curves[k - 1], &curves[k]});
    }
  }
  ScoreParameters parameters;
  parameters.samples = 301;
  parameters.alignment.penalty = 0.0;
  parameters.window = 0.4;
  const auto scores = score_recalls(pairs, parameters, 2);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const RecallDetail recall =
        score_recall_in_detail(*pairs[k].target, *pairs[k].applied, parameters);
    EXPECT_EQ(recall.score, scores[k]);
    double farthest = 0.0;
    for (const auto& [target, applied] : recall.path) {
      const double apart = std::abs(static_cast<double>(target) - static_cast<double>(applied));
      farthest = std::max(farthest, apart * recall.time.step());
    }
    EXPECT_LE(farthest, 0.4 + 1e-9);
    EXPECT_GT(farthest, 0.4 - 1.01 * recall.time.step()) << "a second away, so at the border";
  }
}

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

TEST(ScoresCsv, TrialsOfSeveralSessionsAreToldApart) {
  TrialScore first{"P01", "haptic", 1, 1, 1};
  TrialScore second = first;
  second.session = 2;
  const std::string text = scores_csv(std::vector{first, second});
  EXPECT_NE(text.find(",flags,session\n"), std::string::npos);
  const ScoresTable read = read_scores_csv(text, "scores.csv");
  ASSERT_EQ(read.scores.size(), 2u);
  EXPECT_EQ(read.scores[0].session, 1);
  EXPECT_EQ(read.scores[1].session, 2);
  EXPECT_EQ(scores_csv(read.scores), text);
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
}  // namespace haptrial::analysis::curve_csv_test
