#include "core/render/flat/text.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>

#include "core/render/flat/text_shader.h"
#include "core/render/gl/gl_program.h"

namespace haptrial::render {
namespace {

constexpr int kAtlasWidth = 1024;          // [px]
constexpr int kAtlasRows = 256;            // added when it is full [px]
constexpr unsigned kLetterAttributes = 3;  // place, source, colour

float f(double value) { return static_cast<float>(value); }

/// The pen's place in whole pixels for a line of some width.
double start_of(double anchor, int width, Align align) {
  switch (align) {
    case Align::kLeft:
      return std::round(anchor);
    case Align::kCentre:
      return std::round(anchor - 0.5 * width);
    case Align::kRight:
      return std::round(anchor - width);
  }
  return anchor;
}

}  // namespace

TextPainter::TextPainter(const Gl& gl, int width, int height)
    : gl_(gl),
      width_(width),
      height_(height),
      regular_(Font::sans()),
      bold_(Font::sans_bold()),
      quads_(gl, kLetterAttributes) {
  static_assert(sizeof(Letter) == kLetterAttributes * 4 * sizeof(float));
  build_program();
  gl_.gen_textures(1, &atlas_texture_);
}

TextPainter::~TextPainter() {
  gl_.delete_textures(1, &atlas_texture_);
  gl_.delete_program(program_);
}

void TextPainter::build_program() {
  program_ = render::build_program(gl_, "the text painter", kTextVertexShader, kTextFragmentShader);
  gl_.use_program(program_);
  gl_.uniform2f(gl_.get_uniform_location(program_, "screen"), static_cast<float>(width_),
                static_cast<float>(height_));
  gl_.uniform1i(gl_.get_uniform_location(program_, "atlas"), 0);
}

void TextPainter::begin() { letters_.clear(); }

void TextPainter::end() {
  if (!letters_.empty()) {
    flush();
  }
}

void TextPainter::flush() {
  begin_flat(gl_, width_, height_);
  gl_.use_program(program_);
  gl_.active_texture(GL_TEXTURE0);
  gl_.bind_texture(GL_TEXTURE_2D, atlas_texture_);
  if (atlas_changed_) {
    gl_.pixel_storei(GL_UNPACK_ALIGNMENT, 1);
    gl_.tex_image_2d(GL_TEXTURE_2D, 0, GL_R8, kAtlasWidth, atlas_height_, 0, GL_RED,
                     GL_UNSIGNED_BYTE, atlas_.data());
    gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl_.tex_parameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    atlas_changed_ = false;
  }
  quads_.bind();
  quads_.draw(letters_.data(), letters_.size());
  letters_.clear();
}

const TextPainter::Entry& TextPainter::entry(char32_t character, const TextStyle& style) {
  const auto key = std::tuple(character, style.size, style.bold);
  if (const auto known = entries_.find(key); known != entries_.end()) {
    return known->second;
  }
  const Glyph glyph = font(style).glyph(character, style.size);
  make_room(glyph);
  for (int row = 0; row < glyph.height; ++row) {
    std::copy_n(glyph.coverage.begin() + row * glyph.width, glyph.width,
                atlas_.begin() + (shelf_y_ + row) * kAtlasWidth + shelf_x_);
  }
  const Entry added{shelf_x_,    shelf_y_,     glyph.left,   glyph.top,
                    glyph.width, glyph.height, glyph.advance};
  shelf_x_ += glyph.width;
  shelf_height_ = std::max(shelf_height_, glyph.height);
  atlas_changed_ = true;
  return entries_.emplace(key, added).first->second;
}

void TextPainter::make_room(const Glyph& glyph) {
  if (shelf_x_ + glyph.width > kAtlasWidth) {
    shelf_x_ = 0;
    shelf_y_ += shelf_height_;
    shelf_height_ = 0;
  }
  while (shelf_y_ + glyph.height > atlas_height_) {
    atlas_height_ += kAtlasRows;
    atlas_.resize(static_cast<std::size_t>(atlas_height_) * kAtlasWidth);
  }
}

int TextPainter::width_of(std::u32string_view text, const TextStyle& style) {
  int width = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    width += entry(text[i], style).advance;
    if (i > 0) {
      width += font(style).kerning(text[i - 1], text[i], style.size);
    }
  }
  return width;
}

int TextPainter::width_of(std::string_view text, const TextStyle& style) {
  return width_of(decode_utf8(text), style);
}

int TextPainter::line_height(const TextStyle& style) const {
  return font(style).line_height(style.size);
}

/// @param pen  on the baseline, in whole pixels
void TextPainter::place(std::u32string_view text, Eigen::Vector2d pen, const TextStyle& style,
                        bool upwards) {
  const Colour& c = style.colour;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const Entry& e = entry(text[i], style);
    const int kerning = i > 0 ? font(style).kerning(text[i - 1], text[i], style.size) : 0;
    (upwards ? pen.y() : pen.x()) += upwards ? -kerning : kerning;
    Letter letter{{},
                  {f(e.x), f(e.y), upwards ? 1.0f : 0.0f, 0.0f},
                  {f(c.red), f(c.green), f(c.blue), f(c.alpha)}};
    if (upwards) {
      letter.place = {f(pen.x() - e.top), f(pen.y() - e.left - e.width), f(e.height), f(e.width)};
      pen.y() -= e.advance;
    } else {
      letter.place = {f(pen.x() + e.left), f(pen.y() - e.top), f(e.width), f(e.height)};
      pen.x() += e.advance;
    }
    if (e.width > 0) {
      letters_.push_back(letter);
    }
  }
}

void TextPainter::line(std::string_view text, const Eigen::Vector2d& anchor, const TextStyle& style,
                       Align align) {
  const std::u32string characters = decode_utf8(text);
  const double x = start_of(anchor.x(), width_of(characters, style), align);
  place(characters, {x, std::round(anchor.y())}, style, false);
}

void TextPainter::line_upwards(std::string_view text, const Eigen::Vector2d& anchor,
                               const TextStyle& style) {
  const std::u32string characters = decode_utf8(text);
  const double y = std::round(anchor.y() + 0.5 * width_of(characters, style));
  place(characters, {std::round(anchor.x()), y}, style, true);
}

std::vector<std::u32string> TextPainter::wrapped(std::string_view text, double width,
                                                 const TextStyle& style) {
  std::vector<std::u32string> lines{{}};
  std::u32string word;
  const auto fits = [&](const std::u32string& line) { return width_of(line, style) <= width; };
  const auto take_word = [&] {
    if (word.empty()) {
      return;
    }
    const std::u32string longer = lines.back().empty() ? word : lines.back() + U' ' + word;
    if (fits(longer)) {
      lines.back() = longer;
    } else {
      if (!lines.back().empty()) {
        lines.emplace_back();
      }
      for (const char32_t character : word) {  // broken only where it fills more than a line
        if (!lines.back().empty() && !fits(lines.back() + character)) {
          lines.emplace_back();
        }
        lines.back() += character;
      }
    }
    word.clear();
  };
  for (const char32_t character : decode_utf8(text)) {
    if (character == U' ' || character == U'\t' || character == U'\r') {
      take_word();
    } else if (character == U'\n') {
      take_word();
      lines.emplace_back();
    } else {
      word += character;
    }
  }
  take_word();
  return lines;
}

double TextPainter::height_of(std::string_view text, double width, const TextStyle& style) {
  return static_cast<double>(wrapped(text, width, style).size()) * line_height(style);
}

double TextPainter::paragraphs(std::string_view text, const Eigen::Vector2d& top, double width,
                               const TextStyle& style, Align align) {
  const int ascent = font(style).ascent(style.size);
  const std::vector<std::u32string> lines = wrapped(text, width, style);
  double y = std::round(top.y());
  for (const std::u32string& line : lines) {
    place(line, {start_of(top.x(), width_of(line, style), align), y + ascent}, style, false);
    y += line_height(style);
  }
  return static_cast<double>(lines.size()) * line_height(style);
}

}  // namespace haptrial::render
