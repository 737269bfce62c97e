#pragma once

#include <string>

#include "core/bone/simulator/drilling_view.h"
#include "core/bone/tools/simulator_tools.h"
#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"
#include "core/render/gl/gl.h"

namespace haptrial::protocols {

/// A tool's name and, of a burr or a suction tube, its diameter, and its length where it is no
/// ball: "cutting, 6 mm", "fissure, 1.6 × 6 mm".
std::string words_of(const bone::ToolSpec& tool);
/// The same with what became of a burr: "cutting, 6 mm, 82 % sharp, reversed".
std::string words_of(const bone::ToolSpec& tool, const bone::DrillingView& seen);

/// Says in a picture's lower left corner which tool is in hand. One thread, with its OpenGL context
/// current.
class ToolLabel {
 public:
  /// @param width, height  of the framebuffer [px]
  /// @throws RunError as render::TextPainter does.
  ToolLabel(const render::Gl& gl, int width, int height);
  /// Over what is in the bound framebuffer. @param words  words_of() the tool  @param left  edge of
  /// the eye's picture [px]
  void draw(const std::string& words, int left);

 private:
  int height_;
  render::Painter painter_;
  render::TextPainter text_;
};

}  // namespace haptrial::protocols
