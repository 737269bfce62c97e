#pragma once

#include <memory>

#include "core/render/flat/flat_quads.h"
#include "core/render/flat/view.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/image.h"

namespace haptrial::render {

/// Draws a picture into a rectangle of the bound framebuffer. The picture reaches the graphics card
/// once, as long as the same one is drawn. One thread and context, as Painter.
class PictureQuad {
 public:
  /// @param width, height  of the framebuffer [px]
  PictureQuad(const Gl& gl, int width, int height);
  ~PictureQuad();
  PictureQuad(const PictureQuad&) = delete;
  PictureQuad& operator=(const PictureQuad&) = delete;

  void draw(const std::shared_ptr<const Image>& image, const Rectangle& box);

 private:
  Gl gl_;
  int width_;
  int height_;
  Gl::Name program_{0};
  Gl::Name texture_{0};
  FlatQuads quads_;
  std::shared_ptr<const Image> loaded_;
};

}  // namespace haptrial::render
