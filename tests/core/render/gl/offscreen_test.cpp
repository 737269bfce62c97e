#include "core/render/gl/offscreen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/base/error.h"
#include "core/render/flat/painter.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render {
namespace {

constexpr Colour kRed{1.0, 0.0, 0.0};
constexpr Colour kGreen{0.0, 1.0, 0.0};
constexpr Colour kWhite{1.0, 1.0, 1.0};

TEST(LoadGlTest, NamesTheFunctionThatIsMissing) {
  try {
    load_gl([](const char*) -> void* { return nullptr; });
    FAIL() << "nothing was thrown";
  } catch (const RunError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("glGetError"));
  }
}

TEST(OffscreenContextTest, RejectsSizesThatItCannotDraw) {
  for (const auto& [width, height] :
       {std::pair{0, 10}, std::pair{10, -1}, std::pair{1 << 24, 10}}) {
    try {
      const OffscreenContext context(width, height);
      ADD_FAILURE() << width << " x " << height << " was accepted";
    } catch (const RunError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(std::to_string(width) + " x "));
      EXPECT_THAT(error.what(), testing::HasSubstr("allowed:"));
    }
  }
}

TEST(OffscreenContextTest, ReadsTheTopRowFirst) {
  OffscreenContext context(6, 4);
  Painter painter(context.gl(), 6, 4);
  painter.begin(kRed);
  painter.fill({{1.0, 0.0}, {3.0, 1.0}}, 0.0, kGreen);
  painter.end();
  const Image image = context.read();
  ASSERT_EQ(image.width, 6);
  ASSERT_EQ(image.height, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      const bool green = y == 0 && (x == 1 || x == 2);
      EXPECT_TRUE(has_colour(image, x, y, green ? kGreen : kRed)) << x << ", " << y;
    }
  }
}

TEST(OffscreenContextTest, TwoAtOnceKeepTheirPicturesApart) {
  OffscreenContext first(20, 10);
  Painter first_painter(first.gl(), 20, 10);
  OffscreenContext second(9, 30);
  {
    Painter second_painter(second.gl(), 9, 30);
    first.make_current();
    first_painter.begin(kRed);
    second.make_current();
    second_painter.begin(kGreen);
    first.make_current();
    first_painter.fill({{0.0, 0.0}, {10.0, 10.0}}, 0.0, kWhite);
    first_painter.end();
    second.make_current();
    second_painter.end();
  }
  const Image one = first.read();
  const Image two = second.read();
  EXPECT_EQ(find(one, kWhite).count, 100);
  EXPECT_EQ(find(one, kRed).count, 100);
  EXPECT_EQ(find(two, kGreen).count, 9 * 30);
  first.make_current();  // for the first painter's end
}

TEST(ReadFrameTest, ReportsAnErrorOfTheDrawingBefore) {
  OffscreenContext context(8, 8);
  context.gl().enable(0xffffffffu);
  EXPECT_THROW(context.read(), RunError);
  EXPECT_NO_THROW(context.read()) << "an error is reported once";
}

}  // namespace
}  // namespace haptrial::render
