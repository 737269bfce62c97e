#include "core/render/flat/text_screen.h"

#include <gtest/gtest.h>

#include <string>

#include "core/render/gl/offscreen.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render {
namespace {

constexpr Colour kPaper{1.0, 1.0, 1.0};
constexpr Colour kInk{0.0, 0.0, 0.0};
constexpr Colour kAccent{0.0, 0.0, 1.0};

class Page {
 public:
  Page(const TextPage& page, int width, int height)
      : width_(width),
        height_(height),
        context_(width, height),
        screen_(context_.gl(), width, height, kPaper, kInk, kAccent) {
    screen_.draw(page);
    image_ = context_.read();
  }

  /// Area of ink between two heights, given as parts of the screen's. [px²]
  double ink(double from, double to) const {
    const Rectangle part{{0.0, std::floor(from * height_)},
                         {static_cast<double>(width_), std::floor(to * height_)}};
    return covered(image_, part, kPaper, kInk);
  }
  bool margins_are_empty() const {
    const auto m = static_cast<int>(screen_.margin()) - 1;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const bool outside = x < m || x >= width_ - m || y < m || y >= height_ - m;
        if (outside && !has_colour(image_, x, y, kPaper)) {
          return false;
        }
      }
    }
    return true;
  }
  Blob accent() const { return find(image_, kAccent); }
  const Image& image() const { return image_; }

 private:
  int width_;
  int height_;
  OffscreenContext context_;
  TextScreen screen_;
  Image image_;
};

TEST(AsClockTest, EveryBegunSecondCounts) {
  EXPECT_EQ(as_clock(600.0), "10:00");
  EXPECT_EQ(as_clock(599.01), "10:00");
  EXPECT_EQ(as_clock(599.0), "9:59");
  EXPECT_EQ(as_clock(0.1), "0:01");
  EXPECT_EQ(as_clock(0.0), "0:00");
  EXPECT_EQ(as_clock(-3.0), "0:00");
  EXPECT_EQ(as_clock(6000.0), "100:00");
}

TEST(TextScreenTest, PartsStandInOrderInTheMiddle) {
  const Page page({"Title", "Some body text.", "Press to go on", 75.0}, 800, 600);
  EXPECT_TRUE(page.margins_are_empty());
  EXPECT_GT(page.ink(0.1, 0.9), 500.0);
  EXPECT_GT(page.ink(0.85, 0.93), 50.0) << "the hint is at the bottom";
  const Blob clock = page.accent();
  EXPECT_GT(clock.count, 100);
  EXPECT_NEAR(0.5 * (clock.left + clock.right), 400.0, 12.0);
  EXPECT_GT(clock.top, 300) << "below title and body";
}

TEST(TextScreenTest, WithoutAHintNothingIsAtTheBottom) {
  const Page page({"Title", "Body", "", std::nullopt}, 800, 600);
  EXPECT_EQ(page.ink(0.8, 1.0), 0.0);
  EXPECT_EQ(page.accent().count, 0);
  EXPECT_GT(page.ink(0.3, 0.7), 200.0);
}

TEST(TextScreenTest, ALongTextIsSetSmallerUntilItFits) {
  std::string body;
  for (int i = 0; i < 320; ++i) {
    body += "instruction ";
  }
  for (const auto& [width, height] :
       {std::pair(1280, 720), std::pair(640, 480), std::pair(480, 800)}) {
    const Page page({"A title", body, "Press", std::nullopt}, width, height);
    EXPECT_TRUE(page.margins_are_empty()) << width << " x " << height;
    EXPECT_GT(page.ink(0.1, 0.9), 1000.0);
  }
}

TEST(TextScreenTest, TheCountdownChangesByTheSecond) {
  const auto at = [](double left) { return Page({"Rest", "", "", left}, 640, 480).image().rgb; };
  EXPECT_EQ(at(59.9), at(59.1));
  EXPECT_NE(at(59.1), at(58.9));
}

}  // namespace
}  // namespace haptrial::render
