#include "core/render/flat/typesetter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hb.h>

#include <string>

#include "core/base/error.h"

namespace haptrial::render {
namespace {

constexpr int kSize = 32;

std::vector<std::uint32_t> glyphs_of(const SetLine& line) {
  std::vector<std::uint32_t> all;
  for (const SetGlyph& glyph : line.glyphs) {
    all.push_back(glyph.index);
  }
  return all;
}

/// Glyphs that HarfBuzz makes of a text by itself, in the order in which they are seen.
std::vector<std::uint32_t> shaped(const std::string& file, const std::string& text) {
  hb_blob_t* blob = hb_blob_create_from_file(file.c_str());
  hb_face_t* face = hb_face_create(blob, 0);
  hb_font_t* font = hb_font_create(face);
  hb_buffer_t* buffer = hb_buffer_create();
  hb_buffer_add_utf8(buffer, text.data(), static_cast<int>(text.size()), 0, -1);
  hb_buffer_guess_segment_properties(buffer);
  hb_shape(font, buffer, nullptr, 0);
  unsigned count = 0;
  const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer, &count);
  std::vector<std::uint32_t> all;
  for (unsigned i = 0; i < count; ++i) {
    all.push_back(infos[i].codepoint);
  }
  hb_buffer_destroy(buffer);
  hb_font_destroy(font);
  hb_face_destroy(face);
  hb_blob_destroy(blob);
  return all;
}

class ScriptTest : public testing::TestWithParam<const char*> {};

TEST_P(ScriptTest, GlyphsAreThoseOfHarfBuzzInTheirOrder) {
  const std::string text = GetParam();
  Typesetter setter;
  const std::vector<SetLine> lines = setter.lines(text, kSize, false, 0);
  ASSERT_EQ(lines.size(), 1u);
  ASSERT_FALSE(lines.front().glyphs.empty());
  const int face = lines.front().glyphs.front().face;
  EXPECT_EQ(glyphs_of(lines.front()), shaped(setter.file_of(face), text));
  EXPECT_GT(lines.front().width, 0);
}

// Latin with a combining mark, Arabic, Hebrew, Devanagari with a vowel that is written before its
// consonant and a conjunct, Thai, Chinese.
INSTANTIATE_TEST_SUITE_P(Scripts, ScriptTest,
                         testing::Values("office", "ẹ́", "سلام", "שלום", "हिन्दी", "กำ", "漢字"));

TEST(TypesetterTest, ArabicIsJoinedAndRunsFromTheRight) {
  Typesetter setter;
  const std::vector<SetLine> alone = setter.lines("ب", kSize, false, 0);
  const std::vector<SetLine> word = setter.lines("بابب", kSize, false, 0);
  ASSERT_EQ(alone.front().glyphs.size(), 1u);
  ASSERT_GE(word.front().glyphs.size(), 3u);
  EXPECT_NE(word.front().glyphs.front().index, alone.front().glyphs.front().index)
      << "the last letter is at the left, in its final form";
}

TEST(TypesetterTest, LinesBreakBetweenWords) {
  Typesetter setter;
  const std::string text = "one two three four five six";
  const int whole = setter.lines(text, kSize, false, 0).front().width;
  const std::vector<SetLine> lines = setter.lines(text, kSize, false, whole / 2);
  EXPECT_GE(lines.size(), 2u);
  for (const SetLine& line : lines) {
    EXPECT_LE(line.width, whole / 2);
  }
  EXPECT_EQ(setter.lines("a\nb\n\nc", kSize, false, 1000).size(), 4u);
  EXPECT_EQ(setter.lines("", kSize, false, 0).size(), 1u);
}

TEST(TypesetterTest, BadBytesDoNoHarm) {
  Typesetter setter;
  EXPECT_EQ(setter.lines("a\xff\xfe z", kSize, false, 0).size(), 1u);
  EXPECT_EQ(setter.lines(std::string("a\0b", 3), kSize, false, 0).size(), 1u);
  EXPECT_THROW(setter.lines("a", 0, false, 0), std::invalid_argument);
}

TEST(TypesetterTest, SaysWhichCharactersNoTypefaceHas) {
  EXPECT_THAT(missing_characters("Plain äöü é µ"), testing::ElementsAre());
  EXPECT_THAT(missing_characters("x\U0010FFFDy\U000F1234z\U0010FFFD"),
              testing::ElementsAre(U'\U0010FFFD', U'\U000F1234'))
      << "private use";
}

}  // namespace
}  // namespace haptrial::render
