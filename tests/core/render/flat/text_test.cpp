#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <string>

#include "core/base/error.h"
#include "core/render/flat/font.h"
#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"
#include "core/render/gl/offscreen.h"
#include "tests/core/render/flat/pixels.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::render::text_test {
namespace {

constexpr int kWidth = 400;
constexpr int kHeight = 200;
constexpr Colour kBlack{0.0, 0.0, 0.0};
constexpr Colour kWhite{1.0, 1.0, 1.0};
const TextStyle kStyle{20, false, kWhite};

/// The smallest rectangle that holds everything that is not black.
Blob inked(const Image& image) {
  Blob blob;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (pixel(image, x, y).maxCoeff() > 20.0) {
        ++blob.count;
        blob.left = std::min(blob.left, x);
        blob.right = std::max(blob.right, x);
        blob.top = std::min(blob.top, y);
        blob.bottom = std::max(blob.bottom, y);
      }
    }
  }
  return blob;
}

class TextPainterTest : public testing::Test {
 protected:
  template <class Draw>
  Image drawn(const Draw& draw) {
    painter_.begin(kBlack);
    painter_.end();
    text_.begin();
    draw();
    text_.end();
    return context_.read();
  }
  Image line(std::string_view text, const Eigen::Vector2d& at, Align align = Align::kLeft) {
    return drawn([&] { text_.line(text, at, kStyle, align); });
  }

  OffscreenContext context_{kWidth, kHeight};
  Painter painter_{context_.gl(), kWidth, kHeight};
  TextPainter text_{context_.gl(), kWidth, kHeight};
};

TEST_F(TextPainterTest, PixelsAreTheFontsOwn) {
  const Font font = Font::sans();
  const Glyph glyph = font.glyph(font.index_of(U'R'), kStyle.size);
  const Image image = line("R", {50.0, 100.0});
  for (int y = 0; y < glyph.height; ++y) {
    for (int x = 0; x < glyph.width; ++x) {
      EXPECT_NEAR(pixel(image, 50 + glyph.left + x, 100 - glyph.top + y).x(),
                  glyph.coverage[y * glyph.width + x], 1.0);
    }
  }
  const Blob blob = inked(image);
  EXPECT_GE(blob.left, 50 + glyph.left);
  EXPECT_LT(blob.right, 50 + glyph.left + glyph.width);
}

TEST_F(TextPainterTest, LinesKeepToTheirAnchors) {
  const std::string text = "HxxH";
  const int width = text_.width_of(text, kStyle);
  const Blob left = inked(line(text, {100.0, 100.0}));
  EXPECT_NEAR(left.left, 100, 3);
  EXPECT_NEAR(left.right, 100 + width, 3);
  EXPECT_EQ(left.bottom, 99) << "stands on its baseline";
  const Blob centre = inked(line(text, {200.0, 100.0}, Align::kCentre));
  EXPECT_NEAR(0.5 * (centre.left + centre.right + 1), 200.0, 1.5);
  const Blob right = inked(line(text, {300.0, 100.0}, Align::kRight));
  EXPECT_NEAR(right.right, 300, 3);
}

TEST_F(TextPainterTest, UpwardsIsTheSameTurnedAQuarterToTheLeft) {
  const std::string text = "Force";
  const Image flat = line(text, {100.0, 100.0}, Align::kCentre);
  const Image up = drawn([&] { text_.line_upwards(text, {100.0, 100.0}, kStyle); });
  const Blob a = inked(flat);
  const Blob b = inked(up);
  EXPECT_EQ(a.count, b.count);
  EXPECT_EQ(a.right - a.left, b.bottom - b.top);
  EXPECT_EQ(a.bottom - a.top, b.right - b.left);
  for (int x = a.left; x <= a.right; ++x) {
    for (int y = a.top; y <= a.bottom; ++y) {
      ASSERT_EQ(pixel(flat, x, y), pixel(up, b.left + y - a.top, b.bottom - (x - a.left)));
    }
  }
}

TEST_F(TextPainterTest, ParagraphsWrapBetweenWordsInsideTheirWidth) {
  const std::string text = "one two three four five six seven eight nine ten eleven twelve";
  for (const double width : {90.0, 150.0, 260.0}) {
    const double height = text_.height_of(text, width, kStyle);
    const Image image = drawn([&] {
      text_.paragraphs(text, {200.0, 10.0}, width, kStyle, Align::kCentre);
    });
    const Blob blob = inked(image);
    EXPECT_GE(blob.left, 200 - width / 2 - 1) << width;
    EXPECT_LE(blob.right, 200 + width / 2 + 1) << width;
    EXPECT_GE(blob.top, 10);
    EXPECT_LE(blob.bottom, 10 + height);
    // No fewer lines than the width of all words needs, and few more.
    const int lines = static_cast<int>(height / text_.line_height(kStyle) + 0.5);
    const double least = text_.width_of(text, kStyle) / width;
    EXPECT_GE(lines, static_cast<int>(least)) << width;
    EXPECT_LE(lines, 2.0 * least + 1.0) << width;
  }
}

TEST_F(TextPainterTest, LineBreaksEndLinesAndEmptyOnesStay) {
  const int one = text_.line_height(kStyle);
  EXPECT_EQ(text_.height_of("a b", 300.0, kStyle), one);
  EXPECT_EQ(text_.height_of("a\nb", 300.0, kStyle), 2 * one);
  EXPECT_EQ(text_.height_of("a\n\nb", 300.0, kStyle), 3 * one);
}

TEST_F(TextPainterTest, AWordWiderThanTheColumnIsBroken) {
  const std::string word(60, 'm');
  const Blob blob = inked(drawn([&] { text_.paragraphs(word, {200.0, 0.0}, 120.0, kStyle); }));
  EXPECT_GE(blob.left, 140);
  EXPECT_LE(blob.right, 260);
  EXPECT_GT(text_.height_of(word, 120.0, kStyle), 5 * text_.line_height(kStyle));
  EXPECT_GT(text_.height_of(word, 1.0, kStyle), 59 * text_.line_height(kStyle)) << "one a line";
}

TEST_F(TextPainterTest, UmlautsAndGreekHaveInkAndDifferFromTheBox) {
  const Image box = line("漢", {100.0, 100.0});
  EXPECT_GT(inked(box).count, 10);
  for (const char* text : {"Ä", "ö", "ß", "α", "Ω", "µ"}) {
    const Image image = line(text, {100.0, 100.0});
    EXPECT_GT(inked(image).count, 10) << text;
    EXPECT_NE(image.rgb, box.rgb) << text;
  }
  EXPECT_LT(inked(line("Ä", {100.0, 100.0})).top, inked(line("A", {100.0, 100.0})).top)
      << "the dots are above";
}

TEST_F(TextPainterTest, ManySizesFillTheAtlasWithoutHarmToOlderLetters) {
  const Image before = line("Rest 9:59", {20.0, 100.0});
  for (int size = 10; size < 120; size += 3) {
    drawn([&] { text_.line("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789", {0.0, 150.0}, {size, true}); });
  }
  EXPECT_EQ(line("Rest 9:59", {20.0, 100.0}).rgb, before.rgb);
}

TEST_F(TextPainterTest, GoesOverWhatIsThereAndBlends) {
  const Colour half = with_alpha(kWhite, 0.5);
  painter_.begin(Colour{0.0, 0.0, 1.0});
  painter_.end();
  text_.begin();
  text_.line("█", {100.0, 100.0}, {40, false, half});
  text_.end();
  const Image image = context_.read();
  EXPECT_LT((pixel(image, 110, 90) - Eigen::Vector3d(128, 128, 255)).cwiseAbs().maxCoeff(), 2.0);
  EXPECT_EQ(pixel(image, 300, 20), Eigen::Vector3d(0, 0, 255));
}

}  // namespace
}  // namespace haptrial::render::text_test

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
