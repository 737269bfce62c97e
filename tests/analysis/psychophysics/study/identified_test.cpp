#include "analysis/psychophysics/study/detected.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/psychometric/models/detection.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/random.h"

namespace haptrial::analysis::trials::identified_test {
namespace {

using testing::ElementsAre;

TrialsPlan plan() {
  TrialsPlan p;
  p.kind = AnalysisKind::kIdentification;
  p.stimulus = "shape";
  p.choices = {"sphere", "egg", "cube"};
  p.rating = "confidence";
  return p;
}

void add(TrialsData& data, std::size_t session, const std::string& shown,
         const std::string& answered, double rating, const std::string& light = "") {
  StudyTrial& trial = data.trials.emplace_back();
  trial.session = session;
  trial.trial = static_cast<int>(data.trials.size());
  trial.answers.push_back({"shape", kNotKnown, answered, shown == answered ? 1 : 0, 1.0});
  trial.answers.push_back({"confidence", rating, "", -1, 0.5});
  trial.variables.push_back({"shape", 0, kNotKnown, shown});
  trial.variables.push_back({"light", 0, kNotKnown, light});
}

TrialsData people(std::initializer_list<const char*> names) {
  TrialsData data;
  for (const char* name : names) {
    data.sessions.push_back({std::string(name) + ".h5", name, "", "simulated", true, false, 1});
  }
  return data;
}

TEST(IdentifiedTest, SaysWhyTrialsDoNotCount) {
  TrialsData data = people({"P01"});
  for (int i = 0; i < 3; ++i) {
    add(data, 0, "sphere", "egg", 1);
    data.trials.back().answers[0].correct = -1;
  }
  add(data, 0, "sphere", "sphere", 4);
  EXPECT_EQ(identified(data, plan())[0].trials, 1);
  const auto unused = unused_trials(data, plan());
  ASSERT_EQ(unused.size(), 1u);
  EXPECT_EQ(unused[0].count, 3u);
  EXPECT_EQ(unused[0].because, "nothing says which answer is right");
}

TEST(IdentifiedTest, CountsWhatEachStimulusIsTakenFor) {
  TrialsData data = people({"P01", "P02"});
  add(data, 0, "sphere", "sphere", 4);
  add(data, 0, "sphere", "egg", 1);
  add(data, 0, "egg", "egg", 3);
  add(data, 0, "blob", "cube", 2);  // what no choice is called
  add(data, 1, "egg", "sphere", 2);
  data.trials.push_back(data.trials.front());
  data.trials.back().practice = true;
  data.trials.push_back(data.trials.front());
  data.trials.back().completed = false;
  const auto all = identified(data, plan());
  ASSERT_EQ(all.size(), 2U);
  EXPECT_THAT(all[0].confusions.stimuli, ElementsAre("sphere", "egg", "blob"));
  EXPECT_THAT(all[0].confusions.answers,
              ElementsAre(ElementsAre(1, 1, 0), ElementsAre(0, 1, 0), ElementsAre(0, 0, 1)));
  EXPECT_EQ(all[0].trials, 4);
  EXPECT_EQ(all[0].right, 2);
  EXPECT_DOUBLE_EQ(*all[0].sure_right, 3.5);
  EXPECT_DOUBLE_EQ(*all[0].sure_wrong, 1.5);
  EXPECT_DOUBLE_EQ(all[0].sureness->area, 1.0) << "each right answer was surer than each wrong one";
  EXPECT_FALSE(all[1].sure_right) << "nothing was right";
  const auto pooled = pooled_confusions(all);
  ASSERT_EQ(pooled.size(), 1U);
  EXPECT_THAT(pooled[0].second.stimuli, ElementsAre("sphere", "egg", "blob"));
  EXPECT_THAT(pooled[0].second.answers[1], ElementsAre(1, 1, 0));
}

TEST(IdentifiedTest, ConditionsAreToldApart) {
  TrialsData data = people({"P01"});
  add(data, 0, "sphere", "sphere", 4, "on");
  add(data, 0, "sphere", "egg", 1, "off");
  TrialsPlan by_light = plan();
  by_light.by = {"light"};
  const auto all = identified(data, by_light);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].condition, "off");
  EXPECT_EQ(all[0].right, 0);
  EXPECT_EQ(all[1].right, 1);
}

/// Newcombe 1998, Statistics in Medicine 17, table I, method 3.
TEST(IdentifiedTest, TheIntervalOfAShareIsWilsons) {
  struct Published {
    int right, trials;
    double low, high;
  };
  for (const Published& p : {Published{81, 263, 0.2553, 0.3662},
                             {15, 148, 0.0624, 0.1605},
                             {0, 20, 0.0, 0.1611},
                             {1, 29, 0.0061, 0.1718}}) {
    const ShareInterval interval = wilson_interval(p.right, p.trials);
    EXPECT_NEAR(interval.low, p.low, 5e-5) << p.right << " of " << p.trials;
    EXPECT_NEAR(interval.high, p.high, 5e-5) << p.right << " of " << p.trials;
  }
}

/// Observers as the formula assumes them: the evidence of the right one of m is d' higher.
TEST(IdentifiedTest, FindsTheSensitivityOfAnUnbiasedObserver) {
  constexpr double kDPrime = 1.3;
  constexpr int kPeople = 200, kTrials = 90;
  RandomStream random(7, "identify");
  TrialsData data;
  const TrialsPlan p = plan();
  for (int person = 0; person < kPeople; ++person) {
    const std::string name = "P" + std::to_string(1000 + person);
    data.sessions.push_back({name + ".h5", name, "", "simulated", true, false, 1});
    for (int i = 0; i < kTrials; ++i) {
      const std::size_t shown = random.below(3);
      std::size_t best = 0;
      double most = -1e300;
      for (std::size_t k = 0; k < 3; ++k) {
        const double evidence = random.normal() + (k == shown ? kDPrime : 0.0);
        if (evidence > most) {
          most = evidence;
          best = k;
        }
      }
      add(data, static_cast<std::size_t>(person), p.choices[shown], p.choices[best], 1.0);
    }
  }
  const auto all = identified(data, p);
  ASSERT_EQ(all.size(), static_cast<std::size_t>(kPeople));
  double mean = 0.0;
  int covered = 0;
  for (const IdentifiedCondition& one : all) {
    mean += *one.d_prime / kPeople;
    covered += one.d_low < kDPrime && kDPrime < one.d_high;
  }
  EXPECT_NEAR(mean, kDPrime, 0.05);
  EXPECT_GE(covered, 180) << "of 200 intervals of 95 %";
  EXPECT_LE(covered, 199);
}

TEST(IdentifiedTest, AShareOfOneHasASensitivityWithoutAnUpperEnd) {
  TrialsData data = people({"P01"});
  for (int i = 0; i < 10; ++i) {
    add(data, 0, "cube", "cube", 3);
  }
  const auto all = identified(data, plan());
  ASSERT_EQ(all.size(), 1U);
  EXPECT_NEAR(*all[0].d_prime, *forced_choice_d_prime(0.95, 3), 1e-12);
  EXPECT_TRUE(std::isinf(all[0].d_high));
  EXPECT_GT(all[0].d_low, 0.5);
  EXPECT_FALSE(all[0].sureness) << "nothing was wrong";
}

TEST(IdentifiedTest, AStudyHasTheMeansOverItsParticipants) {
  TrialsData data = people({"P01", "P02"});
  for (int i = 0; i < 8; ++i) {
    add(data, 0, "cube", i < 6 ? "cube" : "egg", 1 + i % 4);
    add(data, 1, "egg", i < 4 ? "egg" : "sphere", 1 + i % 4);
  }
  const TrialsResult result = analyze(data, plan(), {}, 1);
  ASSERT_EQ(result.quantities.size(), 3U);
  EXPECT_EQ(result.quantities[0].name, "share_right");
  EXPECT_NEAR(result.quantities[0].means[0]->mean, 0.625, 1e-12);
  EXPECT_EQ(result.quantities[1].name, "d_prime");
  EXPECT_EQ(result.quantities[2].name, "rating_area");
}

}  // namespace
}  // namespace haptrial::analysis::trials::identified_test
