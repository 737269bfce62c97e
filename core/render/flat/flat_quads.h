#pragma once

#include <cstddef>

#include "core/render/gl/gl.h"

namespace haptrial::render {

/// A buffer of items that are drawn as a strip of four corners each. An item is nothing but
/// attributes 0, 1, ... of four floats. One thread, with the context current.
class FlatQuads {
 public:
  FlatQuads(const Gl& gl, unsigned attributes);
  ~FlatQuads();
  FlatQuads(const FlatQuads&) = delete;
  FlatQuads& operator=(const FlatQuads&) = delete;

  void bind() const;
  /// Draws the items, with what is bound. @param count  of them
  void draw(const void* items, std::size_t count) const;

 private:
  Gl gl_;
  std::size_t item_size_;
  Gl::Name vertex_array_{0};
  Gl::Name buffer_{0};
};

/// Readies OpenGL for flat things over what is there: all of the picture, no depth, premultiplied
/// colours.
void begin_flat(const Gl& gl, int width, int height);

}  // namespace haptrial::render
