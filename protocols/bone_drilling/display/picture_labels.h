#pragma once

#include <span>
#include <string>

#include "core/bone/simulator/drilling_view.h"
#include "core/bone/simulator/simulator_tools.h"
#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"
#include "core/render/gl/gl.h"

namespace haptrial::protocols {

/// A tool's name and, of a burr or a suction tube, its diameter, and its length where it is no
/// ball: "cutting, 6 mm", "fissure, 1.6 × 6 mm".
std::string words_of(const bone::ToolSpec& tool);
/// The same with what became of a burr: "cutting, 6 mm, 82 % sharp, reversed".
std::string words_of(const bone::ToolSpec& tool, const bone::DrillingView& seen);

/// An eye's picture in the framebuffer.
struct EyePicture {
  int left{0};   // edge [px]
  int width{0};  // [px]
};

/// Says over what is in the bound framebuffer which tool is in hand, in the lower left corner,
/// what the participant is hinted at, at the top, and what was injured. One thread, with its OpenGL
/// context current.
class PictureLabels {
 public:
  /// @param width, height  of the framebuffer [px]
  /// @throws RunError as render::TextPainter does.
  PictureLabels(const render::Gl& gl, int width, int height);
  /// @param words  words_of() the tool
  void tool(const std::string& words, const EyePicture& eye);
  /// In the lower right corner. @param words  empty: nothing
  void clock(const std::string& words, const EyePicture& eye);
  /// A small line that ends at the right edge of the picture. @param low  its upper edge [px]
  void legend(const std::string& words, double low, const EyePicture& eye);
  /// One line below the other.
  void hints(std::span<const std::string> lines, const EyePicture& eye);
  /// @param words  of an injury, over the middle of the lower edge
  /// @param frame  strength of a red frame around the picture; 0 and below: no frame
  void injury(const std::string& words, double frame, const EyePicture& eye);

 private:
  struct Look {
    render::TextStyle text;
    render::Colour plate;
  };
  render::TextStyle small() const;
  void line(const std::string& words, const Eigen::Vector2d& low, const Look& look);

  int height_;
  render::Painter painter_;
  render::TextPainter text_;
};

}  // namespace haptrial::protocols
