#include "core/render/mesh/distance_slice.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace haptrial::render::distance_slice_test {
namespace {

struct Pixel {
  int red, green, blue;
};
Pixel pixel(const Image& image, int x, int y) {
  const std::size_t at = 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// The distance to a circle of radius 12 samples in the middle of 41 x 31.
std::vector<double> circle() {
  std::vector<double> values;
  for (int row = 0; row < 31; ++row) {
    for (int column = 0; column < 41; ++column) {
      values.push_back(std::hypot(column - 20.0, row - 15.0) - 12.0);
    }
  }
  return values;
}

TEST(DistanceSliceTest, ColoursInsideOutsideAndTheLineBetween) {
  const std::vector<double> values = circle();
  const Image image = draw_distances({values, 41, 31, 1.0}, 410);
  ASSERT_EQ(image.width, 410);
  ASSERT_EQ(image.height, 310);
  const Pixel inside = pixel(image, 295, 155), outside = pixel(image, 355, 155);
  EXPECT_GT(inside.blue, inside.red);
  EXPECT_GT(outside.red, outside.blue);
  int dark = 0;  // pixels of the line from the middle to the right
  for (int x = 205; x < 410; ++x) {
    dark += pixel(image, x, 155).red < 40 ? 1 : 0;
  }
  EXPECT_GE(dark, 1);
  EXPECT_LE(dark, 5);
  const Pixel on_line = pixel(image, 205 + 120, 155);
  EXPECT_LT(on_line.red + on_line.green + on_line.blue, 150);
}

TEST(DistanceSliceTest, PutsTheFirstRowAtTheBottom) {
  const std::vector<double> values{-1.0, -1.0, 1.0, 1.0};
  const Image image = draw_distances({values, 2, 2, 1.0}, 40);
  EXPECT_GT(pixel(image, 20, 39).blue, pixel(image, 20, 39).red);
  EXPECT_GT(pixel(image, 20, 0).red, pixel(image, 20, 0).blue);
}

TEST(DistanceSliceTest, LeavesWhiteWhatHasNoNumber) {
  std::vector<double> values = circle();
  for (double& value : values) {
    if (value > 0.0) {
      value = std::numeric_limits<double>::quiet_NaN();
    }
  }
  const Image image = draw_distances({values, 41, 31, 1.0}, 41);
  const Pixel corner = pixel(image, 0, 0), middle = pixel(image, 20, 15);
  EXPECT_EQ(corner.red + corner.green + corner.blue, 3 * 255);
  EXPECT_LT(middle.red, 255);
}

TEST(DistanceSliceTest, RefusesWhatIsNoGrid) {
  const std::vector<double> values(6, 0.0);
  EXPECT_THROW(draw_distances({values, 2, 2, 1.0}, 40), std::invalid_argument);
  EXPECT_THROW(draw_distances({values, 3, 2, 1.0}, 0), std::invalid_argument);
  EXPECT_NO_THROW(draw_distances({values, 3, 2, 1.0}, 1));
}

}  // namespace
}  // namespace haptrial::render::distance_slice_test
