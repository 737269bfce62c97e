#pragma once

#include <optional>
#include <string>

#include "core/render/flat/painter.h"
#include "core/render/flat/text.h"

namespace haptrial::render {

/// What a participant reads between passes.
struct TextPage {
  std::string title;
  std::string body;                 // line breaks end paragraphs
  std::string hint;                 // at the bottom: "Press the button to go on"
  std::optional<double> countdown;  // shown as minutes and seconds [s]
};

/// "10:00" for 600 s; a part of a second counts as a whole one, so that 0:00 is the end.
std::string as_clock(double seconds);

/// Draws a page in the middle of the screen, in letters that grow with the screen; a text that is
/// too long is set smaller until it fits. One thread and context, as Painter.
class TextScreen {
 public:
  TextScreen(const Gl& gl, int width, int height, const Colour& background, const Colour& ink,
             const Colour& accent);
  void draw(const TextPage& page);

  /// The page stays this far from every edge [px].
  double margin() const;

 private:
  struct Sizes {
    TextStyle title, body, countdown, hint;
  };
  Sizes sizes(double scale) const;
  double height_of(const TextPage& page, const Sizes& sizes);

  int width_;
  int height_;
  Colour background_;
  Colour ink_;
  Colour accent_;
  Painter painter_;
  TextPainter text_;
};

}  // namespace haptrial::render
