#pragma once

#include <span>

#include "core/render/gl/gl.h"
#include "core/render/gl/pixel_tiles.h"

namespace haptrial::render {

/// Draws a picture with its jagged edges smoothed: a straight edge between two ends is taken for
/// one that is half a pixel off at either of them, and pixels beside it get the share of their
/// neighbour that it would cover (fast approximate anti-aliasing, Lottes 2009 and 2011). Elsewhere
/// pixels stay as they are, to the bit. One thread, with the context current.
class Antialias {
 public:
  /// How far, in pixels, a change of the picture reaches in the smoothed one.
  static constexpr int kReach = 18;

  explicit Antialias(const Gl& gl);
  ~Antialias();
  Antialias(const Antialias&) = delete;
  Antialias& operator=(const Antialias&) = delete;

  /// Draws to the same place of the bound framebuffer, which has a depth buffer: that says where
  /// edges are, so that the costly pass passes over all that is flat.
  /// @param picture  a texture with linear filtering
  /// @param area     of the picture: what is outside of it is not looked at
  /// @param parts    of the area that are drawn, none of them empty
  void draw(Gl::Name picture, const PixelBox& area, std::span<const PixelBox> parts) const;

 private:
  struct Pass {
    Gl::Name program{0};
    int area{-1};
  };
  Pass make_pass(const char* whose, const char* fragment) const;
  void fill(const Pass& pass, const PixelBox& area) const;

  Gl gl_;
  Pass flat_;
  Pass edges_;
  Gl::Name nothing_{0};  // a vertex array: the corners follow from their numbers
};

}  // namespace haptrial::render
