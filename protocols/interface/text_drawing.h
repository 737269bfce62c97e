#pragma once

#include <functional>

#include "core/render/flat/text_screen.h"
#include "protocols/interface/drawing.h"

namespace haptrial::protocols {

/// A picture of words, white on black: enough for a protocol that shows nothing else.
/// @param page  what is to be read while this is shown. The screen's thread, at every picture
MakeDrawing text_drawing(std::function<render::TextPage(const stimulus::Shown&)> page);

}  // namespace haptrial::protocols
