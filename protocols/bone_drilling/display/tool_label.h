#pragma once

#include <string>

#include "core/bone/tools/simulator_tools.h"
#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"
#include "core/render/gl/gl.h"

namespace haptrial::protocols {

/// A tool's name and, of a burr or a suction tube, its diameter: "cutting, 6 mm".
std::string words_of(const bone::ToolSpec& tool);

/// Says in a picture's lower left corner which tool is in hand. One thread, with its OpenGL context
/// current.
class ToolLabel {
 public:
  /// @param width, height  of the framebuffer [px]
  /// @throws RunError as render::TextPainter does.
  ToolLabel(const render::Gl& gl, int width, int height);
  /// Over what is in the bound framebuffer. @param left  edge of the eye's picture [px]
  void draw(const bone::ToolSpec& tool, int left);

 private:
  int height_;
  render::Painter painter_;
  render::TextPainter text_;
};

}  // namespace haptrial::protocols
