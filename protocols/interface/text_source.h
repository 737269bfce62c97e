#pragma once

#include <cstdint>

#include "core/render/flat/text_screen.h"
#include "core/stimulus/shown.h"

namespace haptrial::protocols {

/// Text of a picture, as a participant reads it.
struct PictureText {
  render::TextPage page;
  std::int64_t occasion{0};  // another number: the same text is asked anew
};

/// A drawing whose pictures have text. What it draws is what is spoken. The screen's thread.
class TextSource {
 public:
  virtual ~TextSource() = default;
  /// @param shown  as Drawing::draw() takes it
  virtual PictureText text(const stimulus::Shown& shown) const = 0;
};

}  // namespace haptrial::protocols
