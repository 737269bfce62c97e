#include "core/base/shortest_turn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace haptrial {
namespace {

using Eigen::Vector3d;

Vector3d any_vector(std::mt19937& random) {
  std::normal_distribution<double> number;
  return {number(random), number(random), number(random)};
}

TEST(ShortestTurnTest, TakesOneDirectionToTheOtherByTheAngleBetweenThem) {
  std::mt19937 random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vector3d from = any_vector(random);
    const Vector3d to = any_vector(random);
    const Eigen::Quaterniond turn = shortest_turn(from, to);
    EXPECT_NEAR(turn.norm(), 1.0, 1e-14);
    EXPECT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-13);
    const double angle = std::atan2(from.cross(to).norm(), from.dot(to));
    EXPECT_NEAR(2.0 * std::atan2(turn.vec().norm(), turn.w()), angle, 1e-13);
  }
}

TEST(ShortestTurnTest, IsExactForNearlyOppositeDirections) {
  std::mt19937 random(2);
  for (const double off : {1e-3, 1e-6, 1e-7, 1e-9, 1e-12, 0.0}) {
    const Vector3d from = any_vector(random).normalized();
    const Vector3d to = -from + off * from.unitOrthogonal();
    const Eigen::Quaterniond turn = shortest_turn(from, to);
    EXPECT_NEAR(turn.norm(), 1.0, 1e-14) << off;
    EXPECT_LT((turn * from - to.normalized()).norm(), 1e-13) << off;
  }
}

// Recordings of drillings were made with Eigen's formula: their replays need the same bits.
TEST(ShortestTurnTest, HasTheBitsOfEigensFormula) {
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    Vector3d to = any_vector(random);
    to.z() = std::abs(to.z());
    EXPECT_EQ(shortest_turn(Vector3d::UnitZ(), to).coeffs(),
              Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), to).coeffs());
  }
}

}  // namespace
}  // namespace haptrial
