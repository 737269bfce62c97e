#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "core/device/pointer_hand.h"
#include "core/render/flat/text_screen.h"
#include "core/stimulus/shown.h"

namespace haptrial::render {
class Gl;
}

namespace haptrial::protocols {

/// Draws what a protocol shows. The screen's thread, its OpenGL context current.
class Drawing {
 public:
  virtual ~Drawing() = default;
  /// One whole picture. @param shown  of the protocol's own type, or nothing
  virtual void draw(const stimulus::Shown& shown) = 0;
  /// A key of the window was pressed. @param key  its code
  virtual void pressed(int key) { static_cast<void>(key); }
  /// The point p_W that a pixel shows, for a pointer that is a device; nothing if pixels are none
  /// [m].
  virtual std::optional<Eigen::Vector3d> to_world(const Eigen::Vector2d& pixel) const {
    static_cast<void>(pixel);
    return std::nullopt;
  }
  /// Place of a hand in space that pointer and keys move, in the device's workspace; asked after
  /// each picture if the mouse is the device. Nothing if they move none.
  virtual std::optional<device::HandPose> hand(const device::PointerInput& input) {
    static_cast<void>(input);
    return std::nullopt;
  }
};

/// Makes a drawing on the screen's thread, with its OpenGL context current and its size [px].
using MakeDrawing =
    std::function<std::unique_ptr<Drawing>(const render::Gl& gl, int width, int height)>;

/// A picture of words, white on black: enough for a protocol that shows nothing else.
/// @param page  what is to be read while this is shown. The screen's thread, at every picture
MakeDrawing text_drawing(std::function<render::TextPage(const stimulus::Shown&)> page);

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
