#include "core/render/gl/pixel_tiles.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "core/base/random.h"

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
