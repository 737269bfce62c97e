// A frame with a page of text and a number that changes: what setting its lines costs, and drawing
// them with OSMesa as well. The smallest of 20 means over 100 frames.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>

#include "core/render/flat/text.h"
#include "core/render/gl/offscreen.h"

namespace haptrial::render {
namespace {

constexpr const char* kPage =
    "Follow what you feel and answer what you are asked. A square in the upper right corner shows "
    "that the device is at its force limit.\nLet go of the handle, please.";
constexpr int kFrames = 100;

void show_frames(TextPainter& text, bool drawn) {
  const TextStyle style{24, false, Colour{1.0, 1.0, 1.0}};
  for (int frame = 0; frame < kFrames; ++frame) {
    text.begin();
    text.paragraphs(kPage, {640.0, 40.0}, 900.0, style);
    text.line(fmt::format("{:.1f} N", 0.1 * (frame % 80)), {300.0, 400.0}, style);
    if (drawn) {
      text.end();
    }
  }
}

/// [us]
double time_of_frame(TextPainter& text, bool drawn) {
  show_frames(text, drawn);
  double least = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 20; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    show_frames(text, drawn);
    const std::chrono::duration<double, std::micro> gone = std::chrono::steady_clock::now() - start;
    least = std::min(least, gone.count() / kFrames);
  }
  return least;
}

}  // namespace
}  // namespace haptrial::render

int main() {
  using namespace haptrial::render;
  constexpr int kWidth = 1280, kHeight = 720;
  OffscreenContext context(kWidth, kHeight);
  TextPainter text(context.gl(), kWidth, kHeight);
  fmt::print("set: {:.1f} us a frame\n", time_of_frame(text, false));
  fmt::print("set and drawn: {:.1f} us a frame\n", time_of_frame(text, true));
  return 0;
}
