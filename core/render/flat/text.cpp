#include "core/render/flat/text.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>

namespace haptrial::render {
namespace {

/// One instance is one letter; its four corners come from the vertex number.
constexpr const char* kTextVertexShader = R"glsl(#version 330 core
layout(location = 0) in vec4 place;   // left, top, width, height on the screen [px]
layout(location = 1) in vec4 source;  // left, top in the atlas [px]; 1: the letter runs upwards
layout(location = 2) in vec4 colour;
uniform vec2 screen;                  // [px]
out vec2 local;
flat out vec4 box;
flat out vec4 letter;
flat out vec4 paint;

void main() {
  local = vec2(gl_VertexID & 1, gl_VertexID >> 1) * place.zw;
  vec2 pixel = place.xy + local;
  gl_Position = vec4(2.0 * pixel.x / screen.x - 1.0, 1.0 - 2.0 * pixel.y / screen.y, 0.0, 1.0);
  box = place;
  letter = source;
  paint = colour;
}
)glsl";

/// A pixel of the screen is a pixel of the atlas: nothing is interpolated.
constexpr const char* kTextFragmentShader = R"glsl(#version 330 core
in vec2 local;
flat in vec4 box;
flat in vec4 letter;
flat in vec4 paint;
uniform sampler2D atlas;
out vec4 result;

void main() {
  ivec2 at = ivec2(floor(local));
  if (letter.z > 0.5) {
    at = ivec2(int(box.w) - 1 - at.y, at.x);
  }
  float coverage = texelFetch(atlas, ivec2(letter.xy) + at, 0).r;
  result = vec4(paint.rgb, 1.0) * (paint.a * coverage);  // premultiplied
}
)glsl";

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
    : gl_(gl), width_(width), height_(height), quads_(gl, kLetterAttributes) {
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

const TextPainter::Entry& TextPainter::entry(const SetGlyph& set) {
  const auto key = std::tuple(set.face, set.index, set.size);
  if (const auto known = entries_.find(key); known != entries_.end()) {
    return known->second;
  }
  const Glyph glyph = setter_.glyph(set);
  make_room(glyph);
  for (int row = 0; row < glyph.height; ++row) {
    std::copy_n(glyph.coverage.begin() + row * glyph.width, glyph.width,
                atlas_.begin() + (shelf_y_ + row) * kAtlasWidth + shelf_x_);
  }
  const Entry added{shelf_x_, shelf_y_, glyph.left, glyph.top, glyph.width, glyph.height};
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

int TextPainter::width_of(std::string_view text, const TextStyle& style) {
  int width = 0;
  for (const SetLine& line : setter_.lines(text, style.size, style.bold, 0)) {
    width = std::max(width, line.width);
  }
  return width;
}

int TextPainter::line_height(const TextStyle& style) const {
  return setter_.line_height(style.size, style.bold);
}

/// @param pen  on the baseline, in whole pixels
void TextPainter::place(const SetLine& line, const Eigen::Vector2d& pen, const TextStyle& style,
                        bool upwards) {
  const Colour& c = style.colour;
  for (const SetGlyph& glyph : line.glyphs) {
    const Entry& e = entry(glyph);
    Letter letter{{},
                  {f(e.x), f(e.y), upwards ? 1.0f : 0.0f, 0.0f},
                  {f(c.red), f(c.green), f(c.blue), f(c.alpha)}};
    if (upwards) {
      letter.place = {f(pen.x() + glyph.y - e.top), f(pen.y() - glyph.x - e.left - e.width),
                      f(e.height), f(e.width)};
    } else {
      letter.place = {f(pen.x() + glyph.x + e.left), f(pen.y() + glyph.y - e.top), f(e.width),
                      f(e.height)};
    }
    if (e.width > 0) {
      letters_.push_back(letter);
    }
  }
}

void TextPainter::line(std::string_view text, const Eigen::Vector2d& anchor, const TextStyle& style,
                       Align align) {
  const SetLine& line = setter_.lines(text, style.size, style.bold, 0).front();
  place(line, {start_of(anchor.x(), line.width, align), std::round(anchor.y())}, style, false);
}

void TextPainter::line_upwards(std::string_view text, const Eigen::Vector2d& anchor,
                               const TextStyle& style) {
  const SetLine& line = setter_.lines(text, style.size, style.bold, 0).front();
  const double y = std::round(anchor.y() + 0.5 * line.width);
  place(line, {std::round(anchor.x()), y}, style, true);
}

double TextPainter::height_of(std::string_view text, double width, const TextStyle& style) {
  const int room = std::max(1, static_cast<int>(width));
  return static_cast<double>(setter_.lines(text, style.size, style.bold, room).size()) *
         line_height(style);
}

double TextPainter::paragraphs(std::string_view text, const Eigen::Vector2d& top, double width,
                               const TextStyle& style, Align align) {
  const int room = std::max(1, static_cast<int>(width));
  const int ascent = setter_.ascent(style.size, style.bold);
  double y = std::round(top.y());
  for (const SetLine& line : setter_.lines(text, style.size, style.bold, room)) {
    place(line, {start_of(top.x(), line.width, align), y + ascent}, style, false);
    y += line_height(style);
  }
  return y - std::round(top.y());
}

}  // namespace haptrial::render
