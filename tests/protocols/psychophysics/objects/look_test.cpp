#include "protocols/psychophysics/objects/look.h"

#include <gtest/gtest.h>

#include <cmath>

namespace haptrial::protocols {
namespace {

const Eigen::Vector2d kScreen(0.20, 0.15);
const TwoEyes kEyes{0.06, 0.5};

RandomDots bar() {
  RandomDots dots;
  dots.width = 0.10;
  dots.height = 0.05;
  dots.step = 0.03;
  dots.count = 4000;
  return dots;
}

/// Depth at which the lines of sight through both eyes' dots meet: by intersection in the plane y =
/// 0, with the eyes at (-+e/2, D) and the screen at depth 0.
double depth_of(const EyeDot& left, const EyeDot& right) {
  const double crossed = left.x() - right.x();
  return kEyes.viewing_distance * crossed / (kEyes.eye_distance + crossed);
}

TEST(RandomDotsTest, BothEyesTogetherSeeABarOfItsHeightAtItsDepth) {
  const RandomDots dots = bar();
  const Eigen::Vector2d centre(0.01, -0.005);
  const auto left = dots_for_eye(dots, kScreen, centre, kEyes, -1, 7);
  const auto right = dots_for_eye(dots, kScreen, centre, kEyes, 1, 7);
  ASSERT_EQ(left.size(), 4000U);
  double lowest = 1.0;
  double highest = -1.0;
  int raised = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    ASSERT_DOUBLE_EQ(left[i].y(), right[i].y()) << "no disparity up and down";
    const double z = depth_of(left[i], right[i]);
    ASSERT_TRUE(std::abs(z) < 1e-9 || std::abs(z - dots.step) < 1e-9) << z;
    if (z > 0.5 * dots.step) {
      // Back from the screen to the place of the point, a perspective about the eyes' middle.
      const double y = left[i].y() * (kEyes.viewing_distance - z) / kEyes.viewing_distance;
      lowest = std::min(lowest, y);
      highest = std::max(highest, y);
      ++raised;
    }
  }
  // The gap between the outermost of about 670 dots and the edge is about height / 670.
  EXPECT_NEAR(highest - lowest, dots.height, 0.001);
  EXPECT_NEAR(0.5 * (highest + lowest), centre.y(), 0.001);
  const double share = dots.width * dots.height / (kScreen.x() * kScreen.y());
  EXPECT_NEAR(raised, 4000.0 * share, 4.0 * std::sqrt(4000.0 * share * (1.0 - share)));
}

TEST(RandomDotsTest, NoiseSpreadsDepthsByAShareOfTheStep) {
  RandomDots dots = bar();
  dots.noise = 1.5;
  dots.step = 0.01;
  dots.height = 1e-9;  // nothing but background
  const auto left = dots_for_eye(dots, kScreen, {0.0, 0.0}, kEyes, -1, 3);
  const auto right = dots_for_eye(dots, kScreen, {0.0, 0.0}, kEyes, 1, 3);
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const double z = depth_of(left[i], right[i]);
    sum += z;
    squares += z * z;
  }
  const double n = static_cast<double>(left.size());
  EXPECT_NEAR(sum / n, 0.0, 4.0 * 0.015 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), 0.015, 4.0 * 0.015 / std::sqrt(2.0 * n));
}

TEST(RandomDotsTest, NeitherEyeAloneTellsTheHeight) {
  // Counts of dots by height, for bars that differ: a chi-squared statistic of one eye's picture.
  RandomDots low = bar();
  RandomDots high = bar();
  low.height = 0.03;
  high.height = 0.07;
  low.count = high.count = 20000;
  const auto of = [](const RandomDots& dots, std::uint64_t seed) {
    std::array<double, 15> counts{};
    for (const EyeDot& dot : dots_for_eye(dots, kScreen, {0.0, 0.0}, kEyes, -1, seed)) {
      const auto bin = static_cast<long>(std::floor((dot.y() / kScreen.y() + 0.5) * 15.0));
      if (std::abs(dot.x()) < 0.03 && bin >= 0 && bin < 15) {
        counts[static_cast<std::size_t>(bin)] += 1.0;
      }
    }
    return counts;
  };
  // A perspective by 6 % thins the raised dots out; the edge itself is no line. The share of dots
  // in the bins that belong to one bar alone differs by less than that.
  const auto a = of(low, 1);
  const auto b = of(high, 2);
  double in_a = 0.0, in_b = 0.0, all_a = 0.0, all_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool between = i == 4 || i == 10;  // 1.5 to 3.5 cm from the middle
    in_a += between ? a[i] : 0.0;
    in_b += between ? b[i] : 0.0;
    all_a += a[i];
    all_b += b[i];
  }
  EXPECT_NEAR(in_b / all_b, in_a / all_a, 0.03);
}

TEST(RandomDotsTest, RefusesImpossibleEyes) {
  EXPECT_THROW(dots_for_eye(bar(), kScreen, {0.0, 0.0}, {0.06, 0.0}, -1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::protocols
