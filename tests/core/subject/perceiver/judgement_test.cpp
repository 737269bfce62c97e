#include "core/subject/perceiver/judgement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/support/allocation_guard.h"
#include "tests/support/message_of.h"

namespace haptrial::subject::judgement_test {
namespace {

using testing::HasSubstr;

constexpr int kTrials = 20000;

double phi(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }
/// Four standard deviations of a proportion.
double bound(double p) { return 4.0 * std::sqrt(p * (1.0 - p) / kTrials); }

/// How often the second of two equal intervals is answered.
double share_of_second(const JudgementParameters& p, int previous = -1, double ratio = 1.0) {
  Judge judge(p, 11);
  int second = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    judge.begin_trial(trial);
    judge.set_previous(previous);
    second += judge.between(std::array{2.0, 2.0 * ratio}, Extreme::kLargest).answer;
  }
  return static_cast<double>(second) / kTrials;
}

TEST(JudgeTest, TakesTheLargestOrTheSmallest) {
  Judge judge({}, 1);
  const std::vector<double> percepts{2.0, 5.0, 3.0, 0.0};
  EXPECT_EQ(judge.between(percepts, Extreme::kLargest).answer, 1);
  EXPECT_NEAR(judge.between(percepts, Extreme::kLargest).evidence, std::log(5.0 / 3.0), 1e-12);
  EXPECT_EQ(judge.between(percepts, Extreme::kSmallest).answer, 3);
  EXPECT_EQ(
      judge.between(std::array{2.0, std::numeric_limits<double>::infinity()}, Extreme::kLargest)
          .answer,
      1);
  EXPECT_EQ(judge.between(std::array<double, 2>{NAN, 0.1}, Extreme::kLargest).answer, 1);
}

TEST(JudgeTest, TwoOfNothingAreAnsweredAtRandom) {
  Judge judge({}, 1);
  int second = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    judge.begin_trial(trial);
    const Decision d = judge.between(std::array{0.0, -1.0}, Extreme::kLargest);
    second += d.answer;
    ASSERT_EQ(d.evidence, 0.0);
  }
  EXPECT_NEAR(static_cast<double>(second) / kTrials, 0.5, bound(0.5));
}

TEST(JudgeTest, NoiseBiasAndRepetitionFollowSignalDetection) {
  JudgementParameters p;
  p.noise = 0.1;
  const double sd = 0.1 * std::sqrt(2.0);
  EXPECT_NEAR(share_of_second(p), 0.5, bound(0.5));
  EXPECT_NEAR(share_of_second(p, -1, 1.1), phi(std::log(1.1) / sd), bound(0.75));
  p.bias_first = 0.08;
  EXPECT_NEAR(share_of_second(p), phi(-0.08 / sd), bound(0.3));
  p.bias_first = 0.0;
  p.repetition = 0.03;
  EXPECT_NEAR(share_of_second(p, 1), phi(0.06 / sd), bound(0.66));
  EXPECT_NEAR(share_of_second(p, 0), phi(-0.06 / sd), bound(0.34));
  EXPECT_NEAR(share_of_second(p, -1), 0.5, bound(0.5)) << "nothing to repeat";
}

TEST(JudgeTest, LapsesAreAtRandomAndLeaveTheRestAsItWas) {
  JudgementParameters p;
  p.noise = 0.1;
  Judge without(p, 4);
  p.lapse = 0.2;
  Judge with(p, 4);
  int lapses = 0;
  int wrong = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const std::array percepts{1.0, 1.1};
    without.begin_trial(trial);
    with.begin_trial(trial);
    const Decision a = without.between(percepts, Extreme::kLargest);
    const Decision b = with.between(percepts, Extreme::kLargest);
    lapses += b.lapsed;
    wrong += b.lapsed && b.answer == 0;
    if (!b.lapsed) {
      ASSERT_EQ(a.answer, b.answer);
      ASSERT_EQ(a.evidence, b.evidence);
    } else {
      ASSERT_EQ(b.evidence, 0.0);
    }
  }
  EXPECT_NEAR(static_cast<double>(lapses) / kTrials, 0.2, bound(0.2));
  EXPECT_NEAR(static_cast<double>(wrong) / kTrials, 0.1, bound(0.1));
}

TEST(JudgeTest, AYesNeedsMoreThanTheCriterionThatDrifts) {
  JudgementParameters p;
  p.logarithmic = false;
  p.criterion = 0.04;
  p.noise = 0.02;
  const auto share = [&](double percept, int trial, int previous) {
    int yes = 0;
    for (int i = 0; i < kTrials; ++i) {
      Judge judge(p, static_cast<std::uint64_t>(i));
      judge.begin_trial(trial);
      judge.set_previous(previous);
      yes += judge.yes_no(percept).answer;
    }
    return static_cast<double>(yes) / kTrials;
  };
  EXPECT_NEAR(share(0.0, 0, -1), phi(-2.0), bound(0.03)) << "false alarms";
  EXPECT_NEAR(share(0.05, 0, -1), phi(0.5), bound(0.7)) << "hits";
  p.drift = 1e-4;
  EXPECT_NEAR(share(0.05, 100, -1), phi(0.0), bound(0.5)) << "stricter later";
  p.repetition = 0.01;
  EXPECT_NEAR(share(0.05, 100, 1), phi(0.5), bound(0.7));
  EXPECT_NEAR(share(0.05, 100, 0), phi(-0.5), bound(0.3));
}

/// Each of three prototypes is answered as often as noise leaves the percept between its borders.
TEST(JudgeTest, TheNearestPrototypeIsAnswered) {
  JudgementParameters p;
  p.logarithmic = false;
  p.noise = 0.4;
  Judge judge(p, 5);
  const std::array prototypes{0.0, 1.0, 3.0};
  std::array<int, 3> answers{};
  double surest = 0.0;
  constexpr int kMany = 20000;
  for (int trial = 0; trial < kMany; ++trial) {
    judge.begin_trial(trial);
    const Decision decision = judge.nearest(0.8, prototypes);
    ++answers[static_cast<std::size_t>(decision.answer)];
    surest = std::max(surest, decision.evidence);
    EXPECT_GE(decision.evidence, 0.0);
  }
  const double first = phi((0.5 - 0.8) / 0.4), third = 1.0 - phi((2.0 - 0.8) / 0.4);
  const auto near = [&](int count, double share) {
    EXPECT_NEAR(count / double(kMany), share, 4.0 * std::sqrt(share * (1.0 - share) / kMany));
  };
  near(answers[0], first);
  near(answers[1], 1.0 - first - third);
  near(answers[2], third);
  p.noise = 0.0;
  Judge sure(p, 5);
  sure.begin_trial(0);
  EXPECT_NEAR(sure.nearest(0.8, prototypes).evidence, 0.3, 1e-12) << "to the border at 0.5";
  p.lapse = 1.0;
  Judge guesses(p, 5);
  std::array<int, 3> guessed{};
  for (int trial = 0; trial < kMany; ++trial) {
    guesses.begin_trial(trial);
    ++guessed[static_cast<std::size_t>(guesses.nearest(0.8, prototypes).answer)];
  }
  near(guessed[2], 1.0 / 3.0);
}

TEST(JudgeTest, ATrialHasItsNoiseWhateverCameBefore) {
  JudgementParameters p;
  p.noise = 0.1;
  const std::array percepts{1.0, 1.0};
  Judge a(p, 9);
  Judge b(p, 9);
  for (int trial = 0; trial < 30; ++trial) {
    a.begin_trial(trial);
    a.between(percepts, Extreme::kLargest);
    a.magnitude(2.0);
  }
  a.begin_trial(17);
  b.begin_trial(17);
  EXPECT_EQ(a.between(percepts, Extreme::kLargest).evidence,
            b.between(percepts, Extreme::kLargest).evidence);
  b.begin_trial(18);
  EXPECT_NE(a.between(percepts, Extreme::kLargest).evidence,
            b.between(percepts, Extreme::kLargest).evidence);
}

TEST(JudgeTest, WithoutASignalEachConfidenceIsAsOften) {
  JudgementParameters p;
  p.noise = 0.1;
  Judge judge(p, 2);
  std::array<int, 6> counts{};
  for (int trial = 0; trial < kTrials; ++trial) {
    judge.begin_trial(trial);
    const Decision d = judge.between(std::array{1.0, 1.0}, Extreme::kLargest);
    ++counts[static_cast<std::size_t>(confidence(d, 0.1 * std::sqrt(2.0), 6)) - 1];
  }
  for (const int count : counts) {  // |z| through 2 Phi - 1 is uniform
    EXPECT_NEAR(static_cast<double>(count) / kTrials, 1.0 / 6.0, bound(1.0 / 6.0));
  }
  EXPECT_EQ(confidence({1, 0.0, true}, 0.1, 4), 1) << "a lapse";
  EXPECT_EQ(confidence({1, std::numeric_limits<double>::infinity(), false}, 0.1, 4), 4);
  EXPECT_EQ(confidence({1, 0.1, false}, 0.0, 4), 4) << "without noise";
  EXPECT_EQ(confidence({1, 0.1, false}, 0.1, 1), 1);
}

TEST(JudgeTest, MagnitudesFollowAPowerLawWithLogNormalNoise) {
  JudgementParameters p;
  p.exponent = 0.7;
  p.modulus = 12.0;
  p.magnitude_noise = 0.25;
  Judge judge(p, 3);
  double sum_low = 0.0;
  double sum_high = 0.0;
  double squares = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    judge.begin_trial(trial);
    const double low = std::log(judge.magnitude(1.0));
    sum_low += low / kTrials;
    squares += std::pow(low - std::log(12.0), 2) / kTrials;
    sum_high += std::log(judge.magnitude(8.0)) / kTrials;
  }
  const double error = 4.0 * 0.25 / std::sqrt(kTrials);
  EXPECT_NEAR(sum_low, std::log(12.0), error);
  EXPECT_NEAR((sum_high - sum_low) / std::log(8.0), 0.7, 2.0 * error / std::log(8.0));
  EXPECT_NEAR(std::sqrt(squares), 0.25, error);
  p.magnitude_noise = 0.0;
  Judge exact(p, 3);
  EXPECT_NEAR(exact.magnitude(6.0, 3.0, 10.0), 10.0 * std::pow(2.0, 0.7), 1e-12) << "a modulus";
  EXPECT_EQ(exact.magnitude(-0.1), 0.0);
}

TEST(JudgeTest, AnAdjustmentEndsWithinItsTolerance) {
  JudgementParameters p;
  p.tolerance = 0.05;
  Judge judge(p, 3);
  EXPECT_EQ(judge.adjust(1.0, 1.2), 1);
  EXPECT_EQ(judge.adjust(1.2, 1.0), -1);
  EXPECT_EQ(judge.adjust(1.04, 1.0), 0);
  EXPECT_EQ(judge.adjust(0.0, 1.0), 1);
  EXPECT_EQ(judge.adjust(0.0, 0.0), 0);
}

TEST(JudgeTest, BadParametersAreNamed) {
  const auto message = [](double JudgementParameters::*field, double value) {
    JudgementParameters p;
    p.*field = value;
    return haptrial::test::message_of<std::invalid_argument>([&] { Judge judge(p, 1); });
  };
  using J = JudgementParameters;
  EXPECT_THAT(message(&J::noise, -1.0), HasSubstr("noise"));
  EXPECT_THAT(message(&J::bias_first, NAN), HasSubstr("bias_first"));
  EXPECT_THAT(message(&J::repetition, NAN), HasSubstr("repetition"));
  EXPECT_THAT(message(&J::criterion, 0.0), HasSubstr("criterion"));
  EXPECT_THAT(message(&J::drift, INFINITY), HasSubstr("drift"));
  EXPECT_THAT(message(&J::lapse, 1.1), HasSubstr("lapse"));
  EXPECT_THAT(message(&J::exponent, 0.0), HasSubstr("exponent"));
  EXPECT_THAT(message(&J::modulus, -1.0), HasSubstr("modulus"));
  EXPECT_THAT(message(&J::magnitude_noise, -1.0), HasSubstr("magnitude_noise"));
  EXPECT_THAT(message(&J::tolerance, -1.0), HasSubstr("tolerance"));
}

TEST(JudgeTest, DoesNotAllocate) {
  Judge judge({}, 1);
  const std::array percepts{1.0, 1.1, 0.9};
  double sum = 0.0;
  const haptrial::test::AllocationGuard guard;
  for (int trial = 0; trial < 100; ++trial) {
    judge.begin_trial(trial);
    judge.set_previous(trial % 3);
    const Decision d = judge.between(percepts, Extreme::kSmallest);
    sum += d.answer + judge.yes_no(1.0).evidence + judge.magnitude(1.0) + judge.adjust(1.0, 2.0) +
           confidence(d, 0.1, 5);
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace haptrial::subject::judgement_test
