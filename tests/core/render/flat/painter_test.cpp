#include "core/render/flat/painter.h"

#include <GL/glcorearb.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "core/render/gl/offscreen.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render::painter_test {
namespace {

constexpr int kSide = 100;
constexpr Colour kBlack{0.0, 0.0, 0.0};
constexpr Colour kWhite{1.0, 1.0, 1.0};
constexpr double kPi = std::numbers::pi;

Image painted(const std::function<void(Painter&)>& draw) {
  OffscreenContext context(kSide, kSide);
  Painter painter(context.gl(), kSide, kSide);
  painter.begin(kBlack);
  draw(painter);
  painter.end();
  return context.read();
}

double area(const Image& image) { return covered(image, all_of(image), kBlack, kWhite); }

double area(const std::function<void(Painter&)>& draw) { return area(painted(draw)); }

int largest_difference(const Image& a, const Image& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    largest = std::max(largest, std::abs(int{a.rgb[i]} - int{b.rgb[i]}));
  }
  return largest;
}

TEST(PainterTest, RectanglesCoverTheirAreaWhereverTheyLie) {
  // Off the pixel grid, and thinner than a pixel.
  for (const double shift : {0.0, 0.25, 0.5, 0.8}) {
    for (const double height : {0.2, 0.7, 1.0, 1.3, 20.0}) {
      const Rectangle box{{30.0 + shift, 40.0 + shift}, {50.0 + shift, 40.0 + shift + height}};
      const double found = area([&](Painter& p) { p.fill(box, 0.0, kWhite); });
      EXPECT_NEAR(found, 20.0 * height, 0.005 * 20.0 * height + 0.15) << shift << " " << height;
    }
  }
  EXPECT_EQ(area([](Painter& p) { p.fill({{30.0, 40.0}, {50.0, 40.0}}, 0.0, kWhite); }), 0.0);
}

TEST(PainterTest, RoundShapesCoverTheirArea) {
  for (const double r : {2.0, 5.5, 13.0, 40.0}) {
    const double disc = area([&](Painter& p) { p.disc({50.3, 49.8}, r, kWhite); });
    EXPECT_NEAR(disc, kPi * r * r, 2.0 * kPi * r * 0.02) << "0.02 px of radius " << r;
  }
  const double circle = area([](Painter& p) { p.circle({50.3, 49.8}, 30.0, 4.0, kWhite); });
  EXPECT_NEAR(circle / (2.0 * kPi * 30.0 * 4.0), 1.0, 0.01);
  const Rectangle box{{20.0, 30.0}, {80.0, 70.0}};
  const double rounded = area([&](Painter& p) { p.fill(box, 8.0, kWhite); });
  EXPECT_NEAR(rounded, 60.0 * 40.0 - (4.0 - kPi) * 64.0, 3.0);
}

TEST(PainterTest, OutlinesLieHalfOnEitherSideOfTheEdge) {
  const Rectangle box{{20.0, 30.0}, {80.0, 70.0}};
  const Image image = painted([&](Painter& p) { p.outline(box, 0.0, 4.0, kWhite); });
  // Outside it is rounded, as everything at that distance from a corner is.
  EXPECT_NEAR(area(image), 64.0 * 44.0 - 56.0 * 36.0 - (4.0 - kPi) * 4.0, 3.0);
  for (const int x : {18, 19, 20, 21, 78, 79, 80, 81}) {
    EXPECT_TRUE(has_colour(image, x, 50, kWhite)) << x;
  }
  for (const int x : {17, 22, 50, 77, 82}) {
    EXPECT_TRUE(has_colour(image, x, 50, kBlack)) << x;
  }
}

TEST(PainterTest, LinesCoverTheirAreaAtEveryAngle) {
  for (int degrees = 0; degrees < 180; degrees += 15) {
    const double angle = degrees * kPi / 180.0;
    const Eigen::Vector2d half = 30.0 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d centre(50.0, 50.0);
    const double found =
        area([&](Painter& p) { p.line(centre - half, centre + half, 5.0, kWhite); });
    EXPECT_NEAR(found / (60.0 * 5.0 + kPi * 2.5 * 2.5), 1.0, 0.015) << degrees;
  }
}

TEST(PainterTest, PolylinePaintsNoPixelTwice) {
  const Colour half = with_alpha(kWhite, 0.5);
  const std::vector<Eigen::Vector2d> ends{{12.2, 30.7}, {85.1, 61.4}};
  std::vector<Eigen::Vector2d> fine;
  for (int i = 0; i <= 500; ++i) {
    fine.push_back(ends[0] + (ends[1] - ends[0]) * i / 500.0);
  }
  std::vector<Eigen::Vector2d> there_and_back = fine;
  there_and_back.insert(there_and_back.end(), fine.rbegin(), fine.rend());
  const Image line = painted([&](Painter& p) { p.line(ends[0], ends[1], 6.0, half); });
  const Image coarse = painted([&](Painter& p) { p.polyline(ends, 6.0, half); });
  const Image dense = painted([&](Painter& p) { p.polyline(there_and_back, 6.0, half); });
  EXPECT_LE(largest_difference(line, coarse), 1);
  EXPECT_LE(largest_difference(line, dense), 2);
  EXPECT_GT(area(line), 200.0);
}

TEST(PainterTest, PolylineJoinsAreRound) {
  // A right angle: two lines, the square where they overlap once, a quarter disc outside the join.
  const std::vector<Eigen::Vector2d> corner{{20.0, 20.0}, {70.0, 20.0}, {70.0, 70.0}};
  const double found = area([&](Painter& p) { p.polyline(corner, 10.0, kWhite); });
  EXPECT_NEAR(found, 2.0 * 50.0 * 10.0 - 25.0 + kPi * 25.0 + 0.25 * kPi * 25.0, 3.0);
}

TEST(PainterTest, PolylineGoesOverAndUnderOtherShapesAndOffTheScreen) {
  const Colour red{1.0, 0.0, 0.0};
  const Colour green{0.0, 1.0, 0.0};
  const std::vector<Eigen::Vector2d> beyond{{-500.0, 50.0}, {500.0, 50.0}};
  const Image image = painted([&](Painter& p) {
    p.fill({{10.0, 10.0}, {40.0, 90.0}}, 0.0, red);
    p.polyline(beyond, 10.0, green);
    p.fill({{60.0, 10.0}, {90.0, 90.0}}, 0.0, red);
  });
  EXPECT_TRUE(has_colour(image, 25, 50, green));
  EXPECT_TRUE(has_colour(image, 75, 50, red));
  EXPECT_TRUE(has_colour(image, 0, 50, green));
  EXPECT_TRUE(has_colour(image, 99, 50, green));
  EXPECT_TRUE(has_colour(image, 50, 40, kBlack));
}

TEST(PainterTest, DrawsIntoTheFramebufferThatIsBoundAtBegin) {
  OffscreenContext context(kSide, kSide);
  const Gl& gl = context.gl();
  Gl::Name texture = 0;
  gl.gen_textures(1, &texture);
  gl.bind_texture(GL_TEXTURE_2D, texture);
  gl.tex_image_2d(GL_TEXTURE_2D, 0, GL_RGBA8, kSide, kSide, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  Gl::Name framebuffer = 0;
  gl.gen_framebuffers(1, &framebuffer);
  gl.bind_framebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.framebuffer_texture_2d(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  Painter painter(gl, kSide, kSide);
  const std::vector<Eigen::Vector2d> ends{{20.0, 50.0}, {80.0, 50.0}};
  const auto draw = [&](const Colour& background) {
    painter.begin(background);
    painter.polyline(ends, 10.0, kWhite);
    painter.disc({50.0, 20.0}, 5.0, kWhite);
    painter.end();
  };
  draw(kBlack);
  const Image bound = read_frame(gl, kSide, kSide);
  gl.bind_framebuffer(GL_FRAMEBUFFER, 0);
  draw(kBlack);
  EXPECT_GT(area(bound), 600.0);
  EXPECT_EQ(bound.rgb, context.read().rgb);
  draw({1.0, 0.0, 0.0});
  gl.bind_framebuffer(GL_FRAMEBUFFER, framebuffer);
  EXPECT_EQ(read_frame(gl, kSide, kSide).rgb, bound.rgb) << "drawn into the wrong one";
}

TEST(PainterTest, NothingIsDrawnOfNothing) {
  const std::vector<Eigen::Vector2d> none;
  EXPECT_EQ(area([&](Painter& p) { p.polyline(none, 5.0, kWhite); }), 0.0);
  const std::vector<Eigen::Vector2d> point{{50.0, 50.0}};
  EXPECT_EQ(area([&](Painter& p) { p.polyline(point, 0.0, kWhite); }), 0.0);
  const double dot = area([&](Painter& p) { p.polyline(point, 10.0, kWhite); });
  EXPECT_NEAR(dot, kPi * 25.0, 1.0) << "one point is a disc";
  EXPECT_EQ(area([](Painter& p) { p.disc({50.0, 50.0}, 0.0, kWhite); }), 0.0);
}

TEST(ViewTest, FitsTheWorldIntoTheScreenWithOneScale) {
  const Rectangle screen{{10.0, 20.0}, {210.0, 120.0}};
  const View wide = fit({{-1.0, -0.1}, {3.0, 0.1}}, screen);
  EXPECT_DOUBLE_EQ(wide.scale, 50.0);
  EXPECT_TRUE(wide.to_pixels({-1.0, 0.0}).isApprox(Eigen::Vector2d(10.0, 70.0)));
  EXPECT_TRUE(wide.to_pixels({3.0, 0.1}).isApprox(Eigen::Vector2d(210.0, 75.0)));
  const View flat = fit({{0.0, 2.0}, {0.0, 4.0}}, screen);
  EXPECT_DOUBLE_EQ(flat.scale, 50.0);
  EXPECT_TRUE(flat.to_pixels({0.0, 4.0}).isApprox(Eigen::Vector2d(110.0, 120.0)));
}

TEST(ViewTest, RejectsWhatHasNoSize) {
  const Rectangle unit{{0.0, 0.0}, {1.0, 1.0}};
  EXPECT_THROW(fit({{1.0, 1.0}, {1.0, 1.0}}, unit), std::invalid_argument);
  EXPECT_THROW(fit(unit, {{0.0, 0.0}, {0.0, 1.0}}), std::invalid_argument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fit(unit, {{0.0, 0.0}, {1.0, nan}}), std::invalid_argument);
}

}  // namespace
}  // namespace haptrial::render::painter_test
