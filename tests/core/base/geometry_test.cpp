#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/base/nearest.h"
#include "core/base/shortest_turn.h"

namespace haptrial {
namespace {

TEST(NearestTest, DistanceCountsLettersInsertedLeftOutReplacedAndSwapped) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("devcie", "device"), 1u) << "neighbours swapped";
  EXPECT_EQ(edit_distance("anlayze", "analyze"), 1u);
  EXPECT_EQ(edit_distance("True", "true"), 0u);
  EXPECT_EQ(edit_distance("speed", "sped"), edit_distance("sped", "speed"));
}

TEST(NearestTest, FindsWhatATypoMeantAndNothingElse) {
  const std::vector<std::string> known{"damping", "speed", "stiffness", "x"};
  EXPECT_EQ(nearest("sped", known), "speed");
  EXPECT_EQ(nearest("stifness", known), "stiffness");
  EXPECT_EQ(nearest("dampnig", known), "damping");
  EXPECT_EQ(nearest("colour", known), std::nullopt);
  EXPECT_EQ(nearest("y", known), std::nullopt) << "every letter differs";
  EXPECT_EQ(nearest("", known), std::nullopt);
  EXPECT_EQ(nearest("sped", {}), std::nullopt);
  EXPECT_EQ(nearest("run_timeout", {"wait_timeout"}), std::nullopt) << "a third differs";
  EXPECT_EQ(nearest("ab12", {"ab1", "ab2"}), "ab1") << "the first of equally near ones";
  EXPECT_EQ(nearest(std::string(1000000, 'a'), known), std::nullopt) << "and at once";
  EXPECT_EQ(did_you_mean("sped", known), "; did you mean speed?");
  EXPECT_EQ(did_you_mean("colour", known), "");
  EXPECT_EQ(not_allowed("--mode", "'sped'", known),
            "--mode is 'sped'; did you mean speed? allowed: damping, speed, stiffness, x");
  EXPECT_EQ(not_allowed("--mode", "'colour'", {"a", "b"}), "--mode is 'colour'; allowed: a, b");
}

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
