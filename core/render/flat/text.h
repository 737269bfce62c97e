#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <vector>

#include "core/render/flat/flat_quads.h"
#include "core/render/flat/typesetter.h"
#include "core/render/flat/view.h"
#include "core/render/gl/colour.h"
#include "core/render/gl/gl.h"

namespace haptrial::render {

enum class Align : std::uint8_t { kLeft, kCentre, kRight };

struct TextStyle {
  int size{24};  // height of the em square [px]
  bool bold{false};
  Colour colour{};
};

/// Draws UTF-8 text of any script over what is in the bound framebuffer, between begin() and end().
/// Glyphs sit on whole pixels and come from a texture that holds each one once, and lines are set
/// once (Typesetter), so that text costs little more than a rectangle a glyph.
///
/// Coordinates as in Painter. One thread, with the OpenGL context current whose functions are
/// given, also for the destructor.
class TextPainter {
 public:
  /// @param width, height  of the framebuffer [px].
  /// @throws RunError when the shaders cannot be made or the typeface is missing.
  TextPainter(const Gl& gl, int width, int height);
  ~TextPainter();
  TextPainter(const TextPainter&) = delete;
  TextPainter& operator=(const TextPainter&) = delete;

  void begin();
  void end();

  /// One line. @param anchor  left end, middle or right end of its baseline [px]
  void line(std::string_view text, const Eigen::Vector2d& anchor, const TextStyle& style,
            Align align = Align::kLeft);
  /// A line that runs upwards. @param anchor  the middle of its baseline [px]
  void line_upwards(std::string_view text, const Eigen::Vector2d& anchor, const TextStyle& style);
  /// Paragraphs, separated by line breaks, wrapped between words to fit `width`; a word that is
  /// wider is broken. @param top  left end, middle or right end of the upper edge [px]
  /// @returns the height that they take [px]
  double paragraphs(std::string_view text, const Eigen::Vector2d& top, double width,
                    const TextStyle& style, Align align = Align::kCentre);

  int width_of(std::string_view text, const TextStyle& style);  // [px]
  double height_of(std::string_view text, double width, const TextStyle& style);
  int line_height(const TextStyle& style) const;

 private:
  struct Entry {  // a glyph in the atlas
    int x{0}, y{0};
    int left{0}, top{0}, width{0}, height{0};
  };
  struct Letter {                 // as the shader reads it
    std::array<float, 4> place;   // left, top, width, height on the screen [px]
    std::array<float, 4> source;  // left, top in the atlas [px]; 1 where it runs upwards; unused
    std::array<float, 4> colour;
  };

  const Entry& entry(const SetGlyph& glyph);
  void make_room(const Glyph& glyph);
  void place(const SetLine& line, const Eigen::Vector2d& pen, const TextStyle& style, bool upwards);
  void build_program();
  void flush();

  Gl gl_;
  int width_;
  int height_;
  Typesetter setter_;
  std::map<std::tuple<int, std::uint32_t, int>, Entry> entries_;  // by face, glyph, size
  std::vector<std::uint8_t> atlas_;  // (atlas_height_ x kAtlasWidth) coverage
  int atlas_height_{0};
  int shelf_x_{0}, shelf_y_{0}, shelf_height_{0};  // where the next glyph goes
  bool atlas_changed_{true};
  std::vector<Letter> letters_;
  Gl::Name program_{0};
  FlatQuads quads_;
  Gl::Name atlas_texture_{0};
};

}  // namespace haptrial::render
