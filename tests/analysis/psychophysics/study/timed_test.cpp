// Times, wrong answers and lines over a level, against sums made by hand.
#include "analysis/psychophysics/study/timed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/psychophysics/study/trials_study.h"

namespace haptrial::analysis::trials::timed_test {
namespace {

using testing::ElementsAre;

TrialsPlan plan() {
  TrialsPlan p;
  p.kind = AnalysisKind::kTimes;
  p.permutations = 0;
  return p;
}

TrialsData people(std::initializer_list<const char*> names) {
  TrialsData data;
  for (const char* name : names) {
    data.sessions.push_back({std::string(name) + ".h5", name, "", "simulated", true, false, 1});
    data.sessions.back().rate = 500.0;
  }
  return data;
}

StudyTrial& add(TrialsData& data, std::size_t session, double time, int correct,
                double items = kNotKnown) {
  StudyTrial& trial = data.trials.emplace_back();
  trial.session = session;
  trial.answers.push_back({"where", 1.0, "left", correct, time});
  trial.variables.push_back({"items", 0, items, ""});
  return trial;
}

TEST(TimedTest, TimesAreThoseOfAnswersThatAreNotWrong) {
  TrialsData data = people({"P01"});
  add(data, 0, 0.4, 1);
  add(data, 0, 0.5, 1);
  add(data, 0, 0.9, 1);
  add(data, 0, 9.0, 0);
  add(data, 0, kNotKnown, 1);  // silence, which was right
  add(data, 0, 7.0, 1).practice = true;
  add(data, 0, 7.0, 1).completed = false;
  const auto all = timed(data, plan());
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].trials, 5U);
  EXPECT_NEAR(*all[0].mean, 0.6, 1e-12);
  EXPECT_NEAR(*all[0].median, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(all[0].share_wrong(), 0.2);
  EXPECT_FALSE(all[0].line);
}

TEST(TimedTest, AStageThatWasNotDoneHasNoTime) {
  TrialsData data = people({"P01"});
  for (const auto& [ticks, reached] : {std::pair{300U, true}, {500U, true}, {1500U, false}}) {
    StudyTrial& trial = data.trials.emplace_back();
    trial.stages = {{"back", 1, true, false, 90, 0}, {"reach", 1, reached, false, ticks, 90}};
  }
  TrialsPlan p = plan();
  p.stage = "reach";
  const auto all = timed(data, p);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_THAT(all[0].times, ElementsAre(0.6, 1.0));
  EXPECT_TRUE(std::isnan(all[0].share_wrong())) << "nothing was asked";
  EXPECT_EQ(analyze(data, p, {}, 1).quantities.size(), 1U);
}

/// Points 1, 2, 4 at 2, 3, 5 and one at 1.2 less: slope and intercept by the normal equations.
TEST(TimedTest, ALineIsTheLeastSquaresLineOfEachParticipant) {
  TrialsData data = people({"P01", "P02"});
  const double x[] = {1.0, 2.0, 4.0, 5.0}, y[] = {2.0, 3.0, 5.0, 4.8};
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (int i = 0; i < 4; ++i) {
    add(data, 0, y[i], 1, x[i]);
    add(data, 1, 2.0 * y[i], -1, x[i]);
    sx += x[i];
    sy += y[i];
    sxx += x[i] * x[i];
    sxy += x[i] * y[i];
  }
  const double slope = (4.0 * sxy - sx * sy) / (4.0 * sxx - sx * sx);
  TrialsPlan p = plan();
  p.level = "items";
  const TrialsResult result = analyze(data, p, {}, 1);
  ASSERT_EQ(result.quantities.size(), 4U);
  EXPECT_EQ(result.quantities[0].name, "reaction_time");
  EXPECT_EQ(result.quantities[1].name, "slope");
  EXPECT_NEAR(result.quantities[1].means[0]->mean, 1.5 * slope, 1e-12);
  EXPECT_EQ(result.quantities[2].name, "intercept");
  EXPECT_NEAR(result.quantities[2].means[0]->mean, 1.5 * (sy - slope * sx) / 4.0, 1e-12);
  EXPECT_EQ(result.quantities[3].name, "share_wrong");
  EXPECT_EQ(result.quantities[3].table.participants(0), 1U) << "the other was not judged";
}

}  // namespace
}  // namespace haptrial::analysis::trials::timed_test
