#pragma once

#include "core/render/gl/gl.h"

namespace haptrial::render {

/// Draws a picture with its jagged edges smoothed: where the brightness of a pixel's neighbours
/// differs, colours are mixed along the edge (fast approximate anti-aliasing, Lottes 2009).
/// Elsewhere pixels stay as they are, to the bit. One thread, with the context current.
class Antialias {
 public:
  explicit Antialias(const Gl& gl);
  ~Antialias();
  Antialias(const Antialias&) = delete;
  Antialias& operator=(const Antialias&) = delete;

  /// To the lower left width x height pixels of the bound framebuffer.
  /// @param picture  a texture of that size whose rows run down, with linear filtering, bound in
  ///                 unit 0 until the call ends
  void draw(Gl::Name picture, int width, int height) const;

 private:
  Gl gl_;
  Gl::Name program_;
  Gl::Name nothing_{0};  // a vertex array: the corners follow from their numbers
  int size_;
};

}  // namespace haptrial::render
