#include "core/render/flat/trial_display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "core/render/gl/offscreen.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render::trial_display_test {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

/// A wave 10 cm wide in x and 6 cm high in z, away from the world's origin.
Eigen::Vector3d wave(double part) {
  return {0.02 + 0.1 * part, 0.005, -0.01 + 0.03 * std::sin(3.0 * std::numbers::pi * part)};
}

std::vector<Eigen::Vector3d> wave_points(int count) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(wave(i / (count - 1.0)));
  }
  return points;
}

TrialDisplayStyle small_style() {
  TrialDisplayStyle style;
  style.width = kWidth;
  style.height = kHeight;
  style.bar_height = 100.0;
  return style;
}

class TrialDisplayTest : public testing::Test {
 protected:
  TrialDisplayTest() {
    display_.set_trajectory(wave_points(5000));
    shown_.show_trajectory = true;
    shown_.tool = wave(0.5);
  }

  Image draw() {
    display_.draw(shown_);
    return context_.read();
  }

  /// The height [px] of the paint in the middle column of a bar, `aside` from the marker's centre.
  double bar_height(double aside, const Colour& paint) {
    const Image image = draw();
    const Eigen::Vector2d marker = display_.to_pixels(shown_.tool);
    const double foot = marker.y() - style_.marker_radius - style_.bar_gap;
    const double column = std::floor(marker.x() + aside);
    const double slack = 0.5 * style_.frame_padding;
    return covered(image,
                   {{column, std::floor(foot - style_.bar_height - slack)},
                    {column + 1.0, std::ceil(foot + slack)}},
                   style_.background, paint);
  }
  double target_height() {
    return bar_height(-0.5 * (style_.bar_gap + style_.bar_width), style_.target_colour);
  }
  double applied_height() {
    return bar_height(0.5 * (style_.bar_gap + style_.bar_width), style_.applied_colour);
  }

  TrialDisplayStyle style_ = small_style();
  OffscreenContext context_{kWidth, kHeight};
  TrialDisplay display_{context_.gl(), style_, kWidth, kHeight};
  stimulus::Presentation shown_;
};

TEST_F(TrialDisplayTest, EmptyPresentationIsBackground) {
  shown_ = {};
  const Image image = draw();
  EXPECT_EQ(find(image, style_.background).count, kWidth * kHeight);
}

TEST_F(TrialDisplayTest, ElementsAppearOnlyWhereAskedFor) {
  // The flags are the bits of a number: every combination.
  for (unsigned flags = 0; flags < 16; ++flags) {
    shown_.show_trajectory = (flags & 1u) != 0;
    shown_.show_target_bar = (flags & 2u) != 0;
    shown_.show_applied_bar = (flags & 4u) != 0;
    shown_.show_saturation = (flags & 8u) != 0;
    shown_.target_force = 5.0;
    shown_.applied_force = 7.0;
    const Image image = draw();
    EXPECT_EQ(find(image, style_.trajectory_colour).count > 0, shown_.show_trajectory) << flags;
    EXPECT_EQ(find(image, style_.marker_colour).count > 0, shown_.show_trajectory) << flags;
    EXPECT_EQ(find(image, style_.target_colour).count > 0, shown_.show_target_bar) << flags;
    EXPECT_EQ(find(image, style_.applied_colour).count > 0, shown_.show_applied_bar) << flags;
    EXPECT_EQ(find(image, style_.saturation_colour).count > 0, shown_.show_saturation) << flags;
  }
}

TEST_F(TrialDisplayTest, ARingSaysThatTheHandMayMove) {
  const double radius = style_.marker_radius;
  const Blob before = find(draw(), style_.marker_colour);
  EXPECT_NEAR(before.right - before.left + 1, 2.0 * radius, 2.0);
  shown_.self_paced = true;
  const Blob ring = find(draw(), style_.marker_colour);
  EXPECT_NEAR(ring.right - ring.left + 1, 2.0 * radius + 5.0 * style_.marker_halo, 2.0);
  EXPECT_LT((ring.centre - before.centre).norm(), 0.5);
  shown_.show_trajectory = false;
  EXPECT_EQ(find(draw(), style_.marker_colour).count, 0);
}

TEST_F(TrialDisplayTest, ForcesDoNotShowWithoutTheirBars) {
  const Image still = draw();
  shown_.target_force = 9.0;
  shown_.applied_force = 3.0;
  shown_.progress = 0.7;
  EXPECT_EQ(draw().rgb, still.rgb);
}

TEST_F(TrialDisplayTest, BarHeightIsProportionalToForce) {
  shown_.show_target_bar = true;
  shown_.show_applied_bar = true;
  for (double force = 0.0; force <= style_.full_scale; force += 0.55) {
    const double height = style_.bar_height * force / style_.full_scale;
    shown_.target_force = force;
    shown_.applied_force = style_.full_scale - force;
    EXPECT_NEAR(target_height(), height, 0.3) << force;
    EXPECT_NEAR(applied_height(), style_.bar_height - height, 0.3) << force;
  }
}

TEST_F(TrialDisplayTest, HalfOfFullScaleHasHalfThePixels) {
  shown_.show_target_bar = true;
  shown_.target_force = style_.full_scale;
  const Blob full = find(draw(), style_.target_colour);
  shown_.target_force = 0.5 * style_.full_scale;
  const Blob half = find(draw(), style_.target_colour);
  EXPECT_NEAR(full.bottom - full.top + 1, style_.bar_height, 1.0);
  EXPECT_NEAR(half.bottom - half.top + 1, 0.5 * style_.bar_height, 1.0);
  EXPECT_NEAR(full.right - full.left + 1, style_.bar_width, 1.0);
  EXPECT_EQ(half.bottom, full.bottom) << "bars grow upwards from one foot";
  EXPECT_NEAR(half.count / static_cast<double>(full.count), 0.5, 0.01);
}

TEST_F(TrialDisplayTest, ForcesOffTheScaleFillOrEmptyTheBar) {
  shown_.show_target_bar = true;
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double force : {style_.full_scale, 1.5 * style_.full_scale, infinity}) {
    shown_.target_force = force;
    EXPECT_NEAR(target_height(), style_.bar_height, 0.3) << force;
  }
  for (const double force : {0.0, -0.0, -5.0, -infinity, std::nan("")}) {
    shown_.target_force = force;
    EXPECT_NEAR(target_height(), 0.0, 0.1) << force;
  }
}

TEST_F(TrialDisplayTest, TargetIsLeftAndAppliedRightOfTheMarkerAndAboveIt) {
  shown_.show_target_bar = true;
  shown_.show_applied_bar = true;
  shown_.target_force = 6.0;
  shown_.applied_force = 6.0;
  const Image image = draw();
  const Blob marker = find(image, style_.marker_colour);
  const Blob target = find(image, style_.target_colour);
  const Blob applied = find(image, style_.applied_colour);
  EXPECT_LT(target.right, applied.left);
  EXPECT_NEAR(marker.centre.x() - target.centre.x(), applied.centre.x() - marker.centre.x(), 1.0);
  EXPECT_EQ(target.top, applied.top) << "equal forces are equally high";
  EXPECT_LT(target.bottom, marker.top);
}

TEST_F(TrialDisplayTest, BarsMoveWithTheMarker) {
  shown_.show_target_bar = true;
  shown_.target_force = 6.0;
  const Eigen::Vector2d first = find(draw(), style_.target_colour).centre;
  const Eigen::Vector2d first_marker = display_.to_pixels(shown_.tool);
  for (const double part : {0.1, 0.33, 0.8, 1.0}) {
    shown_.tool = wave(part);
    const Eigen::Vector2d moved = find(draw(), style_.target_colour).centre - first;
    const Eigen::Vector2d marker = display_.to_pixels(shown_.tool) - first_marker;
    EXPECT_LT((moved - marker).norm(), 1.0) << part;
  }
}

TEST_F(TrialDisplayTest, MarkerIsWhereTheToolIs) {
  for (const double part : {0.0, 0.123, 0.5, 0.77, 1.0}) {
    shown_.tool = wave(part);
    const Blob marker = find(draw(), style_.marker_colour);
    EXPECT_LT((marker.centre - display_.to_pixels(shown_.tool)).norm(), 0.5) << part;
    EXPECT_NEAR(marker.right - marker.left + 1, 2.0 * style_.marker_radius, 2.0);
  }
}

TEST_F(TrialDisplayTest, ViewIsFromAboveWithTheUserAtTheBottom) {
  const auto seen_at = [this](const Eigen::Vector3d& tool) {
    shown_.tool = tool;
    return find(draw(), style_.marker_colour).centre;
  };
  const Eigen::Vector3d start = wave(0.5);
  const Eigen::Vector2d origin = seen_at(start);
  const Eigen::Vector2d x = seen_at(start + Eigen::Vector3d(0.02, 0.0, 0.0)) - origin;
  const Eigen::Vector2d y = seen_at(start + Eigen::Vector3d(0.0, 0.02, 0.0)) - origin;
  const Eigen::Vector2d z = seen_at(start + Eigen::Vector3d(0.0, 0.0, 0.02)) - origin;
  EXPECT_GT(x.x(), 30.0);
  EXPECT_NEAR(x.y(), 0.0, 0.5);
  EXPECT_LT(y.norm(), 1e-9);
  EXPECT_NEAR(z.x(), 0.0, 0.5);
  EXPECT_NEAR(z.y(), x.x(), 1.0) << "a centimetre is as long in z as in x";
}

TEST_F(TrialDisplayTest, TrajectoryPixelsLieOnTheProjectedCurveAndCoverIt) {
  shown_.tool.setConstant(std::nan(""));  // no marker over the curve
  const Image image = draw();
  std::vector<Eigen::Vector2d> curve;
  for (int i = 0; i <= 4000; ++i) {
    curve.push_back(display_.to_pixels(wave(i / 4000.0)));
    const Eigen::Vector2d at = curve.back();
    ASSERT_TRUE(has_colour(image, static_cast<int>(at.x()), static_cast<int>(at.y()),
                           style_.trajectory_colour))
        << "the curve is not drawn at " << at.transpose();
  }
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (has_colour(image, x, y, style_.background)) {
        continue;
      }
      double nearest = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector2d& point : curve) {
        nearest = std::min(nearest, (point - Eigen::Vector2d(x + 0.5, y + 0.5)).norm());
      }
      ASSERT_LT(nearest, 0.5 * style_.trajectory_width + 0.75) << x << ", " << y;
    }
  }
}

TEST_F(TrialDisplayTest, EverythingFitsAtTheEndsOfTheTrajectory) {
  shown_.show_target_bar = true;
  shown_.show_applied_bar = true;
  shown_.target_force = shown_.applied_force = style_.full_scale;
  const auto edge = static_cast<int>(style_.margin);
  for (int i = 0; i <= 12; ++i) {
    shown_.tool = wave(i / 12.0);
    const Image image = draw();
    for (int x = 0; x < kWidth; ++x) {
      for (int y = 0; y < kHeight; ++y) {
        const bool inside = x >= edge && x < kWidth - edge && y >= edge && y < kHeight - edge;
        ASSERT_TRUE(inside || has_colour(image, x, y, style_.background)) << x << ", " << y;
      }
    }
  }
}

TEST_F(TrialDisplayTest, SaturationSquareStaysInItsCorner) {
  shown_.show_saturation = true;
  for (const double part : {0.0, 0.4, 1.0}) {
    shown_.tool = wave(part);
    const Blob square = find(draw(), style_.saturation_colour);
    EXPECT_EQ(square.count, static_cast<int>(style_.saturation_size * style_.saturation_size));
    EXPECT_GE(square.left, kWidth - style_.margin) << "in the margin, where no bar reaches";
    EXPECT_LT(square.bottom, style_.margin);
    EXPECT_EQ(square.top, kWidth - 1 - square.right) << "as far from the top as from the side";
  }
}

TEST_F(TrialDisplayTest, FrameShowsFullScaleOfAnEmptyBar) {
  shown_.show_target_bar = true;
  shown_.target_force = 0.0;
  const Image with = draw();
  shown_.show_target_bar = false;
  const Image without = draw();
  const Eigen::Vector2d marker = display_.to_pixels(shown_.tool);
  int top = kHeight;
  int bottom = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < static_cast<int>(marker.x()); ++x) {
      if (pixel(with, x, y) != pixel(without, x, y)) {
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
  }
  EXPECT_NEAR(bottom - top + 1, style_.bar_height + 2 * (style_.frame_padding + style_.frame_width),
              1.5);
}

TEST_F(TrialDisplayTest, StrangeInputIsNotDrawn) {
  shown_.show_target_bar = true;
  shown_.target_force = 6.0;
  shown_.tool.x() = std::nan("");
  EXPECT_EQ(find(draw(), style_.marker_colour).count, 0);
  EXPECT_EQ(find(draw(), style_.target_colour).count, 0);
  EXPECT_GT(find(draw(), style_.trajectory_colour).count, 0);
  shown_.tool = Eigen::Vector3d(1e300, 0.0, -1e300);
  EXPECT_EQ(find(draw(), style_.marker_colour).count, 0) << "far outside the picture";

  std::vector<Eigen::Vector3d> points = wave_points(10);
  points[4].z() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(display_.set_trajectory(points), std::invalid_argument);
}

TEST_F(TrialDisplayTest, ShortTrajectoriesAreDrawnToo) {
  const std::vector<Eigen::Vector3d> flat{{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}};
  display_.set_trajectory(flat);
  shown_.tool.setConstant(std::nan(""));
  const Blob line = find(draw(), style_.trajectory_colour);
  EXPECT_LE(line.bottom - line.top + 1, style_.trajectory_width + 1.0);
  EXPECT_GT(line.right - line.left, kWidth / 2);

  const std::vector<Eigen::Vector3d> point{{0.3, 0.0, 0.2}};
  display_.set_trajectory(point);
  EXPECT_GT(find(draw(), style_.trajectory_colour).count, 0);
  display_.set_trajectory({});
  EXPECT_EQ(find(draw(), style_.trajectory_colour).count, 0);
}

TEST(FrameRendererTest, SeveralAtOnceDrawAsOneAlone) {
  TrialDisplayStyle large = small_style();
  large.width = 700;
  large.background = {0.1, 0.1, 0.1};
  stimulus::Presentation shown;
  shown.show_trajectory = true;
  shown.show_target_bar = true;
  shown.target_force = 4.0;
  shown.tool = wave(0.3);
  const auto points = wave_points(200);
  const Image small_alone = render_presentation(small_style(), points, shown);
  const Image large_alone = render_presentation(large, points, shown);
  EXPECT_NE(small_alone.rgb, large_alone.rgb);

  FrameRenderer small_one(small_style());
  {
    FrameRenderer large_one(large);
    small_one.set_trajectory(points);
    large_one.set_trajectory(points);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(small_one.draw(shown).rgb, small_alone.rgb);
      EXPECT_EQ(large_one.draw(shown).rgb, large_alone.rgb);
    }
  }
  EXPECT_EQ(small_one.draw(shown).rgb, small_alone.rgb) << "the other one has gone";
}

TEST(FrameRendererTest, OneThatGoesTakesNothingFromTheOther) {
  stimulus::Presentation shown;
  shown.show_trajectory = true;
  shown.tool = wave(0.3);
  const auto points = wave_points(200);
  auto first = std::make_unique<FrameRenderer>(small_style());
  FrameRenderer second(small_style());
  second.set_trajectory(points);
  const Image before = second.draw(shown);
  first.reset();  // while the second one's context is current
  EXPECT_EQ(second.draw(shown).rgb, before.rgb);
}

TEST(FrameRendererTest, ThreadsDrawTheSamePicture) {
  stimulus::Presentation shown;
  shown.show_trajectory = true;
  shown.tool = wave(0.3);
  const auto points = wave_points(200);
  const Image alone = render_presentation(small_style(), points, shown);
  std::vector<Image> images(3);
  {
    std::vector<std::jthread> threads;
    for (Image& image : images) {
      threads.emplace_back([&] { image = render_presentation(small_style(), points, shown); });
    }
  }
  for (const Image& image : images) {
    EXPECT_EQ(image.rgb, alone.rgb);
  }
}

TEST(TrialDisplayArgumentsTest, RejectsAStyleThatCannotBeDrawn) {
  OffscreenContext context(kWidth, kHeight);
  TrialDisplayStyle style = small_style();
  style.full_scale = 0.0;
  EXPECT_THROW(TrialDisplay(context.gl(), style, kWidth, kHeight), std::invalid_argument);
  EXPECT_THROW(TrialDisplay(context.gl(), small_style(), kWidth, 100), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::render::trial_display_test
