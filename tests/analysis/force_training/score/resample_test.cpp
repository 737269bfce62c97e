#include "analysis/force_training/score/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

ForceCurve random_curve(std::size_t samples, double rate) {
  RandomStream random(3, "curve");
  ForceCurve curve{rate, {}};
  for (std::size_t i = 0; i < samples; ++i) {
    curve.force.push_back(random.uniform(-3.0, 9.0));
  }
  return curve;
}

template <class Law>
std::vector<double> sampled(const TimeBase& base, Law law) {
  std::vector<double> values;
  for (std::size_t k = 0; k < base.samples; ++k) {
    values.push_back(law(base.step() * static_cast<double>(k)));
  }
  return values;
}

TEST(ResampleTest, EndPointsAreExact) {
  for (std::size_t samples : {2u, 7u, 999u, 13731u}) {
    for (double rate : {1000.0, 60.0, 998.7, 1.0 / 3.0}) {
      const ForceCurve curve = random_curve(samples, rate);
      const TimeBase base{duration_of(curve, "c"), 1000};
      const auto result = resample(curve, base);
      ASSERT_EQ(result.size(), 1000u);
      EXPECT_EQ(result.front(), curve.force.front());
      EXPECT_EQ(result.back(), curve.force.back());
    }
  }
}

TEST(ResampleTest, ItsOwnInstantsComeBack) {
  const ForceCurve curve = random_curve(501, 250.0);
  const auto result = resample(curve, {duration_of(curve, "c"), 501});
  for (std::size_t i = 0; i < 501; ++i) {
    EXPECT_NEAR(result[i], curve.force[i], 1e-11);
  }
}

TEST(ResampleTest, LinesBetweenSamplesStayLines) {
  const ForceCurve curve{2.0, {0.0, 4.0, 1.0}};  // over 1 s
  const auto result = resample(curve, {1.0, 9});
  const std::vector<double> expected{0.0, 1.0, 2.0, 3.0, 4.0, 3.25, 2.5, 1.75, 1.0};
  for (std::size_t k = 0; k < 9; ++k) {
    EXPECT_DOUBLE_EQ(result[k], expected[k]);
  }
}

TEST(ResampleTest, BeyondItsEndACurveHolds) {
  const ForceCurve curve{10.0, {0.0, 5.0}};  // over 0.1 s
  const auto result = resample(curve, {0.2, 5});
  EXPECT_DOUBLE_EQ(result[1], 2.5);
  EXPECT_EQ(result[2], 5.0);
  EXPECT_EQ(result[4], 5.0);
}

TEST(ResampleTest, AShorterBaseCutsTheCurve) {
  const ForceCurve curve{1.0, {0.0, 2.0, 4.0, 6.0}};
  EXPECT_DOUBLE_EQ(resample(curve, {1.5, 4}).back(), 3.0);
}

TEST(ResampleTest, BadCurvesAreRefusedInASentence) {
  EXPECT_THROW(duration_of({1000.0, {}}, "c"), InputError);
  EXPECT_THROW(duration_of({1000.0, {1.0}}, "c"), InputError);
  EXPECT_THROW(duration_of({0.0, {1.0, 2.0}}, "c"), InputError);
  EXPECT_THROW(duration_of({std::nan(""), {1.0, 2.0}}, "c"), InputError);
  try {
    duration_of({1000.0, {1.0, std::nan(""), 2.0}}, "the applied force");
    FAIL() << "a force that is not a number was taken";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "the applied force is nan N at sample 1; allowed: finite forces");
  }
  const ForceCurve curve{1.0, {0.0, 1.0}};
  EXPECT_THROW(resample(curve, {0.0, 10}), std::invalid_argument);
  EXPECT_THROW(resample(curve, {1.0, 1}), std::invalid_argument);
}

TEST(BoxFilterTest, AStraightLinePassesUnchanged) {
  const TimeBase base{12.0, 1000};
  const auto line = sampled(base, [](double t) { return 2.0 - 0.7 * t; });
  for (double width : {0.0, 0.001, 0.1, 3.0, 100.0}) {
    const auto filtered = box_filter(line, base, width);
    for (std::size_t k = 0; k < line.size(); ++k) {
      EXPECT_NEAR(filtered[k], line[k], 1e-9);
    }
  }
}

/// The mean of sin(w t) over a window is sin(w t) sin(w h / 2) / (w h / 2), h the width. Straight
/// lines between samples err by at most (w step)² / 8.
TEST(BoxFilterTest, ASineIsDampedByItsSinc) {
  const TimeBase base{10.0, 4001};
  for (double frequency : {0.2, 2.0, 5.0, 10.0}) {
    const double w = 2.0 * std::numbers::pi * frequency;
    const auto sine = sampled(base, [&](double t) { return std::sin(w * t); });
    for (double width : {0.1, 0.1337}) {
      const double half = 0.5 * width;
      const double gain = std::sin(w * half) / (w * half);
      const auto filtered = box_filter(sine, base, width);
      for (std::size_t k = 100; k < 3900; ++k) {
        ASSERT_NEAR(filtered[k], gain * sine[k], std::pow(w * base.step(), 2) / 8.0 + 1e-12);
      }
    }
  }
}

TEST(BoxFilterTest, TheWindowShrinksAtTheEnds) {
  const TimeBase base{4.0, 5};
  const std::vector<double> force{0.0, 0.0, 4.0, 0.0, 8.0};
  const auto filtered = box_filter(force, base, 100.0);
  EXPECT_EQ(filtered.front(), 0.0);
  EXPECT_EQ(filtered.back(), 8.0);
  EXPECT_DOUBLE_EQ(filtered[1], 0.5 * (0.0 + 2.0));               // over [0, 2]
  EXPECT_DOUBLE_EQ(filtered[2], 0.25 * (0.0 + 2.0 + 2.0 + 4.0));  // over [0, 4]
  EXPECT_DOUBLE_EQ(filtered[3], 0.5 * (2.0 + 4.0));               // over [2, 4]
}

TEST(BoxFilterTest, BadArgumentsAreRefused) {
  const std::vector<double> force(10, 1.0);
  EXPECT_THROW(box_filter(force, {1.0, 11}, 0.1), std::invalid_argument);
  EXPECT_THROW(box_filter(force, {1.0, 10}, -0.1), std::invalid_argument);
  EXPECT_THROW(box_filter(force, {1.0, 10}, std::nan("")), std::invalid_argument);
}

TEST(SlopeTest, IsExactOnAParabolaInsideAndALineEverywhere) {
  const TimeBase base{3.0, 301};
  const auto parabola = slope(sampled(base, [](double t) { return 2.0 * t * t - t; }), base);
  for (std::size_t k = 1; k < 300; ++k) {
    EXPECT_NEAR(parabola[k], 4.0 * base.step() * static_cast<double>(k) - 1.0, 1e-10);
  }
  EXPECT_NEAR(parabola.front(), 2.0 * base.step() - 1.0, 1e-10);  // one-sided: half a step late
  EXPECT_NEAR(parabola.back(), 11.0 - 2.0 * base.step(), 1e-10);
  for (double value : slope(sampled(base, [](double t) { return 5.0 * t; }), base)) {
    EXPECT_NEAR(value, 5.0, 1e-10);
  }
  EXPECT_EQ(slope(std::vector<double>{1.0, 3.0}, {0.5, 2}), (std::vector<double>{4.0, 4.0}));
}

}  // namespace
}  // namespace haptrial::analysis
