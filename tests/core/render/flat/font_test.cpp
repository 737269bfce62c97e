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
    const Glyph glyph = font.glyph(c, 32);
    EXPECT_TRUE(font.has(c)) << static_cast<unsigned>(c);
    EXPECT_EQ(glyph.coverage.size(), static_cast<std::size_t>(glyph.width) * glyph.height);
    EXPECT_GT(ink(glyph), 5) << static_cast<unsigned>(c);
    EXPECT_GT(glyph.advance, 0);
    EXPECT_LE(glyph.top, 40);
  }
  EXPECT_EQ(font.glyph(U' ', 32).coverage.size(), 0u);
  EXPECT_GT(font.glyph(U' ', 32).advance, 0);
}

TEST(FontTest, SizesScaleLettersAndLines) {
  const Font font = Font::sans();
  for (const int size : {12, 24, 48, 96}) {
    const Glyph x = font.glyph(U'H', size);
    // A capital of DejaVu Sans is 0.729 em high.
    EXPECT_NEAR(x.height, 0.729 * size, 1.5) << size;
    EXPECT_GT(font.line_height(size), font.ascent(size));
    EXPECT_NEAR(font.line_height(size), 1.164 * size, 2.0) << size;
  }
  EXPECT_GT(ink(Font::sans_bold().glyph(U'H', 48)), ink(font.glyph(U'H', 48)) * 5 / 4);
  EXPECT_THROW(font.glyph(U'H', 0), std::invalid_argument);
}

TEST(FontTest, AMissingCharacterIsABox) {
  const Font font = Font::sans();
  ASSERT_FALSE(font.has(U'漢'));
  const Glyph box = font.glyph(U'漢', 48);
  EXPECT_EQ(box.coverage, font.glyph(U'字', 48).coverage) << "the same for every missing one";
  ASSERT_GT(box.width, 10);
  const auto at = [&](int x, int y) { return box.coverage[y * box.width + x]; };
  EXPECT_LT(at(box.width / 2, box.height / 2), 10) << "empty in the middle";
  EXPECT_GT(at(box.width / 2, 1), 100);
  EXPECT_GT(at(box.width / 2, box.height - 2), 100);
  EXPECT_GT(at(1, box.height / 2), 100);
  EXPECT_GT(at(box.width - 2, box.height / 2), 100);
}

TEST(FontTest, KerningPullsPairsTogether) {
  const Font font = Font::sans();
  EXPECT_LT(font.kerning(U'A', U'V', 64), 0);
  EXPECT_EQ(font.kerning(U'n', U'n', 64), 0);
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

TEST(DecodeUtf8Test, ReadsEveryLength) {
  EXPECT_EQ(decode_utf8(""), U"");
  EXPECT_EQ(decode_utf8("aß€\xf0\x9f\x99\x82"), (std::u32string{U'a', 0xdf, 0x20ac, 0x1f642}));
  std::string all;
  std::u32string expected;
  for (char32_t c :
       {0x7fu, 0x80u, 0x7ffu, 0x800u, 0xd7ffu, 0xe000u, 0xffffu, 0x10000u, 0x10ffffu}) {
    expected += c;
  }
  all =
      "\x7f\xc2\x80\xdf\xbf\xe0\xa0\x80\xed\x9f\xbf\xee\x80\x80\xef\xbf\xbf\xf0\x90\x80\x80"
      "\xf4\x8f\xbf\xbf";
  EXPECT_EQ(decode_utf8(all), expected);
}

TEST(DecodeUtf8Test, BadBytesBecomeTheReplacementCharacterAndNothingElseIsLost) {
  const char32_t bad = 0xfffd;
  EXPECT_EQ(decode_utf8("a\xff"
                        "b"),
            (std::u32string{U'a', bad, U'b'}));
  EXPECT_EQ(decode_utf8("\xc3"
                        "b"),
            (std::u32string{bad, U'b'}));
  EXPECT_EQ(decode_utf8("\xe2\x82"), (std::u32string{bad, bad})) << "cut short";
  EXPECT_EQ(decode_utf8("\xc0\xaf"), (std::u32string{bad, bad})) << "overlong";
  EXPECT_EQ(decode_utf8("\xe0\x80\xaf").front(), bad) << "overlong";
  EXPECT_EQ(decode_utf8("\xed\xa0\x80").front(), bad) << "surrogate";
  EXPECT_EQ(decode_utf8("\xf4\x90\x80\x80").front(), bad) << "beyond the last character";
}

}  // namespace
}  // namespace haptrial::render
