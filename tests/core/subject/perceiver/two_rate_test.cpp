#include "core/subject/perceiver/two_rate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/core/subject/perceiver/hand_rig.h"
#include "tests/support/message_of.h"

namespace haptrial::subject {
namespace {

using test::field;
using test::HandRig;
using test::Vector3d;
using testing::HasSubstr;

Eigen::Matrix3d curl() {
  Eigen::Matrix3d b;
  b << 0.0, 0.0, 13.0, 0.0, 0.0, 0.0, -13.0, 0.0, 0.0;
  return b;
}

void adapt(TwoRate& two, double disturbance, int trials) {
  for (int i = 0; i < trials; ++i) {
    two.learn(disturbance - two.state());
  }
}

/// Trials until the state is within a tenth of the disturbance's half.
int trials_to_half(TwoRate two) {
  int trials = 0;
  while (two.state() < 0.5) {
    two.learn(1.0 - two.state());
    ++trials;
  }
  return trials;
}

TEST(TwoRateTest, AdaptationFollowsTheClosedForm) {
  // z' = M z + B f with M = A - B 1ᵀ, so that z_n = (1 - M^n) (1 - M)^-1 B f.
  Eigen::Matrix2d m;
  m << 0.59 - 0.21, -0.21, -0.02, 0.992 - 0.02;
  const Eigen::Vector2d b(0.21, 0.02);
  const Eigen::Matrix2d one = Eigen::Matrix2d::Identity();
  TwoRate two;
  Eigen::Matrix2d power = one;
  for (int n = 1; n <= 300; ++n) {
    two.learn(1.0 - two.state());
    power = (power * m).eval();
    const Eigen::Vector2d z = (one - power) * (one - m).inverse() * b;
    ASSERT_NEAR(two.fast(), z[0], 1e-12);
    ASSERT_NEAR(two.slow(), z[1], 1e-12);
  }
  const double gain = 0.21 / 0.41 + 0.02 / 0.008;  // e = 1 / (1 + Σ B / (1 - A)) in the end
  EXPECT_NEAR(two.state(), gain / (1.0 + gain), 1e-3);
}

TEST(TwoRateTest, InAnErrorClampEachProcessDecaysAtItsOwnRate) {
  TwoRate two;
  adapt(two, 1.0, 200);
  const double fast = two.fast();
  const double slow = two.slow();
  for (int n = 1; n <= 50; ++n) {
    two.learn(0.0);
    ASSERT_NEAR(two.state(), fast * std::pow(0.59, n) + slow * std::pow(0.992, n), 1e-12);
  }
}

TEST(TwoRateTest, WashoutIsFasterThanForgetting) {
  TwoRate washed;
  adapt(washed, 1.0, 200);
  TwoRate clamped = washed;
  adapt(washed, 0.0, 20);
  for (int i = 0; i < 20; ++i) {
    clamped.learn(0.0);
  }
  EXPECT_LT(washed.state(), 0.8 * clamped.state());
  EXPECT_GT(washed.state(), 0.0);
}

/// Adapted, then driven back to nothing by the opposite disturbance.
TwoRate unlearnt(const TwoRateParameters& parameters = {}) {
  TwoRate two(parameters);
  adapt(two, 1.0, 200);
  while (two.state() > 0.0) {
    two.learn(-1.0 - two.state());
  }
  return two;
}

TEST(TwoRateTest, AfterUnlearningAClampShowsSpontaneousRecovery) {
  TwoRate two = unlearnt();
  const double start = two.state();
  ASSERT_LE(start, 0.0);
  double most = start;
  int peak = 0;
  for (int n = 1; n <= 100; ++n) {
    two.learn(0.0);
    if (two.state() > most) {
      most = two.state();
      peak = n;
    }
  }
  EXPECT_GT(most, 0.2) << "of the whole field, without an error";
  EXPECT_GT(peak, 2);
  EXPECT_LT(peak, 20);
  EXPECT_LT(two.state(), most) << "and decays";

  TwoRate one = unlearnt({{0.99, 0.1}, {0.0, 0.0}});
  for (int n = 1; n <= 100; ++n) {
    one.learn(0.0);
    EXPECT_LE(one.state(), 0.0) << "one process has none";
  }
}

TEST(TwoRateTest, RelearningIsFasterThanLearning) {
  EXPECT_LT(trials_to_half(unlearnt()), trials_to_half(TwoRate()));
}

struct Reached {
  double off;    // greatest way off the line, signed to the side of the field [m]
  double error;  // [share of the field]
};

Reached reach(const std::vector<scene::Field>& fields, const TwoRate& two) {
  HandRig rig(fields);
  FieldError error(curl());
  error.begin();
  const Vector3d side = curl() * Vector3d(0.0, 0.0, -1.0) / 13.0;
  Reached reached{0.0, 0.0};
  rig.run(Reach{{0.0, 0.0, -0.06}, 0.45}, 0.7,
          [&](double, const Vector3d& force, const PointState& hand) {
            const Vector3d compensation = rig.extra;
            error.feel(force, compensation, hand.velocity);
            const double off = hand.position.dot(side);
            reached.off = std::abs(off) > std::abs(reached.off) ? off : reached.off;
            rig.extra = two.compensation(curl(), rig.prober.desired().velocity);
          });
  reached.error = error.error();
  return reached;
}

TEST(TwoRateTest, ThroughTheHandTheFieldPushesAsideAndTheAftereffectToTheOtherSide) {
  const auto on = field("curl", scene::MatrixViscousParameters{curl()});
  const scene::LineChannelParameters line{Vector3d::Zero(), {0.0, 0.0, -0.06}, {2000.0, 30.0}};
  const auto channel = field("clamp", line);
  TwoRate two;
  const Reached naive = reach({on}, two);
  EXPECT_GT(naive.off, 0.004);
  EXPECT_NEAR(naive.error, 1.0, 0.05);
  for (int i = 0; i < 150; ++i) {
    two.learn(reach({on}, two).error);
  }
  TwoRate model;
  adapt(model, 1.0, 150);
  EXPECT_NEAR(two.state(), model.state(), 0.02) << "the hand learns as the model does";
  EXPECT_LT(reach({on}, two).off, 0.4 * naive.off);
  const Reached catch_trial = reach({}, two);
  EXPECT_LT(catch_trial.off, -0.5 * naive.off) << "an aftereffect";
  EXPECT_NEAR(catch_trial.error, -two.state(), 0.05);
  const Reached clamped = reach({channel}, two);
  EXPECT_LT(std::abs(clamped.off), 0.0015);
  // The clamp's walls give way a little; the hand's own 200 + 250 N/m carry at most that share.
  EXPECT_LE(clamped.error, 0.0);
  EXPECT_GT(clamped.error, -two.state() * 450.0 / (450.0 + 2000.0));
}

TEST(TwoRateTest, BadRatesAreNamed) {
  const auto message = [](const TwoRateParameters& p) {
    return haptrial::test::message_of<std::invalid_argument>([&] { TwoRate two(p); });
  };
  EXPECT_THAT(message({{1.1, 0.2}, {}}), HasSubstr("fast.retention"));
  EXPECT_THAT(message({{0.5, -0.2}, {}}), HasSubstr("fast.learning"));
  EXPECT_THAT(message({{}, {NAN, 0.2}}), HasSubstr("slow.retention"));
  EXPECT_THAT(message({{}, {0.5, 2.0}}), HasSubstr("slow.learning"));
}

}  // namespace
}  // namespace haptrial::subject
