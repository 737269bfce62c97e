// Studies of people whose use of two cues is known.
#include "analysis/psychophysics/study/cue_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/psychophysics/study/trials_study.h"
#include "tests/analysis/psychophysics/study/null_cues.h"
#include "tests/support/null_levels.h"

namespace haptrial::analysis::trials {
namespace {

using test::CueUse;
using test::SimulatedCues;
using test::TrueCues;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

CueStudy studied(const SimulatedCues& study) {
  return test::studied(test::simulated_cues(study), test::plan_of(study));
}

// Answers in the proportions of known functions give their standard deviations and weights.
TEST(CueStudyTest, ExactAnswersGiveTheirWeightsAndDeviations) {
  SimulatedCues study;
  study.participants = 3;
  study.eye_sd = {0.003, 0.005, 0.008};
  study.lapse = 0.0;
  study.repetitions = 400;
  study.exact = true;
  const CueStudy cues = studied(study);
  ASSERT_THAT(cues.levels, SizeIs(3));
  for (std::size_t noise = 0; noise < 3; ++noise) {
    const CueLevel& level = cues.levels[noise];
    EXPECT_EQ(level.level, std::to_string(noise));
    EXPECT_THAT(level.left_out, IsEmpty());
    ASSERT_THAT(level.people, SizeIs(3));
    for (int p = 0; p < 3; ++p) {
      const CuePerson& found = level.people[static_cast<std::size_t>(p)];
      const TrueCues own = test::true_cues(study, p, noise);
      // A count is off by 1/2 of 400 at most: 0.3 % of a standard deviation, 0.01 in a weight.
      EXPECT_NEAR(found.first_sd.value / own.eye, 1.0, 0.01);
      EXPECT_NEAR(found.second_sd.value / own.hand, 1.0, 0.01);
      EXPECT_NEAR(found.both_sd.value / own.both, 1.0, 0.01);
      // Corrected for what chance does to answers that are drawn, about 1 %.
      EXPECT_NEAR(found.predicted_sd.value / own.both, 1.0, 0.02);
      EXPECT_NEAR(found.weight.value, own.weight, 0.01);
      EXPECT_NEAR(found.predicted_weight.value, own.weight, 0.01);
      EXPECT_EQ(found.conflicts, 3u);
      EXPECT_FALSE(std::isfinite(found.weight.low)) << "there is no bootstrap";
    }
  }
}

TEST(CueStudyTest, IntervalsHoldWeightsAndPredictions) {
  SimulatedCues study;
  study.participants = 20;
  study.repetitions = 40;
  TrialsPlan plan = test::plan_of(study);
  plan.resamples = 199;
  const CueStudy cues = test::studied(test::simulated_cues(study), plan);
  ASSERT_THAT(cues.levels, SizeIs(1));
  ASSERT_GE(cues.levels[0].people.size(), 18u) << "functions of 280 trials are mostly determined";
  const auto holds = [](const Estimated& e, double truth) {
    return e.low < truth && truth < e.high;
  };
  int weights = 0, predictions = 0, deviations = 0, together = 0;
  for (const CuePerson& found : cues.levels[0].people) {
    const TrueCues own = test::true_cues(study, std::stoi(found.participant.substr(1)) - 1, 0);
    weights += holds(found.weight, own.weight);
    predictions += holds(found.predicted_weight, own.weight);
    deviations += holds(found.predicted_sd, own.both);
    together += found.weight.low < found.predicted_weight.high &&
                found.predicted_weight.low < found.weight.high;
  }
  // At 95 % five or more of 20 miss once in 400 times, six once in 3000.
  const int people = static_cast<int>(cues.levels[0].people.size());
  EXPECT_GE(weights, people - 5);
  EXPECT_GE(predictions, people - 5);
  EXPECT_GE(deviations, people - 5);
  EXPECT_GE(together, people - 1) << "two intervals of the same number overlap";
}

// Among people who combine with the least variance observed weights and standard deviations are
// those predicted, in the mean and as often as a level of 0.05 says. bench_null_trials counts more.
TEST(CueStudyTest, TestsKeepTheirLevelAmongThoseWhoCombineBest) {
  constexpr std::size_t kStudies = 200;
  const test::NullCues found = test::null_cues(CueUse::kLeastVariance, kStudies, 1000, 2);
  EXPECT_LE(found.of("weight").found, test::binomial_band(kStudies, 0.999).high);
  EXPECT_LE(found.of("log sd").found, test::binomial_band(kStudies, 0.999).high);
  // Without the correction the mean of 400 studies was 0.063. Standard errors here: 0.006, 0.007.
  EXPECT_NEAR(found.of("weight").mean, 0.0, 0.035);
  EXPECT_NEAR(found.of("log sd").mean, 0.0, 0.04);
}

TEST(CueStudyTest, NobodyBeatsTheBetterCueWhoUsesItAlone) {
  constexpr std::size_t kStudies = 200;
  const test::NullCues found = test::null_cues(CueUse::kBetterAlone, kStudies, 1000, 2);
  EXPECT_LE(found.of("better than the better one").found,
            test::binomial_band(kStudies, 0.999).high);
  EXPECT_GT(found.of("weight").found, kStudies / 2) << "their weights are 0 or 1";
}

TEST(CueStudyTest, WhatIsMissingIsSaid) {
  SimulatedCues study;
  study.participants = 4;
  study.eye_sd = {0.004, 0.006};
  study.exact = true;
  TrialsData data = test::simulated_cues(study);
  std::erase_if(data.trials, [&](const StudyTrial& trial) {
    const std::string modality = factor_level(data, trial, "modality");
    const std::string noise = factor_level(data, trial, "noise");
    const std::string conflict = factor_level(data, trial, "conflict");
    return (trial.session == 0 && modality == "hand") ||
           (trial.session == 1 && modality == "eye" && noise == "1") ||
           (trial.session == 2 && modality == "both" && noise == "0" && conflict == "0.006");
  });
  const CueStudy cues = test::studied(data, test::plan_of(study));
  ASSERT_THAT(cues.levels, SizeIs(2));
  EXPECT_THAT(cues.levels[0].left_out,
              ElementsAre("P01: there are no answers of hand at noise 0",
                          "P03: there are no answers of both at noise 0 with conflict 0.006"));
  EXPECT_THAT(cues.levels[1].left_out, ElementsAre("P01: there are no answers of hand at noise 1",
                                                   "P02: there are no answers of eye at noise 1"));
  EXPECT_THAT(cues.levels[0].people, SizeIs(2));
  EXPECT_TRUE(cues.levels[0].weight.test);
}

TEST(CueStudyTest, AFunctionOrAStandardThatIsNotDefinedIsSaid) {
  SimulatedCues study;
  study.participants = 3;
  study.repetitions = 40;
  TrialsData data = test::simulated_cues(study);
  for (StudyTrial& trial : data.trials) {
    if (trial.session == 0 && factor_level(data, trial, "modality") == "eye") {
      trial.levels.front().outcome = 1.0;
    }
    if (trial.session == 1) {
      std::erase_if(trial.variables, [](const GivenVariable& v) { return v.name == "seen"; });
    }
  }
  const CueStudy cues = test::studied(data, test::plan_of(study));
  ASSERT_THAT(cues.levels, SizeIs(1));
  ASSERT_THAT(cues.levels[0].left_out, SizeIs(2));
  EXPECT_THAT(cues.levels[0].left_out[0], HasSubstr("the function of eye, 0, 0 is not defined"));
  EXPECT_THAT(cues.levels[0].left_out[1], HasSubstr("\"seen\" has no number in some trials"));
  EXPECT_FALSE(cues.levels[0].weight.test) << "one participant is left";
}

TEST(CueStudyTest, TestsAreAdjustedOverLevels) {
  SimulatedCues study;
  study.eye_sd = {0.003, 0.005, 0.008};
  const CueStudy cues = studied(study);
  std::vector<double> p;
  for (const CueLevel& level : cues.levels) {
    p.push_back(level.weight.test->p);
  }
  // Holm: the smallest of three times 3.
  const auto least = std::min_element(p.begin(), p.end()) - p.begin();
  EXPECT_NEAR(*cues.levels[static_cast<std::size_t>(least)].weight.holm,
              std::min(1.0, 3.0 * p[static_cast<std::size_t>(least)]), 1e-12);
}

TEST(CueStudyTest, TheReportCountsItsTests) {
  SimulatedCues study;
  study.participants = 8;
  const TrialsResult result = analyze(test::simulated_cues(study), test::plan_of(study), {}, 1);
  ASSERT_TRUE(result.cues);
  int cues = 0;
  for (const NamedTest& test : tests_of(result)) {
    cues += test.name.starts_with("cues at 0: ");
  }
  EXPECT_EQ(cues, 3);
}

}  // namespace
}  // namespace haptrial::analysis::trials
