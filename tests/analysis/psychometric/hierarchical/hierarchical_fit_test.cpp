#include "analysis/psychometric/hierarchical/hierarchical_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/psychometric/fit/fitted_function.h"
#include "tests/analysis/psychometric/hierarchical/hierarchical_study.h"

namespace haptrial::analysis::hierarchical {
namespace {

Model some_people(std::uint64_t seed, std::size_t people = 6, int trials = 12) {
  test::HierarchicalStudy study = test::small_study();
  study.people = people;
  study.trials = trials;
  RandomStream random(seed, "some people");
  return test::simulated_model(study, test::typical_people(study, 0.1, random), random);
}

Sampling short_sampling() {
  Sampling sampling;
  sampling.draws = 200;
  sampling.most_draws = 200;
  return sampling;
}

// The likelihood is that of the function by its definition.
TEST(HierarchicalModelTest, HasTheLikelihoodOfItsFunctions) {
  const Model model = some_people(3);
  psychometric::PsychometricParameters shape = psychometric::parameters_named("norm", 0.5);
  const double threshold = 0.1, log_width = -0.4;
  const Model::Rates rates = model.rates(-1.5, 0.0);
  shape.threshold = model.middle() + model.range() * threshold;
  shape.width = model.range() * std::exp(log_width);
  shape.lapse = rates.lapse;
  const psychometric::PsychometricFunction psi(shape);
  for (const std::size_t series : {0U, 5U}) {
    double expected = 0.0;
    for (const TrialBlock& block : model.answers()[series].blocks) {
      expected += block.correct * std::log(psi(block.level)) +
                  (block.total - block.correct) * std::log(1.0 - psi(block.level));
    }
    EXPECT_NEAR(model.log_likelihood(series, threshold, log_width, rates), expected, 1e-9);
  }
}

TEST(HierarchicalModelTest, HasTheSlopeOfItsLikelihood) {
  const Model model = some_people(4);
  const auto at = [&](double m, double v, double l) {
    return model.log_likelihood(2, m, v, model.rates(l, 0.0));
  };
  constexpr double kStep = 1e-5;
  const Model::Curvature c = model.curvature(2, 0.1, -0.3, -1.8, 0.0);
  const auto slope = [&](double up, double down) { return (up - down) / (2.0 * kStep); };
  EXPECT_NEAR(c.slope[kThresholds], slope(at(0.1 + kStep, -0.3, -1.8), at(0.1 - kStep, -0.3, -1.8)),
              1e-5);
  EXPECT_NEAR(c.slope[kLogWidths], slope(at(0.1, -0.3 + kStep, -1.8), at(0.1, -0.3 - kStep, -1.8)),
              1e-5);
  EXPECT_NEAR(c.slope[kLapses], slope(at(0.1, -0.3, -1.8 + kStep), at(0.1, -0.3, -1.8 - kStep)),
              1e-5);
}

TEST(HierarchicalModelTest, RefusesWhatItCannotTell) {
  EXPECT_THROW(some_people(1, 2), std::invalid_argument);
  test::HierarchicalStudy study = test::small_study();
  std::vector<PersonAnswers> one_level;
  for (std::size_t person = 0; person < 3; ++person) {
    one_level.push_back({person, 0, {{1.0, 3, 10}}});
  }
  EXPECT_THROW(Model(one_level, study.options), std::invalid_argument);
}

// Ranks of numbers from the prior among draws from the posterior are uniform.
TEST(HierarchicalFitTest, IsCalibrated) {
  test::HierarchicalStudy study = test::small_study();
  study.people = 4;
  study.trials = 6;
  study.levels = 5;
  const test::Calibration ranks = test::calibration(study, 60, 2, 2);
  for (std::size_t k = 0; k < ranks.names.size(); ++k) {
    EXPECT_GT(test::uniform_p(ranks.ranks[k], 5), 1e-4) << ranks.names[k];
  }
}

// A draw from a wrong place is noticed: the check above can fail.
TEST(HierarchicalFitTest, AWrongSamplerWouldBeNoticed) {
  std::vector<std::size_t> ranks;
  for (std::size_t i = 0; i < 60; ++i) {
    ranks.push_back(20 + i);
  }
  EXPECT_LT(test::uniform_p(ranks, 5), 1e-4);
}

TEST(HierarchicalFitTest, IsTheSameOnAnyNumberOfThreads) {
  const Model model = some_people(5);
  Sampling sampling = short_sampling();
  const HierarchicalFit one = hierarchical_fit(model, sampling);
  sampling.threads = 3;
  const HierarchicalFit three = hierarchical_fit(model, sampling);
  EXPECT_EQ(one.conditions[1].threshold.median, three.conditions[1].threshold.median);
  EXPECT_EQ(one.r_hat, three.r_hat);
  EXPECT_EQ(one.effective, three.effective);
  for (std::size_t s = 0; s < one.functions.size(); ++s) {
    EXPECT_EQ(one.functions[s].width.high, three.functions[s].width.high);
  }
  EXPECT_EQ(one.people[0].predictive_p, three.people[0].predictive_p);
}

// With many answers of each person the posterior is where the people are.
TEST(HierarchicalFitTest, FindsPeopleWithManyAnswers) {
  test::HierarchicalStudy study = test::small_study();
  study.trials = 2000;
  RandomStream random(8, "many answers");
  const State truth = test::typical_people(study, 0.1, random);
  const Model model = test::simulated_model(study, truth, random);
  const HierarchicalFit fit = hierarchical_fit(model, Sampling{});
  ASSERT_TRUE(fit.converged) << fit.r_hat << " " << fit.effective;
  for (std::size_t s = 0; s < fit.functions.size(); ++s) {
    EXPECT_NEAR(fit.functions[s].threshold.median,
                model.middle() + model.range() * truth[kThresholds].values[s], 0.05);
  }
}

// Answers that scatter more than any function allows are noticed.
TEST(HierarchicalFitTest, ReplicatedAnswersTellScatter) {
  std::vector<PersonAnswers> answers = some_people(6, 6, 40).answers();
  for (std::size_t i = 0; i < answers[0].blocks.size(); ++i) {
    TrialBlock& block = answers[0].blocks[i];
    block.correct = i % 2 == 0 ? block.total : block.total / 3;
  }
  const HierarchicalFit fit =
      hierarchical_fit(Model(answers, test::small_study().options), short_sampling());
  EXPECT_LT(fit.people[0].predictive_p, 0.01);
  for (std::size_t person = 1; person < 6; ++person) {
    EXPECT_GT(fit.people[person].predictive_p, 0.01) << person;
  }
}

// Chains that are too short do not pass for converged.
TEST(HierarchicalFitTest, ShortChainsHaveNotConverged) {
  Sampling sampling;
  sampling.warm_up = 0;
  sampling.draws = sampling.most_draws = 20;
  EXPECT_FALSE(hierarchical_fit(some_people(7), sampling).converged);
}

}  // namespace
}  // namespace haptrial::analysis::hierarchical
