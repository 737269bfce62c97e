#include <GL/glcorearb.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "core/render/gl/antialias.h"
#include "core/render/gl/image.h"
#include "core/render/gl/offscreen.h"
#include "core/render/gl/pixel_tiles.h"
#include "tests/core/render/flat/pixels.h"

namespace haptrial::render {
namespace {

constexpr int kSize = 64;

/// How bright each pixel is, by its place from the top left.
using Brightness = std::function<double(double x, double y)>;

/// A picture of that, smoothed.
Image smoothed(const Brightness& of, std::uint8_t alpha = 255) {
  OffscreenContext context(kSize, kSize);
  const Gl& gl = context.gl();
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto grey =
          static_cast<std::uint8_t>(std::lround(255.0 * of(x + 0.5, kSize - y - 0.5)));
      bytes.insert(bytes.end(), {grey, grey, grey, alpha});
    }
  }
  Gl::Name picture = 0;
  gl.gen_textures(1, &picture);
  gl.active_texture(GL_TEXTURE0);
  gl.bind_texture(GL_TEXTURE_2D, picture);
  gl.tex_image_2d(GL_TEXTURE_2D, 0, GL_RGBA8, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                  bytes.data());
  for (const Gl::Enum which : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    gl.tex_parameteri(GL_TEXTURE_2D, which, GL_LINEAR);
  }
  for (const Gl::Enum which : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
    gl.tex_parameteri(GL_TEXTURE_2D, which, GL_CLAMP_TO_EDGE);
  }
  {
    const Antialias antialias(gl);
    const PixelBox all(Eigen::Vector2i(0, 0), Eigen::Vector2i(kSize - 1, kSize - 1));
    antialias.draw(picture, all, std::vector{all});
  }
  gl.delete_textures(1, &picture);
  return context.read();
}

double grey(const Image& image, int x, int y) { return pixel(image, x, y).x() / 255.0; }

/// The root mean square of what a picture differs by from the share of each pixel that is lit.
double error_of(const Image& image, const Brightness& of) {
  constexpr int kFine = 16;
  double sum = 0.0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      double lit = 0.0;
      for (int i = 0; i < kFine * kFine; ++i) {
        lit += of(x + (i % kFine + 0.5) / kFine, y + (i / kFine + 0.5) / kFine);
      }
      const double off = grey(image, x, y) - lit / (kFine * kFine);
      sum += off * off;
    }
  }
  return std::sqrt(sum / (kSize * kSize));
}

/// The same without smoothing: a pixel is what its middle is.
double error_without(const Brightness& of) {
  Image image{kSize, kSize, {}};
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto grey = static_cast<std::uint8_t>(std::lround(255.0 * of(x + 0.5, y + 0.5)));
      image.rgb.insert(image.rgb.end(), 3, grey);
    }
  }
  return error_of(image, of);
}

TEST(AntialiasTest, EdgesComeNearerToTheShareOfEachPixelThatIsLit) {
  for (const double slope : {0.1, 0.2, 0.45, 0.8}) {
    const Brightness half = [slope](double x, double y) {
      return y > 20.0 + slope * x ? 0.9 : 0.1;
    };
    const double most = slope < 0.5 ? 0.65 : 0.8;  // its steps are a pixel long or two
    EXPECT_LT(error_of(smoothed(half), half), most * error_without(half)) << slope;
  }
  const Brightness disc = [](double x, double y) {
    return std::hypot(x - 31.7, y - 32.4) < 22.3 ? 0.95 : 0.05;
  };
  EXPECT_LT(error_of(smoothed(disc), disc), 0.65 * error_without(disc));
}

TEST(AntialiasTest, WhatIsTransparentStaysAsItIs) {
  const Brightness half = [](double x, double y) { return y > 20.0 + 0.2 * x ? 0.9 : 0.1; };
  EXPECT_DOUBLE_EQ(error_of(smoothed(half, 100), half), error_without(half));
  EXPECT_LT(error_of(smoothed(half, 200), half), error_without(half));
}

TEST(AntialiasTest, WithoutAnEdgeEveryPixelStaysAsItIsAndTheTopStaysAbove) {
  const Brightness ramp = [](double x, double y) { return 0.2 + 0.008 * y + 0.003 * x; };
  const Image image = smoothed(ramp);
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      ASSERT_EQ(std::lround(255.0 * grey(image, x, y)),
                std::lround(255.0 * ramp(x + 0.5, y + 0.5)));
    }
  }
}

TEST(AntialiasTest, AStraightStepAlongThePixelsStaysSharp) {
  const Brightness step = [](double x, double /*y*/) { return x > 30.0 ? 1.0 : 0.0; };
  const Image image = smoothed(step);
  for (int y = 4; y < kSize - 4; ++y) {
    EXPECT_NEAR(grey(image, 28, y), 0.0, 1e-9);
    EXPECT_LT(grey(image, 29, y), 0.3);
    EXPECT_GT(grey(image, 30, y), 0.7);
    EXPECT_NEAR(grey(image, 31, y), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace haptrial::render

namespace haptrial::render::pixel_tiles_test {
namespace {

/// The marks of every pixel that is in a part; a failure where one is in two.
std::map<std::pair<int, int>, int> pixels_in(const PixelTiles& tiles) {
  std::map<std::pair<int, int>, int> pixels;
  for (const auto& [box, what] : tiles.parts()) {
    for (int y = box.min().y(); y <= box.max().y(); ++y) {
      for (int x = box.min().x(); x <= box.max().x(); ++x) {
        EXPECT_TRUE(pixels.emplace(std::pair(x, y), what).second) << x << ", " << y;
      }
    }
  }
  return pixels;
}

/// Every pixel has the marks of all boxes that meet its tile, which is found here pixel by pixel.
TEST(PixelTilesTest, EveryTileHasTheMarksOfAllBoxesThatMeetIt) {
  const PixelBox area(Eigen::Vector2i(70, 0), Eigen::Vector2i(299, 149));
  RandomStream random(4, "boxes");
  for (int run = 0; run < 20; ++run) {
    PixelTiles tiles(area);
    std::map<std::pair<int, int>, int> marks;  // by tile
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector2i low(static_cast<int>(random.uniform(-40, 320)),
                                static_cast<int>(random.uniform(-40, 170)));
      const Eigen::Vector2i high = low + Eigen::Vector2i(static_cast<int>(random.uniform(0, 90)),
                                                         static_cast<int>(random.uniform(0, 90)));
      const int what = 1 << (i % 3);
      tiles.add({low, high}, static_cast<std::uint8_t>(what));
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int x = low.x(); x <= high.x(); ++x) {
          if (area.contains(Eigen::Vector2i(x, y))) {
            marks[{(x - 70) / PixelTiles::kEdge, y / PixelTiles::kEdge}] |= what;
          }
        }
      }
    }
    const auto pixels = pixels_in(tiles);
    for (int y = 0; y <= 149; ++y) {
      for (int x = 70; x <= 299; ++x) {
        const auto found = pixels.find({x, y});
        const auto tile = marks.find({(x - 70) / PixelTiles::kEdge, y / PixelTiles::kEdge});
        EXPECT_EQ(found == pixels.end() ? 0 : found->second, tile == marks.end() ? 0 : tile->second)
            << x << ", " << y;
      }
    }
    EXPECT_TRUE(pixels.empty() || pixels.rbegin()->first.first <= 299);
  }
}

TEST(PixelTilesTest, AnEmptyBoxMarksNothing) {
  PixelTiles tiles({Eigen::Vector2i(0, 0), Eigen::Vector2i(99, 99)});
  tiles.add(PixelBox());
  EXPECT_TRUE(tiles.parts().empty());
}

TEST(PixelTilesTest, ManyBoxesOfOneKindAreOnePart) {
  PixelTiles tiles({Eigen::Vector2i(0, 0), Eigen::Vector2i(319, 319)});
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2i at(32 + i % 10 * 13, 64 + i / 10 * 10);
    tiles.add({at, at + Eigen::Vector2i(8, 8)});
  }
  ASSERT_EQ(tiles.parts().size(), 1U);
  EXPECT_EQ(tiles.parts()[0].box.min(), Eigen::Vector2i(32, 64));
  EXPECT_EQ(tiles.parts()[0].box.max(), Eigen::Vector2i(159, 191));
}

}  // namespace
}  // namespace haptrial::render::pixel_tiles_test
