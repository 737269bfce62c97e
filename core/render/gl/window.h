#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/key_press.h"
#include "core/render/gl/gl.h"
#include "core/render/gl/image.h"

namespace haptrial::render {

struct WindowOptions {
  std::string title{"haptrial"};
  int width{1280};  // of a window; a full screen has the monitor's size [px]
  int height{720};
  bool full_screen{false};
  int monitor{0};           // from 0, the primary one
  bool refresh_lock{true};  // swap() waits for the monitor's refresh, where the display can
};

using haptrial::KeyPress;

/// The mouse, in pixels from the window's top left corner.
struct Pointer {
  Eigen::Vector2d position{Eigen::Vector2d::Zero()};  // [px]
  double wheel{0.0};                                  // steps since the window opened, up > 0
  std::uint32_t buttons{0};                           // bit 0 left, 1 right, 2 middle
  bool operator==(const Pointer&) const = default;
};

/// A window or a full screen with an OpenGL 3.3 core context (GLFW), for the same renderer that
/// draws off screen. At most one at a time in a process. One thread calls everything, also the
/// constructor and the destructor; it need not be the main thread.
class Window {
 public:
  /// @throws RunError when there is no display or no OpenGL 3.3; InputError for a monitor that is
  /// not there.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  const Gl& gl() const noexcept;
  int width() const noexcept;  // of the framebuffer [px]
  int height() const noexcept;
  /// Rate of the monitor [Hz]; 0 if it does not say.
  double refresh_rate() const noexcept;

  /// Takes what happened to window, keys and mouse. @throws RunError when the display is gone
  void poll();
  /// Shows what was drawn and comes back when the display has it: with refresh lock, at a refresh.
  void swap();
  /// Picture that was drawn and not yet swapped. @throws RunError when OpenGL reports an error.
  Image read();

  bool close_asked() const;            // by the window's button
  std::vector<KeyPress> take_keys();   // since the last call
  std::vector<int> held_keys() const;  // as KeyPress has them, in the order of their presses
  /// The pointer after the last poll. A button that went down and up again within a poll is down,
  /// so that no click is lost, however short it was or however late the poll came.
  Pointer pointer() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::render
