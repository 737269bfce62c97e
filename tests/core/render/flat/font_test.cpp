#include "core/render/flat/font.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <string>

#include "core/base/error.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::render {
namespace {

using testing::HasSubstr;

int ink(const Glyph& glyph) {
  return std::accumulate(glyph.coverage.begin(), glyph.coverage.end(), 0) / 255;
}

TEST(FontTest, CharactersHaveInkWithinTheirPicture) {
  const Font font = Font::sans();
  for (const char32_t c : U"AgjÄöüßαβγΩéñ—…µ²") {
    if (c == 0) {
      continue;
    }
    const Glyph glyph = font.glyph(font.index_of(c), 32);
    EXPECT_NE(font.index_of(c), 0u) << static_cast<unsigned>(c);
    EXPECT_EQ(glyph.coverage.size(), static_cast<std::size_t>(glyph.width) * glyph.height);
    EXPECT_GT(ink(glyph), 5) << static_cast<unsigned>(c);
    EXPECT_GT(glyph.advance, 0);
    EXPECT_LE(glyph.top, 40);
  }
  EXPECT_EQ(font.glyph(font.index_of(U' '), 32).coverage.size(), 0u);
  EXPECT_GT(font.glyph(font.index_of(U' '), 32).advance, 0);
}

TEST(FontTest, SizesScaleLettersAndLines) {
  const Font font = Font::sans();
  for (const int size : {12, 24, 48, 96}) {
    const Glyph x = font.glyph(font.index_of(U'H'), size);
    // A capital of DejaVu Sans is 0.729 em high.
    EXPECT_NEAR(x.height, 0.729 * size, 1.5) << size;
    EXPECT_GT(font.line_height(size), font.ascent(size));
    EXPECT_NEAR(font.line_height(size), 1.164 * size, 2.0) << size;
  }
  const Font bold = Font::sans_bold();
  EXPECT_GT(ink(bold.glyph(bold.index_of(U'H'), 48)),
            ink(font.glyph(font.index_of(U'H'), 48)) * 5 / 4);
  EXPECT_THROW(font.glyph(font.index_of(U'H'), 0), std::invalid_argument);
}

TEST(FontTest, AMissingCharacterIsABox) {
  const Font font = Font::sans();
  ASSERT_EQ(font.index_of(U'漢'), 0u);
  const Glyph box = font.glyph(font.index_of(U'漢'), 48);
  EXPECT_EQ(box.coverage, font.glyph(font.index_of(U'字'), 48).coverage)
      << "the same for every missing one";
  ASSERT_GT(box.width, 10);
  const auto at = [&](int x, int y) { return box.coverage[y * box.width + x]; };
  EXPECT_LT(at(box.width / 2, box.height / 2), 10) << "empty in the middle";
  EXPECT_GT(at(box.width / 2, 1), 100);
  EXPECT_GT(at(box.width / 2, box.height - 2), 100);
  EXPECT_GT(at(1, box.height / 2), 100);
  EXPECT_GT(at(box.width - 2, box.height / 2), 100);
}

TEST(FontTest, NamesAFileThatIsNoTypeface) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "x.ttf") << "not a typeface";
  for (const char* name : {"x.ttf", "absent.ttf"}) {
    try {
      const Font font(folder / name);
      ADD_FAILURE() << name << " was taken";
    } catch (const RunError& error) {
      EXPECT_THAT(error.what(), HasSubstr(name));
    }
  }
}

}  // namespace
}  // namespace haptrial::render
