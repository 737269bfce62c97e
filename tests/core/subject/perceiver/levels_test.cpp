// The perceiver with a hand and the one without.

#include <gtest/gtest.h>
#include <time.h>

#include <array>
#include <cmath>
#include <string>

#include "core/subject/perceiver/level_observer.h"
#include "core/subject/perceiver/sense.h"
#include "core/subject/perceiver/trial_stream.h"
#include "tests/core/subject/perceiver/hand_rig.h"
#include "tests/support/allocation_guard.h"

namespace haptrial::subject {
namespace {

using test::floor_of;
using test::HandRig;
using test::kStep;
using test::Vector3d;

constexpr std::uint64_t kSeed = 21;

double four_sigma(double p, int trials) { return 4.0 * std::sqrt(p * (1.0 - p) / trials); }

/// Probability of "the comparison", from the psychometric function.
double predicted(const LevelObserver& observer, double reference, double comparison) {
  return psychometric::PsychometricFunction(observer.discrimination(reference))(comparison);
}

/// One interval through the hand, with motor noise.
double pressed(double stiffness, const Probe& probe, int trial, int interval, Sense& sense,
               RandomStream& random) {
  HandRig rig({floor_of(stiffness)}, {0.0, 0.003, 0.0});
  const RandomStream motor = trial_stream(kSeed, interval == 0 ? "motor 1" : "motor 2", trial);
  rig.prober =
      ExplorationController(HandParameters{}, MotorNoise(SubjectParameters{}, kStep, motor));
  sense.begin(random);
  rig.run(probe, 1.5, [&](double, const Vector3d& force, const PointState& hand) {
    sense.feel(force, hand, kStep);
  });
  return sense.percept();
}

/// Share of trials in which the comparison, at random the first or second, is felt as stiffer.
double through_the_hand(double reference, double comparison, const Probe& probe, int trials) {
  Sense sense(SenseParameters{}, Quantity::kStiffness);
  Judge judge({}, kSeed);
  RandomStream order(kSeed, "order");
  int stiffer = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const int at = static_cast<int>(order.below(2));
    RandomStream random = trial_stream(kSeed, "sense", trial);
    std::array<double, 2> percepts{};
    for (int i = 0; i < 2; ++i) {
      percepts[static_cast<std::size_t>(i)] =
          pressed(i == at ? comparison : reference, probe, trial, i, sense, random);
    }
    judge.begin_trial(trial);
    stiffer += judge.between(percepts, Extreme::kLargest).answer == at;
  }
  return static_cast<double>(stiffer) / trials;
}

TEST(LevelsTest, AnswersThroughTheHandFollowTheFunctionOfTheLevels) {
  constexpr int kTrials = 500;
  const double reference = 300.0;
  const Press press{{0.0, -1.0, 0.0}, 3.0, 0.4};
  const LevelObserver observer(SenseParameters{}, Quantity::kStiffness, {}, {}, kSeed);
  for (const double ratio : {0.8, 1.0, 1.15, 1.4}) {
    const double p = predicted(observer, reference, ratio * reference);
    const double answered = through_the_hand(reference, ratio * reference, press, kTrials);
    EXPECT_NEAR(answered, p, four_sigma(p, kTrials)) << ratio;
    const int percent = static_cast<int>(std::lround(100.0 * ratio));
    RecordProperty("hand_at_" + std::to_string(percent), std::to_string(answered));
    RecordProperty("levels_at_" + std::to_string(percent), std::to_string(p));
  }
}

TEST(LevelsTest, AlsoAtAFixedDepth) {
  constexpr int kTrials = 500;
  Exploration exploration;
  exploration.depth = 0.01;
  const Reach push{{0.0, -0.01, 0.0}, 0.5};
  const LevelObserver fixed(SenseParameters{}, Quantity::kStiffness, exploration, {}, kSeed);
  const LevelObserver free(SenseParameters{}, Quantity::kStiffness, {}, {}, kSeed);
  const double p = predicted(fixed, 300.0, 330.0);
  const double answered = through_the_hand(300.0, 330.0, push, kTrials);
  EXPECT_NEAR(answered, p, four_sigma(p, kTrials));
  EXPECT_GT(answered, predicted(free, 300.0, 330.0) + four_sigma(p, kTrials))
      << "the test can tell them apart";
}

TEST(LevelsTest, ManyTrialsFollowTheFunctionForEveryQuantity) {
  constexpr int kTrials = 20000;
  struct Case {
    Quantity quantity;
    double reference;
  };
  for (const auto& [quantity, reference] :
       {Case{Quantity::kForce, 2.0}, Case{Quantity::kStiffness, 300.0},
        Case{Quantity::kViscosity, 20.0}, Case{Quantity::kFriction, 1.0},
        Case{Quantity::kRoughness, 1.0}, Case{Quantity::kExtent, 0.04},
        Case{Quantity::kFrequency, 100.0}, Case{Quantity::kMass, 0.3},
        Case{Quantity::kDuration, 0.5}}) {
    JudgementParameters judgement;
    judgement.lapse = 0.04;
    judgement.noise = 0.03;
    LevelObserver observer(SenseParameters{}, quantity, {}, judgement, kSeed);
    for (const double sigmas : {-1.0, 0.5, 1.5}) {
      const double level = reference * std::exp(sigmas * observer.weber(reference));
      int more = 0;
      for (int trial = 0; trial < kTrials; ++trial) {
        more += observer.between(trial, std::array{reference, level}, Extreme::kLargest).answer;
      }
      const double p = predicted(observer, reference, level);
      // The floor of forces, small here, is not log-normal and not that of the reference.
      EXPECT_NEAR(static_cast<double>(more) / kTrials, p, four_sigma(p, kTrials) + 0.002)
          << static_cast<int>(quantity) << " at " << sigmas;
    }
  }
}

TEST(LevelsTest, CompliancesAreSpringsTurnedOver) {
  LevelObserver stiff(SenseParameters{}, Quantity::kStiffness, {}, {}, kSeed);
  LevelObserver soft(SenseParameters{}, Quantity::kCompliance, {}, {}, kSeed);
  EXPECT_NEAR(stiff.weber(300.0), 0.15, 0.002);
  EXPECT_NEAR(soft.weber(1.0 / 300.0), stiff.weber(300.0), 1e-12);
  for (int trial = 0; trial < 1000; ++trial) {
    EXPECT_EQ(stiff.between(trial, std::array{300.0, 330.0}, Extreme::kLargest).answer,
              soft.between(trial, std::array{1 / 300.0, 1 / 330.0}, Extreme::kSmallest).answer);
  }
}

TEST(LevelsTest, DetectionHasItsHitsAndFalseAlarms) {
  constexpr int kTrials = 20000;
  JudgementParameters judgement;
  judgement.logarithmic = false;
  judgement.criterion = 0.03;
  LevelObserver observer(SenseParameters{}, Quantity::kForce, {}, judgement, kSeed);
  for (const double level : {0.0, 0.04}) {
    int yes = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      yes += observer.yes_no(trial, level).answer;
    }
    const double spread = std::hypot(0.02, 0.07 * level);
    const double p = 0.5 * std::erfc((0.03 - level) / spread / std::sqrt(2.0));
    EXPECT_NEAR(static_cast<double>(yes) / kTrials, p, four_sigma(p, kTrials) + 0.001) << level;
  }
}

TEST(LevelsTest, AHundredThousandTrialsAllocateNothing) {
  constexpr int kTrials = 100000;
  LevelObserver observer(SenseParameters{}, Quantity::kStiffness, {}, {}, kSeed);
  const haptrial::test::AllocationGuard guard;
  int more = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    more += observer.between(trial, std::array{300.0, 345.0}, Extreme::kLargest).answer;
  }
  EXPECT_EQ(guard.count(), 0u);
  EXPECT_GT(more, kTrials / 2);
}

}  // namespace
}  // namespace haptrial::subject
