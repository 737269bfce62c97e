// Diffusion models, meta-d' and covariates as numbers of a study.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "analysis/psychophysics/report/trials_findings.h"
#include "analysis/psychophysics/report/trials_words.h"
#include "analysis/psychophysics/study/covariate.h"
#include "analysis/psychophysics/study/trials_study.h"
#include "core/base/error.h"
#include "tests/analysis/psychometric/models/simulated_choices.h"
#include "tests/analysis/psychophysics/simulated_trials.h"
#include "tests/support/message_of.h"

namespace haptrial::analysis::trials::decisions_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

const Quantity& quantity_of(const TrialsResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.quantities, name, &Quantity::name);
  EXPECT_NE(found, result.quantities.end()) << name;
  return *found;
}

/// Six people whose drift falls from "easy" to "hard", and one who is never wrong.
TrialsData choices_of_people() {
  TrialsData data;
  for (std::size_t person = 0; person < 7; ++person) {
    const std::string name = "P0" + std::to_string(person + 1);
    data.sessions.push_back({name + ".h5", name, "", "simulated", true, false, 1});
    RandomStream random(2, name);
    for (const bool easy : {true, false}) {
      const Diffusion model{easy ? 2.0 : 0.8, 1.2, 0.3, 0.5};
      for (const TimedChoice& choice : test::simulated_choices(model, 150, random)) {
        StudyTrial& trial = data.trials.emplace_back();
        trial.session = person;
        const bool right = choice.upper || person == 6;
        trial.answers.push_back(
            {"which", 1.0, right ? "left" : "right", right ? 1 : 0, choice.time});
        trial.variables.push_back({"task", 0, kNotKnown, easy ? "easy" : "hard"});
      }
    }
  }
  return data;
}

TrialsPlan plan_of_choices() {
  TrialsPlan plan;
  plan.kind = AnalysisKind::kTimes;
  plan.by = {"task"};
  plan.permutations = 0;
  plan.diffusion = true;
  plan.plan = parse_analysis_plan({"easy < hard"}, "", "tests");
  return plan;
}

TEST(Decisions, ParametersOfTheDiffusionModelAreTested) {
  const TrialsResult result = analyze(choices_of_people(), plan_of_choices(), {}, 1);
  const Quantity& drift = quantity_of(result, "drift");
  ASSERT_TRUE(drift.means[0] && drift.means[1]);
  EXPECT_NEAR(drift.means[0]->mean, 2.0, 0.3);
  EXPECT_NEAR(drift.means[1]->mean, 0.8, 0.3);
  EXPECT_EQ(drift.table.participants(0), 6U);
  EXPECT_LT(drift.tests.planned.tests.front().t->p, 0.001);
  EXPECT_EQ(drift.tests.planned.tests.front().sides.tail, Tail::kTwoSided);
  EXPECT_NEAR(quantity_of(result, "boundary").means[0]->mean, 1.2, 0.1);
  EXPECT_NEAR(quantity_of(result, "non_decision_time").means[0]->mean, 0.3, 0.02);
  EXPECT_THAT(summary_lines(result),
              Contains(HasSubstr("2 of 14 diffusion models could not be determined, because all "
                                 "answers are of one kind (P07, easy; P07, hard)")));
  EXPECT_THAT(estimates_csv(result), HasSubstr("non_decision_time"));
}

TEST(Decisions, AStatedAnswerIsTheUpperBoundary) {
  TrialsPlan plan = plan_of_choices();
  plan.yes = "right";
  const TrialsResult result = analyze(choices_of_people(), plan, {}, 1);
  EXPECT_NEAR(quantity_of(result, "drift").means[0]->mean, -2.0, 0.3);
}

/// A signal of mean 2 and standard deviation 1.6 in noise of 1: d_a = 2 / sqrt((1 + 1.6²) / 2).
TEST(Decisions, RatingsTellUnequalVariances) {
  test::SimulatedTrials study;
  study.task = test::SimulatedTask::kDetection;
  study.trials = 400;
  TrialsData data = test::simulated_trials(study);
  RandomStream random(1, "unequal variances");
  for (StudyTrial& trial : data.trials) {
    const bool signal = trial.levels.front().applied > 0.0;
    const double beyond = (signal ? 2.0 + 1.6 * random.normal() : random.normal()) - 0.8;
    trial.answers[0].text = beyond > 0.0 ? "yes" : "no";
    trial.answers[0].value = beyond > 0.0 ? 1.0 : 2.0;
    trial.answers[1].value = std::abs(beyond) > 1.2 ? 3.0 : std::abs(beyond) > 0.5 ? 2.0 : 1.0;
    trial.levels.front().outcome = beyond > 0.0 ? 1.0 : 0.0;
  }
  TrialsPlan plan = test::plan_of(study);
  plan.plan = parse_analysis_plan({"on > off"}, "", "tests");
  TrialsData from_zero = data;  // the numbers of the scale say nothing, where it begins neither
  for (StudyTrial& trial : from_zero.trials) {
    trial.answers[1].value -= 1.0;
  }
  const TrialsResult result = analyze(std::move(data), plan, {}, 1);
  const TrialsResult other = analyze(std::move(from_zero), plan, {}, 1);
  EXPECT_EQ(quantity_of(result, "d_a").means[0]->mean, quantity_of(other, "d_a").means[0]->mean);
  for (const std::size_t condition : {std::size_t{0}, std::size_t{1}}) {
    const auto& d_a = *quantity_of(result, "d_a").means[condition];
    EXPECT_NEAR(d_a.mean, 2.0 / std::sqrt((1.0 + 1.6 * 1.6) / 2.0), 0.1);
    const auto& sd = *quantity_of(result, "log_signal_sd").means[condition];
    EXPECT_NEAR(sd.mean, std::log(1.6), 0.1);
    EXPECT_GT(sd.low, 0.0) << "the variances are unequal";
  }
  const auto tail = [&](const char* name) {
    return quantity_of(result, name).tests.planned.tests.front().sides.tail;
  };
  EXPECT_EQ(tail("d_a"), Tail::kGreater);
  EXPECT_EQ(tail("criterion"), Tail::kTwoSided) << "a planned direction is of sensitivity";
}

TEST(Decisions, ConfidenceOfAnIdealObserverHasAnMRatioOfOne) {
  test::SimulatedTrials study;
  study.task = test::SimulatedTask::kDetection;
  study.trials = 400;
  TrialsPlan plan = test::plan_of(study);
  EXPECT_TRUE(std::ranges::none_of(analyze(test::simulated_trials(study), plan, {}, 1).quantities,
                                   [](const Quantity& q) { return q.name == "m_ratio"; }));
  plan.metacognition = true;
  const TrialsResult result = analyze(test::simulated_trials(study), plan, {}, 1);
  const Quantity& ratio = quantity_of(result, "m_ratio");
  for (const auto& mean : ratio.means) {
    ASSERT_TRUE(mean) << mean.because();
    EXPECT_LE(mean->low, 1.0);
    EXPECT_GE(mean->high, 1.0);
    EXPECT_LT(mean->high - mean->low, 0.5);
  }
  EXPECT_THAT(estimates_csv(result), HasSubstr("m_ratio"));
}

TEST(Decisions, TwoStimuliThatAreIdentifiedHaveAnMRatio) {
  TrialsData data;
  data.sessions.push_back({"P01.h5", "P01", "", "simulated", true, false, 1});
  RandomStream random(1, "identified");
  for (int i = 0; i < 2000; ++i) {
    const bool second = i % 2 == 1;
    const double evidence = random.normal() + (second ? 0.8 : -0.8);
    StudyTrial& trial = data.trials.emplace_back();
    const bool said = evidence > 0.0;
    trial.answers.push_back({"which", 1.0, said ? "cube" : "ball", said == second ? 1 : 0, 0.5});
    trial.answers.push_back({"sure", std::min(4.0, std::ceil(2.0 * std::abs(evidence))), "", -1});
    trial.variables.push_back({"shape", 0, kNotKnown, second ? "cube" : "ball"});
  }
  TrialsPlan plan;
  plan.kind = AnalysisKind::kIdentification;
  plan.stimulus = "shape";
  plan.choices = {"ball", "cube"};
  plan.discrimination = DiscriminationTask::kOneInterval;
  plan.rating = "sure";
  plan.metacognition = true;
  plan.permutations = 0;
  const TrialsResult result = analyze(std::move(data), plan, {}, 1);
  ASSERT_TRUE(result.identified.front().meta) << result.identified.front().meta.because();
  EXPECT_NEAR(result.identified.front().meta->d_prime, 1.6, 0.15);
  EXPECT_NEAR(*result.identified.front().d_prime, result.identified.front().meta->d_prime, 0.02);
  EXPECT_NEAR(result.identified.front().meta->ratio, 1.0, 0.15);
}

TEST(Decisions, ACovariateIsEachParticipantsFirstScore) {
  const std::vector<PageScore> scores{{"P01", "", "hands", "before", "age", 20.0},
                                      {"P01", "", "hands", "after", "age", 21.0},
                                      {"P02", "", "hands", "before", "age", 30.0}};
  Covariate covariate{"hands.age"};
  add_covariate(scores, covariate);
  EXPECT_EQ(covariate.values, (std::map<std::string, double>{{"P01", 20.0}, {"P02", 30.0}}));
  Covariate other{"hands.size"};
  EXPECT_THAT(test::message_of<InputError>([&] { add_covariate(scores, other); }),
              HasSubstr("there are: hands.age"));
}

}  // namespace
}  // namespace haptrial::analysis::trials::decisions_test
