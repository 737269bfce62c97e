#include "core/render/flat/force_panel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/render/gl/offscreen.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render::force_panel_test {
namespace {

constexpr int kWidth = 900;
constexpr int kHeight = 240;

/// 10 s at 100 Hz: the target is 8 N throughout, the applied force rises from 0 to 5 N.
ForceCurves example() {
  ForceCurves curves;
  for (int i = 0; i <= 1000; ++i) {
    curves.time.push_back(0.01 * i);
    curves.target.push_back(8.0);
    curves.applied.push_back(0.005 * i);
  }
  curves.run_begin = 1.0;
  curves.run_end = 9.0;
  curves.title = "P01";
  return curves;
}

class ForcePanelTest : public testing::Test {
 protected:
  Image draw(double now) {
    panel_.draw(now);
    return context_.read();
  }
  /// The pixels of a colour below the legend.
  Blob curve(const Image& image, const Colour& colour) {
    Image plot = image;
    const auto top = static_cast<std::ptrdiff_t>(kWidth) * 3 * 42;
    std::fill(plot.rgb.begin(), plot.rgb.begin() + top, std::uint8_t{0});
    return find(plot, colour);
  }

  TrialDisplayStyle style_;
  OffscreenContext context_{kWidth, kHeight};
  ForcePanel panel_{context_.gl(), style_, kWidth, kHeight};
};

TEST_F(ForcePanelTest, CurvesReachFromTheRunsBeginToNow) {
  panel_.set_curves(example());
  const Blob early = curve(draw(0.5), style_.target_colour);
  EXPECT_EQ(early.count, 0) << "before the run";
  for (const double now : {2.0, 5.0, 8.5}) {
    const Blob target = curve(draw(now), style_.target_colour);
    EXPECT_NEAR(target.left, panel_.to_pixels(1.0, 0.0).x(), 2.0);
    EXPECT_NEAR(target.right, panel_.to_pixels(now, 0.0).x(), 3.0);
    EXPECT_NEAR(target.centre.y(), panel_.to_pixels(0.0, 8.0).y(), 0.5);
  }
  const Blob late = curve(draw(10.0), style_.target_colour);
  EXPECT_NEAR(late.right, panel_.to_pixels(9.0, 0.0).x(), 3.0) << "no further than the run";
}

TEST_F(ForcePanelTest, HeightIsProportionalToForce) {
  panel_.set_curves(example());
  const Image image = draw(10.0);
  for (const double time : {2.0, 4.0, 6.0, 8.0}) {
    const Eigen::Vector2d at = panel_.to_pixels(time, 0.5 * time);
    const Rectangle around{{std::floor(at.x()), std::floor(at.y()) - 4.0},
                           {std::floor(at.x()) + 1.0, std::floor(at.y()) + 5.0}};
    EXPECT_TRUE(has_colour(image, static_cast<int>(at.x()), static_cast<int>(at.y()),
                           style_.applied_colour))
        << time;
    EXPECT_GT(covered(image, around, Colour{1.0, 1.0, 1.0}, style_.applied_colour), 1.5);
  }
  const double per_newton = panel_.to_pixels(0.0, 0.0).y() - panel_.to_pixels(0.0, 1.0).y();
  EXPECT_NEAR(panel_.to_pixels(0.0, 0.0).y() - panel_.to_pixels(0.0, style_.full_scale).y(),
              per_newton * style_.full_scale, 1e-9);
  EXPECT_EQ(panel_.to_pixels(1.0, 99.0), panel_.to_pixels(1.0, style_.full_scale)) << "held inside";
}

TEST_F(ForcePanelTest, AxesAndLegendAreThereInEveryPicture) {
  panel_.set_curves(example());
  const Image image = draw(0.0);
  const auto ink = [&](double left, double top, double right, double bottom) {
    double darkest = 255.0;
    for (int y = static_cast<int>(top); y < bottom; ++y) {
      for (int x = static_cast<int>(left); x < right; ++x) {
        darkest = std::min(darkest, pixel(image, x, y).mean());
      }
    }
    return darkest < 140.0;
  };
  EXPECT_TRUE(ink(76, 12, 120, 32)) << "title";
  EXPECT_TRUE(ink(8, 60, 28, 180)) << "name of the axis of forces";
  EXPECT_TRUE(ink(400, kHeight - 26, 560, kHeight - 6)) << "name of the axis of time";
  EXPECT_TRUE(ink(44, panel_.to_pixels(0, 12).y() - 8, 70, panel_.to_pixels(0, 12).y() + 8));
  Image legend = image;
  legend.rgb.resize(static_cast<std::size_t>(kWidth) * 3 * 42);
  legend.height = 42;
  EXPECT_GT(find(legend, style_.target_colour).count, 30);
  EXPECT_GT(find(legend, style_.applied_colour).left, find(legend, style_.target_colour).right);
}

TEST_F(ForcePanelTest, APassWithoutARunAndOneSampleAreDrawn) {
  ForceCurves one;
  one.time = {0.0};
  one.target = {0.0};
  one.applied = {0.0};
  panel_.set_curves(one);
  EXPECT_EQ(draw(0.0).width, kWidth);
  EXPECT_EQ(draw(99.0).width, kWidth);
}

TEST_F(ForcePanelTest, RejectsColumnsThatDoNotAgree) {
  EXPECT_THROW(panel_.set_curves({}), std::invalid_argument);
  ForceCurves curves = example();
  curves.applied.pop_back();
  EXPECT_THROW(panel_.set_curves(curves), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::render::force_panel_test
