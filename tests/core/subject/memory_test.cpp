#include <gtest/gtest.h>

#include <cmath>

#include "core/subject/force_memory.h"
#include "core/subject/perception.h"
#include "tests/core/subject/noiseless_subject.h"

namespace haptrial::subject {
namespace {

constexpr int kKnots = ForceProfile::kKnots;

ForceProfile flat(double force, double variance) {
  ForceProfile p;
  p.force.fill(force);
  p.variance.fill(variance);
  return p;
}

TEST(ForceMemoryTest, KnowsNothingAtFirst) {
  const ForceMemory memory;
  EXPECT_TRUE(memory.empty());
  EXPECT_EQ(memory.at(0.5), 0.0);
}

TEST(ForceMemoryTest, MergesByInverseVariance) {
  ForceMemory memory;
  memory.learn(flat(4.0, 1.0));
  memory.learn(flat(8.0, 3.0));
  EXPECT_NEAR(memory.at(0.3), (4.0 / 1.0 + 8.0 / 3.0) / (1.0 / 1.0 + 1.0 / 3.0), 1e-12);
}

TEST(ForceMemoryTest, RepetitionsOfOneSpreadAverage) {
  ForceMemory memory;
  double sum = 0.0;
  for (int n = 1; n <= 5; ++n) {
    memory.learn(flat(n, 2.0));
    sum += n;
    EXPECT_NEAR(memory.at(0.5), sum / n, 1e-12);
  }
}

TEST(ForceMemoryTest, TwoCertainViewsCountAlike) {
  ForceMemory memory;
  memory.learn(flat(4.0, 0.0));
  memory.learn(flat(6.0, 0.0));
  EXPECT_NEAR(memory.at(0.5), 5.0, 1e-12);
}

TEST(ForceMemoryTest, IsLinearBetweenKnotsAndHeldOutside) {
  ForceMemory memory;
  ForceProfile ramp;
  for (int j = 0; j < kKnots; ++j) {
    ramp.force[j] = (j + 0.5) / kKnots;
  }
  memory.learn(ramp);
  for (double p = 0.01; p < 0.99; p += 0.037) {
    EXPECT_NEAR(memory.at(p), p, 1e-12);
  }
  EXPECT_EQ(memory.at(-3.0), ramp.force.front());
  EXPECT_EQ(memory.at(3.0), ramp.force.back());
}

TEST(ForceMemoryTest, DriftHasItsSpreadAndMakesRoomForNewEvidence) {
  RandomStream random(3, "drift");
  double squares = 0.0;
  constexpr int kRuns = 4000;
  for (int run = 0; run < kRuns; ++run) {
    ForceMemory memory;
    memory.learn(flat(5.0, 0.0));
    memory.drift(0.4, 0.05, random);
    squares += std::pow(memory.at(0.5) - 5.0, 2) / kRuns;
    if (run == 0) {  // certain before, so only the drift makes the new view count
      const double before = memory.at(0.5);
      memory.learn(flat(9.0, 0.16));
      EXPECT_NEAR(memory.at(0.5), 0.5 * (before + 9.0), 1e-12);
    }
  }
  EXPECT_NEAR(std::sqrt(squares), 0.4, 0.04);
}

TEST(ForceMemoryTest, ClearForgets) {
  ForceMemory memory;
  memory.learn(flat(4.0, 1.0));
  memory.clear();
  EXPECT_TRUE(memory.empty());
  EXPECT_EQ(memory.at(0.5), 0.0);
}

class ExposureTest : public testing::Test {
 protected:
  /// One pass in which `force` is seen and/or felt everywhere.
  static Exposure exposure(double force, bool seen, bool felt) {
    Exposure e;
    for (int i = 0; i < 4 * kKnots; ++i) {
      const double progress = (i + 0.5) / (4 * kKnots);
      if (seen) {
        e.see(progress, force);
      }
      if (felt) {
        e.feel(progress, force, 0.0);
      }
    }
    return e;
  }
  /// Spread of the perceived force about the true one, over many people.
  static double spread(const SubjectParameters& person, double force, bool seen, bool felt) {
    constexpr int kPeople = 3000;
    double squares = 0.0;
    for (int i = 0; i < kPeople; ++i) {
      RandomStream random(static_cast<std::uint64_t>(i), "person");
      BarCalibration bar(person, random);
      const ForceProfile p = exposure(force, seen, felt).perceived(person, bar, 0.05, random);
      squares += std::pow(p.force[kKnots / 2] - force, 2) / kPeople;
    }
    return std::sqrt(squares);
  }
};

TEST_F(ExposureTest, WithoutNoiseEverySenseTellsTheTruth) {
  const SubjectParameters person = noiseless_subject();
  RandomStream random(4, "person");
  BarCalibration bar(person, random);
  for (const auto& [seen, felt] : {std::pair{true, false}, {false, true}, {true, true}}) {
    const ForceProfile p = exposure(6.0, seen, felt).perceived(person, bar, 0.05, random);
    for (const double force : p.force) {
      EXPECT_NEAR(force, 6.0, 1e-9);
    }
  }
}

TEST_F(ExposureTest, TwoSensesSpreadAsErnstAndBanksPredict) {
  // sigma_vh^2 = sigma_v^2 sigma_h^2 / (sigma_v^2 + sigma_h^2), Ernst and Banks 2002.
  SubjectParameters person = noiseless_subject();
  person.visual_memory_noise = 0.6;
  person.haptic_memory_noise = 0.8;
  const double v = spread(person, 5.0, true, false);
  const double h = spread(person, 5.0, false, true);
  const double vh = spread(person, 5.0, true, true);
  EXPECT_NEAR(v, 0.6, 0.03);
  EXPECT_NEAR(h, 0.8, 0.04);
  EXPECT_NEAR(vh, 0.48, 0.03);
}

TEST_F(ExposureTest, NoiseGrowsWithTheForceAsWeberSays) {
  SubjectParameters person = noiseless_subject();
  person.haptic_weber = 0.1;
  EXPECT_NEAR(spread(person, 3.0, false, true), 0.3, 0.02);
  EXPECT_NEAR(spread(person, 9.0, false, true), 0.9, 0.06);
}

TEST_F(ExposureTest, SeeingAloneKeepsTheMisjudgementOfTheBar) {
  SubjectParameters person = noiseless_subject();
  person.bar_misjudgement = 0.3;
  // The mean square of a log-normal error: exp(2 s^2) - 2 exp(s^2 / 2) + 1.
  const double expected = std::sqrt(std::exp(2 * 0.09) - 2 * std::exp(0.045) + 1);
  EXPECT_NEAR(spread(person, 5.0, true, false) / 5.0, expected, 0.02);
}

TEST_F(ExposureTest, ForceFeltBesideABarCalibratesIt) {
  SubjectParameters person = noiseless_subject();
  person.bar_misjudgement = 0.3;
  for (std::uint64_t i = 0; i < 20; ++i) {
    RandomStream random(i, "person");
    BarCalibration bar(person, random);
    const double before = std::abs(bar.gain() - 1.0);
    exposure(5.0, true, false).perceived(person, bar, 0.05, random);
    EXPECT_EQ(std::abs(bar.gain() - 1.0), before) << "seeing alone teaches nothing about newtons";
    exposure(5.0, true, true).perceived(person, bar, 0.05, random);
    EXPECT_NEAR(bar.gain(), 1.0, 1e-9);
    bar.relax(1.0);
    EXPECT_NEAR(std::abs(bar.gain() - 1.0), before, 1e-12);
  }
}

TEST_F(ExposureTest, AMismatchThatIsSeenCorrectsWhatIsFelt) {
  const SubjectParameters person = noiseless_subject();
  RandomStream random(5, "person");
  BarCalibration bar(person, random);
  Exposure e;
  for (int i = 0; i < kKnots; ++i) {
    e.see((i + 0.5) / kKnots, 8.0);
    e.feel((i + 0.5) / kKnots, 6.5, 1.5);  // pressed 1.5 N too little, and saw it
  }
  const ForceProfile p = e.perceived(person, bar, 0.05, random);
  EXPECT_NEAR(p.force[100], 8.0, 1e-9);
}

}  // namespace
}  // namespace haptrial::subject
