#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/questions/answer_view.h"
#include "core/render/flat/painter.h"
#include "core/render/flat/picture_quad.h"
#include "core/render/flat/text.h"
#include "core/render/gl/image.h"

namespace haptrial::render {

/// A text that a participant reads between passes, and how it is answered.
struct TextPage {
  std::string title;
  std::string body;                        // line breaks end paragraphs
  std::string hint;                        // at the bottom: "Press the button to go on"
  std::optional<double> countdown;         // shown as minutes and seconds [s]
  std::shared_ptr<const Image> picture{};  // between title and text; null: none
  double picture_share{0.4};               // most of the screen's height that it takes
  questions::AnswerView answer{};          // below the text
  bool hint_is_urgent{false};              // a key did nothing: red and bold
  std::string progress{};                  // in the upper right corner: "3 / 10"
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
    TextStyle title, body, countdown, hint, urgent;
  };
  Sizes sizes(double scale) const;
  double gap() const;
  double column() const;
  double height_of(const TextPage& page, const Sizes& sizes);
  double picture_height(const TextPage& page) const;
  double figure_height() const;
  double scale_height(const questions::ScaleView& scale, const Sizes& sizes);
  double answer_height(const TextPage& page, const Sizes& sizes);
  double draw_picture(const TextPage& page, double y);
  void draw_answer(const TextPage& page, const Sizes& sizes, double y);
  void draw_corner(const std::string& words, const TextStyle& style);
  double draw_choices(const TextPage& page, const Sizes& sizes, double y);
  void draw_scale(const TextPage& page, const Sizes& sizes, double y);
  void draw_figure(const TextPage& page, double y);

  int width_;
  int height_;
  Colour background_;
  Colour ink_;
  Colour accent_;
  Painter painter_;
  TextPainter text_;
  PictureQuad picture_;
};

}  // namespace haptrial::render
