#include "core/psychometric/function/response_observer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace haptrial::psychometric {
namespace {

ObserverParameters gaussian(double guess, double lapse) {
  ObserverParameters p;
  p.function.sigmoid = Sigmoid::kGaussian;
  p.function.width = width_of_rate(Sigmoid::kGaussian, 1.0);
  p.function.guess = guess;
  p.function.lapse = lapse;
  return p;
}

/// Five standard deviations of a binomial share.
double five_sigma(double p, int n) { return 5.0 * std::sqrt(p * (1.0 - p) / n); }

TEST(ResponseObserverTest, SharesOfAnswersAreThoseOfTheFunction) {
  constexpr int kTrials = 100'000;
  ResponseObserver observer(gaussian(0.5, 0.04), 1, "observer");
  for (double level : {-3.0, -0.5, 0.0, 1.0, 8.0}) {
    const double p = 0.5 + 0.46 * 0.5 * std::erfc(-level / std::sqrt(2.0));
    int ones = 0;
    for (int i = 0; i < kTrials; ++i) {
      ones += observer.answer(level);
    }
    EXPECT_NEAR(ones / static_cast<double>(kTrials), p, five_sigma(p, kTrials)) << level;
  }
}

// Two states, answers 0 and 1: the share of repeats follows from the chain's stationary state.
TEST(ResponseObserverTest, RepetitionPullsTowardsTheAnswerBefore) {
  constexpr int kTrials = 200'000;
  auto parameters = gaussian(0.0, 0.0);
  parameters.repetition = 0.5;
  for (bool falling : {false, true}) {
    parameters.function.falling = falling;
    ResponseObserver observer(parameters, 2, "observer");
    int before = observer.answer(0.0);
    int repeats = 0;
    for (int i = 0; i < kTrials; ++i) {
      const int answer = observer.answer(0.0);
      repeats += answer == before;
      before = answer;
    }
    const double p = 0.5 * std::erfc(-0.5 / std::sqrt(2.0));  // by symmetry after either answer
    EXPECT_NEAR(repeats / static_cast<double>(kTrials), p, five_sigma(p, kTrials));
  }
}

TEST(ResponseObserverTest, DriftMovesTheThreshold) {
  auto parameters = gaussian(0.0, 0.0);
  parameters.drift = 0.01;
  ResponseObserver observer(parameters, 3, "observer");
  for (int i = 0; i < 100; ++i) {
    observer.answer(1.0);
  }
  EXPECT_NEAR(observer.probability(1.0), 0.5, 1e-12);  // the threshold came to 1
}

TEST(ResponseObserverTest, TheSameSeedAndNameGiveTheSameAnswers) {
  ResponseObserver a(gaussian(0.5, 0.0), 4, "observer");
  ResponseObserver b(gaussian(0.5, 0.0), 4, "observer");
  ResponseObserver other(gaussian(0.5, 0.0), 4, "another");
  int same_as_other = 0;
  for (int i = 0; i < 1000; ++i) {
    const int answer = a.answer(0.0);
    ASSERT_EQ(answer, b.answer(0.0));
    same_as_other += answer == other.answer(0.0);
  }
  // Agreement of two independent ones: 0.75² + 0.25².
  EXPECT_NEAR(same_as_other / 1000.0, 0.625, five_sigma(0.625, 1000));
}

TEST(ResponseObserverTest, ParametersMustBeFinite) {
  auto parameters = gaussian(0.5, 0.0);
  parameters.drift = NAN;
  EXPECT_THROW(ResponseObserver(parameters, 1, "observer"), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::psychometric
