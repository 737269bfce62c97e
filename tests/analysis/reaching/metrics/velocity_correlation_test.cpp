#include "analysis/reaching/metrics/velocity_correlation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/reaching/metrics/reach_metrics.h"
#include "tests/analysis/reaching/recorded.h"

namespace haptrial::analysis {
namespace {

using Eigen::Vector3d;

VelocityProfile profile_of(const test::Recorded& r) {
  const ReachMetrics m = reach_metrics(r.reach());
  return *velocity_profile(r.reach(), *m.onset, m.end);
}

const test::Recorded kStraight = test::straight({0.0, 0.0, 0.0}, {0.0, 0.0, -0.1});

TEST(VelocityCorrelationTest, TheSameShapeIsOneWhateverTheSpeed) {
  const VelocityProfile a = profile_of(test::arc(0.1, 1.0));
  VelocityProfile b = a;
  for (Vector3d& v : b) {
    v = 3.0 * v + Vector3d(0.1, 0.2, -0.3);
  }
  EXPECT_NEAR(*velocity_correlation(a, a), 1.0, 1e-14);
  EXPECT_NEAR(*velocity_correlation(a, b), 1.0, 1e-14);
  for (Vector3d& v : b) {
    v = -v;
  }
  EXPECT_NEAR(*velocity_correlation(a, b), -1.0, 1e-14);
}

TEST(VelocityCorrelationTest, ATurnedReachHasItsCosine) {
  const VelocityProfile a = profile_of(kStraight);
  for (const double angle : {0.3, 1.0, 2.0}) {
    const VelocityProfile b = profile_of(
        test::straight({0.0, 0.0, 0.0}, {0.1 * std::sin(angle), 0.0, -0.1 * std::cos(angle)}));
    EXPECT_NEAR(*velocity_correlation(a, b), std::cos(angle), 1e-12);
    EXPECT_NEAR(*velocity_correlation(b, a), std::cos(angle), 1e-12);
  }
}

TEST(VelocityCorrelationTest, AReachCountsAsAtRestAfterItsEnd) {
  const ReachMetrics m = reach_metrics(kStraight.reach());
  const ProfileSpan longer{2.0, 101};
  const auto profile = velocity_profile(kStraight.reach(), *m.onset, m.end, longer);
  ASSERT_TRUE(profile);
  EXPECT_EQ(profile->back(), Vector3d(0.0, 0.0, 0.0));
  EXPECT_FALSE(velocity_profile(kStraight.reach(), *m.onset, std::nullopt, longer));
}

TEST(VelocityCorrelationTest, TheMeanOfOppositeCurvesIsStraight) {
  Eigen::Matrix3d mirror = Eigen::Matrix3d::Identity();
  mirror(0, 0) = -1.0;
  const test::Recorded left = test::arc(0.1, 1.0), right = test::transformed(left, mirror);
  const std::vector<VelocityProfile> both{profile_of(left), profile_of(right)};
  for (const Vector3d& v : mean_profile(both)) {
    EXPECT_NEAR(v.x(), 0.0, 1e-14);
  }
}

TEST(VelocityCorrelationTest, WhatIsNotDefinedIsSaid) {
  const VelocityProfile a = profile_of(kStraight);
  EXPECT_FALSE(velocity_correlation(a, VelocityProfile(a.size(), Vector3d(1.0, 0.0, 0.0))));
  EXPECT_THROW(velocity_correlation(a, VelocityProfile(2)), std::invalid_argument);
  EXPECT_THROW(mean_profile({}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::analysis
