#include "core/render/bone/bone_stills.h"

#include <gtest/gtest.h>

#include "core/render/flat/painter.h"
#include "core/render/gl/offscreen.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render::bone_stills_test {
namespace {

constexpr int kWidth = 400;
constexpr int kHeight = 240;
constexpr Colour kGround{0.2, 0.4, 0.6};

/// Red above, blue below.
Image flag(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool upper = y < height / 2;
      image.rgb.insert(image.rgb.end(), {static_cast<std::uint8_t>(upper ? 255 : 0), 0,
                                         static_cast<std::uint8_t>(upper ? 0 : 255)});
    }
  }
  return image;
}

struct Stage {
  Stage()
      : context(kWidth, kHeight),
        painter(context.gl(), kWidth, kHeight),
        stills(context.gl(), std::make_shared<const std::vector<Image>>(
                                 std::vector{flag(80, 48), flag(48, 80)})) {}
  Image draw(std::size_t number, int left, int width) {
    context.make_current();
    painter.begin(kGround);
    painter.end();
    stills.draw(number, left, width, kHeight);
    return context.read();
  }
  OffscreenContext context;
  Painter painter;
  BoneStills stills;
};

TEST(BoneStillsTest, AStillLiesInTheUpperRightCornerTheRightWayUp) {
  Stage stage;
  const Eigen::Vector4d place = BoneStills::place_of(flag(80, 48), kWidth, kHeight);
  EXPECT_NEAR(place[2], BoneStills::kShare * kWidth, 1.0);
  EXPECT_NEAR(place[3] / place[2], 48.0 / 80.0, 0.01);
  const Image image = stage.draw(0, 0, kWidth);
  const int left = static_cast<int>(place[0]);
  const int top = static_cast<int>(place[1]);
  const int right = left + static_cast<int>(place[2]) - 1;
  const int bottom = top + static_cast<int>(place[3]) - 1;
  for (const int x : {left, (left + right) / 2, right}) {
    EXPECT_TRUE(has_colour(image, x, top, {1.0, 0.0, 0.0})) << x;
    EXPECT_TRUE(has_colour(image, x, bottom, {0.0, 0.0, 1.0})) << x;
  }
  EXPECT_FALSE(has_colour(image, left - 1, top, kGround)) << "the frame";
  int outside = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool near = x >= left - 2 && x <= right + 2 && y >= top - 2 && y <= bottom + 2;
      if (!near) {
        ASSERT_TRUE(has_colour(image, x, y, kGround)) << x << ", " << y;
        ++outside;
      }
    }
  }
  EXPECT_GT(outside, kWidth * kHeight / 2);
}

TEST(BoneStillsTest, EveryEyeHasItsOwnAndAHighStillFits) {
  Stage stage;
  const int half = kWidth / 2;
  const Eigen::Vector4d place = BoneStills::place_of(flag(48, 80), half, kHeight);
  const int x = static_cast<int>(place[0] + 0.5 * place[2]);
  const int y = static_cast<int>(place[1] + 0.25 * place[3]);
  const Image left = stage.draw(1, 0, half);
  const Image right = stage.draw(1, half, half);
  EXPECT_TRUE(has_colour(left, x, y, {1.0, 0.0, 0.0}));
  EXPECT_TRUE(has_colour(left, half + x, y, kGround));
  EXPECT_TRUE(has_colour(right, half + x, y, {1.0, 0.0, 0.0}));
  EXPECT_TRUE(has_colour(right, x, y, kGround));
  const Eigen::Vector4d high = BoneStills::place_of(flag(10, 80), kWidth, kHeight);
  EXPECT_LE(high[1] + high[3], kHeight);
}

}  // namespace
}  // namespace haptrial::render::bone_stills_test
