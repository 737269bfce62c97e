#include "core/subject/path_learner.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/free_mass.h"

namespace haptrial::subject::path_learner_test {
namespace {

using Eigen::Vector3d;

constexpr double kDuration = 6.0;  // [s]
constexpr double kStep = 1e-3;

Vector3d path(double progress) {
  return {0.1 * progress - 0.05, 0.0, 0.02 * std::sin(2.0 * std::numbers::pi * progress)};
}

void expose(PathLearner& learner, bool another, bool seen, bool felt) {
  learner.begin(kDuration, another);
  for (double t = 0.0; t < kDuration; t += kStep) {
    learner.take(t / kDuration, path(t / kDuration), seen, felt);
  }
  learner.end();
}

/// A hand of 1 kg that the learner moves against the drag it expects; its mean squared distance
/// from the path at equal times [m²].
double recalled(PathLearner& learner, const HandParameters& p) {
  learner.begin(kDuration, false);
  test::FreeMass hand(1.0, {path(0.0), Vector3d::Zero()}, test::FreeMass::Rule::kSymplectic,
                      p.damping + p.stiffness * p.posture_time);
  double squares = 0.0;
  int ticks = 0;
  for (double t = 0.0; t < kDuration; t += kStep, ++ticks) {
    const double u = t / kDuration;
    squares += (hand.state().position - path(u)).squaredNorm();
    hand.step(learner.drive(u, hand.state().position), kStep);
  }
  return squares / ticks;
}

TEST(PathLearnerTest, WithoutNoiseThePathComesBack) {
  const HandParameters hand;
  PathLearner learner({0.0, 0.0, 0.0, 1.5}, hand, RandomStream(1, "path"));
  expose(learner, true, true, true);
  EXPECT_LT(std::sqrt(recalled(learner, hand)), 1e-3);
}

TEST(PathLearnerTest, WithoutAMemoryTheHandStays) {
  PathLearner learner({}, {}, RandomStream(1, "path"));
  EXPECT_TRUE(learner.drive(0.5, {0.01, 0.0, 0.0}).isZero(0.0));
  expose(learner, true, true, false);
  learner.begin(kDuration, true);  // another path
  EXPECT_TRUE(learner.drive(0.5, {0.01, 0.0, 0.0}).isZero(0.0));
}

/// Errors over many people have the variances of the law: 1 / sum of 1 / sigma², and half of it
/// after a second exposure.
TEST(PathLearnerTest, SensesAndExposuresCombineByTheirVariances) {
  const HandParameters hand;
  const auto error = [&hand](bool seen, bool felt, int exposures) {
    constexpr int kPeople = 60;
    double sum = 0.0;
    for (int person = 0; person < kPeople; ++person) {
      PathLearner learner({0.006, 0.008, 0.0, 1.5}, hand,
                          RandomStream(static_cast<std::uint64_t>(person), "path"));
      for (int i = 0; i < exposures; ++i) {
        expose(learner, i == 0, seen, felt);
      }
      sum += recalled(learner, hand) / kPeople;
    }
    return sum;
  };
  const double eye = error(true, false, 1);
  const double felt = error(false, true, 1);
  const double both = error(true, true, 1);
  // A path of 6 s holds few independent errors of 1.5 s; of 60 people a mean is good to 10 %, and
  // the known start takes some of it.
  EXPECT_NEAR(felt / eye, 64.0 / 36.0, 0.4);
  EXPECT_NEAR(both / eye, 0.64, 0.15);
  EXPECT_NEAR(error(true, false, 2) / eye, 0.5, 0.12);
  EXPECT_NEAR(eye, 2.0 * 0.006 * 0.006, 0.25 * 2.0 * 0.006 * 0.006) << "of x and of z";
}

}  // namespace
}  // namespace haptrial::subject::path_learner_test
